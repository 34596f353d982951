#include <fmt/format.h>

#include "choreo/obligations/statements.h"
#include "expr/defined.h"
#include "expr/substitute.h"

namespace rondo::choreo {

using expr::Arena;
using expr::Rational;
using expr::TermId;

namespace {

// Values of `v` at which comparisons change, and some between and beside them.
std::vector<TermId> Candidates(Arena& arena, TermId formula, TermId v) {
  if (arena.sort_of(v) == arena.Bool()) return {arena.True(), arena.False()};
  const auto number = [&](const Rational& r) { return arena.Number(arena.Real(), r); };
  const TermId zero = number(0), one = number(1), half = number(Rational(1) / Rational(2));
  std::vector<TermId> comparisons;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, formula, seen, [&](TermId t) {
    const expr::Op op = arena.op(t);
    if (op != expr::Op::kLe && op != expr::Op::kLt && op != expr::Op::kEq) return;
    if (arena.sort_of(arena.arg(t, 0)) != arena.Bool()) comparisons.push_back(t);
  });
  std::vector<TermId> bounds;
  for (const TermId t : comparisons) {
    // a + b v = 0
    const TermId difference = arena.Sub(arena.arg(t, 0), arena.arg(t, 1));
    const TermId a = expr::Substitute(arena, difference, {{v, zero}});
    const TermId b = arena.Sub(expr::Substitute(arena, difference, {{v, one}}), a);
    if (b != zero) bounds.push_back(arena.Neg(arena.Divide(a, b)));
  }
  constexpr size_t kMostBounds = 4;
  std::vector<TermId> values;
  for (size_t i = 0; i < bounds.size() && i < kMostBounds; ++i) {
    values.insert(values.end(), {bounds[i], arena.Add(bounds[i], one), arena.Sub(bounds[i], one)});
    for (size_t j = 0; j < i; ++j) values.push_back(arena.Mul(half, arena.Add(bounds[i], bounds[j])));
  }
  if (values.empty()) values.push_back(zero);
  return values;
}

/// A promise for some value of the payload, and where it has no value.
struct Try {
  TermId holds, undefined;
};

}  // namespace

// In each state one of the values that come into question has to do.
void StatePromise(Statements& s, const Node& n, std::vector<TermId> known) {
  if (n.refinement == s.arena().True()) return;
  Arena& arena = s.arena();
  std::vector<Try> ways{{n.refinement, expr::Undefined(arena, n.refinement)}};
  std::set<TermId> carried;
  for (size_t i = 0; i < n.payload.size() && i < n.names.size(); ++i) {
    if (!n.names[i].empty()) carried.merge(robot::VariablesOf(arena, n.payload[i].terms));
  }
  for (const TermId v : carried) {
    std::vector<Try> next;
    for (const Try& way : ways) {
      for (const TermId candidate : Candidates(arena, way.holds, v)) {
        next.push_back({expr::Substitute(arena, way.holds, {{v, candidate}}),
                        expr::Substitute(arena, way.undefined, {{v, candidate}})});
      }
    }
    constexpr size_t kMostWays = 64;
    if (next.size() > kMostWays) next.resize(kMostWays);
    ways = std::move(next);
  }
  std::vector<TermId> fails;
  for (const Try& way : ways) fails.push_back(arena.Or(s.Fails(way.holds), way.undefined));
  known.push_back(arena.And(fails));
  s.Unsat(ObligationKind::kMessage, n.span,
          {fmt::format("something that `{}` may carry", n.label),
           fmt::format("there may be nothing that `{}` can carry as promised", n.label)},
          known);
}

}  // namespace rondo::choreo
