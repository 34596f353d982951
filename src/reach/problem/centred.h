#pragma once

#include "reach/problem/problem.h"

/// Problems in coordinates that do not depend on where a robot starts.
namespace rondo::reach {

/// Is the same problem in other coordinates: each state is measured from the middle of where it starts, if
/// that is known exactly, and what every start satisfies anyway is not assumed. An exact change of variables,
/// so one is proved if the other is. Where dynamics and contract depend on differences of positions only,
/// robots that start and aim elsewhere have the same centred problem: one proof serves all of them.
struct CentredProblem {
  Problem problem;
  std::vector<Rational> origin;  ///< by state: where its zero is in the original coordinates
};
/// Returns the problem in these coordinates. Its terms are made in the same arena.
CentredProblem Centred(const Problem& problem);

}  // namespace rondo::reach
