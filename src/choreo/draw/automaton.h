#pragma once

#include <string>

#include "choreo/project/project.h"

/// Draws local types.
namespace rondo::choreo {

/// Returns a local type as a diagram in SVG: states from top to bottom in the order in which they are
/// reached; what happens stands at the arrows, which bow to the right where they do not lead to the next
/// state.
std::string DrawAutomaton(const Graph& graph, const lang::ExprPool& pool, const LocalType& type);

}  // namespace rondo::choreo
