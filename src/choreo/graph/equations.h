#pragma once

#include <optional>

#include "choreo/graph/declarations.h"
#include "choreo/graph/graph.h"

/// Makes graphs of choreographies that are written as equations (`.chor`).
namespace rondo::choreo {

/// Returns the graph of a choreography that is written as equations between states; nothing after a report.
/// Reports what `Lower` reports, and states that do not fit together: each stands once to the left, as what
/// goes on, and once to the right, as where something leads; the first one only to the left; threads join
/// where they were forked.
std::optional<Graph> LowerEquations(const ChoreographyDef& source, Declarations& declarations);

}  // namespace rondo::choreo
