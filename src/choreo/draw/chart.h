#pragma once

#include <string>

#include "choreo/graph/graph.h"

/// Draws choreographies.
namespace rondo::choreo {

/// Returns a choreography as a sequence chart in SVG: a lane for each robot, time downwards; motions are
/// boxes, messages arrows, choices frames with one part for each alternative; threads go down side by side.
/// Loops have a number where they begin and a mark where they go back.
std::string DrawChart(const Graph& graph, const lang::ExprPool& pool);

}  // namespace rondo::choreo
