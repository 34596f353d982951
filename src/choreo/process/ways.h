#pragma once

#include <vector>

#include "choreo/process/compare.h"
#include "choreo/process/flow.h"

/// Follows the conditions of a process.
namespace rondo::choreo {

/// Holds one way through conditions: where it leads, and when it is taken.
struct Way {
  FlowId to;
  expr::TermId condition;
};

/// Returns the ways from `start` through conditions and assignments to the next steps that others can see,
/// each step once. Their conditions are about the state in which the robot chooses: what is assigned on a
/// way may change what its guards mean, so behind an assignment nothing is known. Checks the assignments.
/// Cost: linear in the conditions.
std::vector<Way> WaysThrough(const Flow& flow, FlowId start, Compare& compare, expr::Arena& arena);

}  // namespace rondo::choreo
