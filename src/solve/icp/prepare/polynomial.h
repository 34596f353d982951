#pragma once

#include <utility>

#include "expr/polynomial.h"

/// Polynomials written so that interval arithmetic is sharp on them.
namespace rondo::solve::icp {

/// Returns a number and a term whose product is `term`; if that is a sum, the first coefficient of the other
/// is 1.
std::pair<expr::Rational, expr::TermId> Monic(expr::Arena& arena, expr::TermId term);

/// Returns an equal term with fewer occurrences of variables: quadratic polynomials by completing squares,
/// others by collecting a sum that occurs as a factor of several summands when its cofactor is a multiple of
/// itself. Interval arithmetic is the sharper the fewer occurrences there are. Exact; `term` itself if
/// nothing applies.
expr::TermId Condense(expr::Arena& arena, expr::TermId term);

}  // namespace rondo::solve::icp
