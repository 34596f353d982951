#pragma once

#include <optional>

#include "choreo/graph/declarations.h"
#include "choreo/graph/graph.h"

namespace rondo::choreo {

/// The graph of a choreography that is written as equations between states. Reports what `Lower` reports, and
/// states that do not fit together: each stands once to the left, as what goes on, and once to the right, as
/// where something leads; the first one only to the left; threads join where they were forked.
std::optional<Graph> LowerEquations(const ChoreographyDef& source, Declarations& declarations);

}  // namespace rondo::choreo
