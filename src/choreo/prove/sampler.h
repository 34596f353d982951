#pragma once

#include <optional>
#include <random>
#include <vector>

#include "expr/numeric.h"
#include "solve/icp/icp_solver.h"

/// Samples states.
namespace rondo::choreo {

/// Draws states at random that satisfy a formula, in doubles: for search and for tests, never for proofs.
/// Equations of one unknown are solved, where they are affine in it; other variables are drawn from bounds
/// that contraction finds, often at their ends; what does not satisfy the formula is thrown away.
class Sampler {
 public:
  Sampler(const expr::Arena& arena, expr::TermId formula);

  /// Returns a state that satisfies the formula, or nothing after `tries` that failed.
  std::optional<expr::Numeric::Point> Draw(std::mt19937_64& random, int tries) const;

 private:
  std::optional<expr::Numeric::Point> Try(std::mt19937_64& random) const;
  /// Collects the equations of a conjunction, with one alternative of each disjunction.
  void Equations(expr::TermId formula, std::mt19937_64& random, std::vector<expr::TermId>& equations) const;

  const expr::Arena& arena_;
  expr::TermId formula_;
  std::vector<expr::TermId> variables_;
  std::optional<solve::icp::Box> box_;
};

}  // namespace rondo::choreo
