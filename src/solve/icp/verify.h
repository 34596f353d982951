#pragma once

#include "solve/icp/existence.h"
#include "solve/icp/point.h"

/// Verification of what a search calls a solution.
namespace rondo::solve::icp {

/// Gives all variables of a query values at which it is true; if not `exact`, near which it certainly is.
struct Solution {
  Assignment values;
  bool exact = true;
};

/// Establishes that a prepared conjunction, and so the query that it came from, has a solution.
class Verifier {
 public:
  /// `tape` is the conjunction's, `lowered` the whole query.
  Verifier(Lowered& lowered, const Prepared& prepared, const Tape& tape, const interval::Kernels& kernels);

  /// Looks at, and then near, a point: a number for each variable of the tape. Nothing if no solution was
  /// proved.
  std::optional<Solution> Verify(const std::vector<double>& point);

 private:
  std::optional<Solution> AtPoint(const std::vector<double>& point);
  std::optional<Solution> NearPoint(const std::vector<double>& point);
  Assignment Values(const std::vector<double>& point) const;
  std::optional<bool> Complete(PointChecker& checker, Assignment& values) const;

  Lowered& lowered_;
  expr::Arena& arena_;
  const Prepared& prepared_;
  const Tape& tape_;
  Existence existence_;
  std::vector<TermId> formulas_;   // the conjuncts
  std::vector<TermId> others_;     // those that are no equations
  std::vector<TermId> equations_;  // their terms
};

}  // namespace rondo::solve::icp
