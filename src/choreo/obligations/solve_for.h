#pragma once

#include <optional>

#include "expr/arena.h"

namespace rondo::choreo {

/// Solves an equation of reals for a variable that occurs in it linearly, with a number as coefficient;
/// nothing if it does not. Of an equation that has the variable alone on one side, the other side as it is
/// written.
std::optional<expr::TermId> SolveFor(expr::Arena& arena, expr::TermId equation, expr::TermId variable);

}  // namespace rondo::choreo
