#pragma once

#include <optional>

#include "expr/arena.h"

/// Solves single equations.
namespace rondo::choreo {

/// Solves an equation of reals for a variable that occurs in it linearly, with a number as coefficient;
/// returns nothing if it does not. If the equation has the variable alone on one side, the result is the
/// other side as it is written.
std::optional<expr::TermId> SolveFor(expr::Arena& arena, expr::TermId equation, expr::TermId variable);

}  // namespace rondo::choreo
