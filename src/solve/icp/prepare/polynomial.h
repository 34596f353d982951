#pragma once

#include <utility>

#include "expr/polynomial.h"

namespace rondo::solve::icp {

/// A number and a term that together make `term`; if that is a sum, the first coefficient of the other is 1.
std::pair<expr::Rational, expr::TermId> Monic(expr::Arena& arena, expr::TermId term);

/// An equal term that says the same with fewer occurrences: quadratic polynomials by completing squares,
/// others by collecting a sum that occurs as a factor of several summands when its cofactor is a multiple of
/// itself. Interval arithmetic is the sharper the fewer occurrences there are. Exact; `term` itself if
/// nothing applies.
expr::TermId Condense(expr::Arena& arena, expr::TermId term);

}  // namespace rondo::solve::icp
