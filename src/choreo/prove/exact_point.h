#pragma once

#include <optional>

#include "expr/arena.h"
#include "expr/numeric.h"

/// Finds exact solutions where search finds only small boxes.
namespace rondo::choreo {

/// Returns a solution of the formula in exact numbers, near a point that nearly is one: where shapes only
/// touch, or a set has no inside, no box of states contains solutions alone. Equations give what they
/// determine; other variables get numbers that stand in the formula, or the simplest fraction nearby. Returns
/// nothing if none of these tries is exact; angles that are no right angles make most points irrational.
/// Cost: at most some hundred substitutions.
std::optional<expr::Numeric::Point> ExactPoint(expr::Arena& arena, expr::TermId formula,
                                               const expr::Numeric::Point& near);

}  // namespace rondo::choreo
