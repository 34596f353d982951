#pragma once

#include <set>
#include <vector>

#include "choreo/prove/curve.h"

/// Cuts the time of a step where its formulas change.
namespace rondo::choreo {

/// Finds the moments at which choices between terms change over, such as `select(clock < 2 s, a, b)`: where a
/// comparison of the clock with a number decides. Other choices stay as they are.
class Switches {
 public:
  /// Finds the switches of `formula`. Moments are seconds of `clock`.
  Switches(expr::Arena& arena, expr::TermId formula, expr::TermId clock);

  /// Reports whether the term changes over continuously, for certain, between two neighbouring moments, given
  /// that the variables in `changing` change continuously.
  bool IsContinuousBetween(expr::TermId term, const std::vector<expr::TermId>& changing);
  /// Reports whether there is any such switch.
  bool any() const { return !plain_.empty(); }
  /// Returns the formula or term between two neighbouring moments, with its choices made; not at these
  /// moments, at which it may choose otherwise.
  expr::TermId Settled(expr::TermId term, const expr::Rational& from,
                       const std::optional<expr::Rational>& to);
  /// Returns the same curve in pieces without such moments inside.
  Curve Split(const Curve& curve);

 private:
  bool IsPlain(expr::TermId condition);
  std::optional<expr::Rational> MomentOf(expr::TermId comparison);

  expr::Arena& arena_;
  expr::TermId clock_;
  std::set<expr::TermId> plain_;  // conditions
  std::vector<expr::Rational> moments_;
};

}  // namespace rondo::choreo
