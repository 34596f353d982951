#include "choreo/obligations/solve_for.h"

#include <algorithm>

#include "expr/polynomial.h"
#include "robot/values/value.h"

namespace rondo::choreo {

using expr::Rational;
using expr::TermId;

std::optional<TermId> SolveFor(expr::Arena& arena, TermId equation, TermId variable) {
  constexpr size_t kMostMonomials = 200;
  if (arena.op(equation) != expr::Op::kEq || arena.sort_of(arena.arg(equation, 0)) != arena.Real())
    return std::nullopt;
  const TermId left = arena.arg(equation, 0), right = arena.arg(equation, 1);
  const auto mentions = [&](TermId t) { return robot::VariablesOf(arena, {t}).contains(variable); };
  // Other formulas may mention the same term.
  if (left == variable && !mentions(right)) return right;
  if (right == variable && !mentions(left)) return left;
  auto p = expr::Expand(arena, arena.Sub(left, right), kMostMonomials);
  if (!p) return std::nullopt;
  const auto own = p->find({variable});
  if (own == p->end()) return std::nullopt;
  const Rational coefficient = own->second;
  p->erase(own);
  for (const auto& [monomial, c] : *p) {
    if (std::ranges::any_of(monomial, mentions)) return std::nullopt;
  }
  return arena.Mul(arena.Number(arena.Real(), Rational(-1) / coefficient), expr::ToTerm(arena, *p));
}

}  // namespace rondo::choreo
