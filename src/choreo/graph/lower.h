#pragma once

#include "choreo/graph/declarations.h"
#include "choreo/graph/graph.h"

/// Makes graphs of choreographies.
namespace rondo::choreo {

/// Returns the graphs of the choreographies of a module, in order. Reports names that are not declared, wrong
/// arguments, units that do not fit, durations that are none, and robots that stand in the wrong thread (rule
/// 1, scopes). A choreography about which an error was reported has no graph.
std::vector<Graph> Lower(const Module& module, Declarations& declarations);

}  // namespace rondo::choreo
