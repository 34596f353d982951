#pragma once

#include <optional>
#include <vector>

#include "expr/arena.h"
#include "expr/substitute.h"

/// Represents curves of states over the clock, as terms, and tells what is plain about formulas along them.
namespace rondo::choreo {

/// Gives each variable its value from `from` to `to` seconds (without `to`: for ever): a term over the clock,
/// over the start, and over what others do.
struct CurvePiece {
  expr::Rational from;
  std::optional<expr::Rational> to;
  expr::Substitution value;
};
/// Represents a curve: pieces in order of time, each beginning where the one before ends.
using Curve = std::vector<CurvePiece>;

/// Reports whether a comparison, or a conjunction of such, holds between two moments whenever it holds at
/// both, as far as its structure shows. So it does if it compares a convex with a concave function of the
/// clock; everything else is constant meanwhile.
bool HoldsBetween(expr::Arena& arena, expr::TermId formula, expr::TermId clock);

/// Reports whether the term is for certain a continuous function of its variables, wherever it has a value.
/// Choices between terms, remainders, quotients by variables and the angle of a point are not, unless nothing
/// of `changing` occurs in them.
bool IsContinuous(const expr::Arena& arena, expr::TermId term, const std::vector<expr::TermId>& changing);

/// Returns the formula with every inequality to be met with this much to spare (SI units), strict ones
/// included; equations stay as they are.
expr::TermId Tightened(expr::Arena& arena, expr::TermId formula, const expr::Rational& spare);

}  // namespace rondo::choreo
