#include "koord/prove/obligations/roundings.h"

#include <functional>
#include <unordered_set>

#include "expr/substitute.h"

namespace rondo::koord {

using expr::Rational;

namespace {

// Calls `visit(term, is it a root?)` for each term. It must make no terms.
void EachRounding(Vocabulary& vocabulary, const std::vector<TermId>& formulas,
                  const std::function<void(TermId, bool)>& visit) {
  if (!vocabulary.uses_roundings()) return;
  const expr::Arena& arena = vocabulary.arena();
  const expr::SymbolId floor = vocabulary.Floor();
  const expr::SymbolId sqrt = vocabulary.Sqrt();
  std::unordered_set<TermId> seen;
  for (const TermId formula : formulas) {
    expr::VisitPostorder(arena, formula, seen, [&](TermId t) {
      if (arena.op(t) != expr::Op::kApply) return;
      if (arena.symbol_of(t) == floor || arena.symbol_of(t) == sqrt) visit(t, arena.symbol_of(t) == sqrt);
    });
  }
}

}  // namespace

std::vector<TermId> Roundings::Axioms(const std::vector<TermId>& formulas) {
  std::vector<std::pair<TermId, bool>> terms;
  EachRounding(vocabulary_, formulas, [&](TermId t, bool root) {
    if (!arena_.IsOpen(t) && said_.insert(t).second) terms.emplace_back(t, root);
  });
  std::vector<TermId> axioms;
  const TermId zero = arena_.Number(arena_.Real(), Rational(0));
  for (const auto& [t, root] : terms) {
    const TermId x = arena_.arg(t, 0);
    if (root) {
      axioms.push_back(
          arena_.Implies(arena_.Le(zero, x), arena_.And(arena_.Le(zero, t), arena_.Eq(arena_.Mul(t, t), x))));
      continue;
    }
    const TermId below = arena_.ToReal(t);
    const TermId next = arena_.Add(below, arena_.Number(arena_.Real(), Rational(1)));
    axioms.push_back(arena_.And(arena_.Le(below, x), arena_.Lt(x, next)));
  }
  return axioms;
}

bool RoundsAnyNumber(Vocabulary& vocabulary, const std::vector<TermId>& formulas) {
  bool any = false;
  EachRounding(vocabulary, formulas, [&](TermId t, bool) { any = any || vocabulary.arena().IsOpen(t); });
  return any;
}

}  // namespace rondo::koord
