#pragma once

#include <optional>
#include <vector>

#include "expr/arena.h"
#include "expr/substitute.h"

/// Curves of states over the clock, as terms, and what is plain about formulas along them.
namespace rondo::choreo {

/// From `from` to `to` seconds (without `to`: for ever) each variable has this value: a term over the clock,
/// over the start, and over what others do.
struct CurvePiece {
  expr::Rational from;
  std::optional<expr::Rational> to;
  expr::Substitution value;
};
using Curve = std::vector<CurvePiece>;

/// Does a comparison, or a conjunction of such, hold between two moments whenever it holds at both? So it
/// does if it compares a convex with a concave function of the clock; everything else is constant meanwhile.
bool HoldsBetween(expr::Arena& arena, expr::TermId formula, expr::TermId clock);

/// Is the term for certain a continuous function of its variables, wherever it has a value? Choices between
/// terms, remainders, quotients by variables and the angle of a point are not, unless nothing of `changing`
/// occurs in them.
bool IsContinuous(const expr::Arena& arena, expr::TermId term, const std::vector<expr::TermId>& changing);

/// The formula with every inequality to be met with this much to spare.
expr::TermId Tightened(expr::Arena& arena, expr::TermId formula, const expr::Rational& spare);

}  // namespace rondo::choreo
