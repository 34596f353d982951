#pragma once

#include "reach/certify/step.h"
#include "reach/system/formula.h"
#include "reach/system/problem.h"

namespace rondo::reach::certify {

/// A claim, compiled.
struct CompiledClaim {
  const Claim* claim = nullptr;
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  /// By term: certainly at most zero at the start, though rounding may not tell, and continuous?
  std::vector<bool> starts_below;
};

/// What there is to check about a problem: the same for all parts of the initial set.
struct System {
  const Problem* problem = nullptr;
  Dynamics dynamics;
  Program control;   ///< what the states are after the controller has acted
  Program observed;  ///< the terms of all claims
  std::vector<CompiledClaim> claims;
  Formula assumed;
  Program assumed_terms;
  std::vector<Rational> instants;  ///< 0, samples, beginnings and ends of claims, the horizon; ascending

  /// @error if the problem has what is not checked here.
  static base::Result<System> Of(const Problem& problem);
  /// Does the controller act at this instant?
  bool IsSample(const Rational& instant) const;
};

}  // namespace rondo::reach::certify
