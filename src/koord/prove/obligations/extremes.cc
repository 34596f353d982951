#include "koord/prove/obligations/extremes.h"

#include <algorithm>

#include "expr/substitute.h"

namespace rondo::koord {

using expr::Op;
using solve::Assertion;

namespace {

// The variables of quantifiers in an open term that has no quantifier itself.
std::vector<TermId> BoundIn(const expr::Arena& arena, TermId term) {
  std::vector<TermId> result;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, term, seen, [&](TermId t) {
    if (arena.op(t) == Op::kVariable && arena.IsOpen(t)) result.push_back(t);
  });
  return result;
}

// Does an assertion of this need both a witness and an arbitrary robot?
bool Alternates(const expr::Arena& arena, TermId formula) {
  bool forall = false;
  bool exists = false;
  bool negated = false;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, formula, seen, [&](TermId t) {
    forall = forall || arena.op(t) == Op::kForall;
    exists = exists || arena.op(t) == Op::kExists;
    negated = negated || (arena.op(t) == Op::kNot && arena.HasQuantifier(t));
  });
  return (forall && exists) || ((forall || exists) && negated);
}

}  // namespace

Extremes::Extremes(Vocabulary& vocabulary)
    : vocabulary_(vocabulary), arena_(vocabulary.arena()), robot_(arena_.FreshBound("robot", arena_.Int())) {}

std::vector<Assertion> Extremes::Axioms(const std::vector<Assertion>& formulas) {
  std::vector<TermId> values;
  std::unordered_set<TermId> seen;
  for (const Assertion& a : formulas) {
    if (!Alternates(arena_, a.formula)) continue;
    std::vector<TermId> comparisons;
    expr::VisitPostorder(arena_, a.formula, seen, [&](TermId t) {
      if ((arena_.op(t) == Op::kLe || arena_.op(t) == Op::kLt) && arena_.IsOpen(t)) comparisons.push_back(t);
    });
    for (const TermId t : comparisons) {
      const TermId left = arena_.arg(t, 0);
      const TermId right = arena_.arg(t, 1);
      const std::vector<TermId> i = BoundIn(arena_, left);
      const std::vector<TermId> j = BoundIn(arena_, right);
      if (i.size() != 1 || j.size() != 1 || i == j || left == i[0]) continue;
      if (arena_.sort_of(i[0]) != arena_.Int() || arena_.sort_of(j[0]) != arena_.Int()) continue;
      const TermId value = Substitute(arena_, left, {{i[0], robot_}});
      if (value != Substitute(arena_, right, {{j[0], robot_}})) continue;
      if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    }
  }
  std::vector<Assertion> result;
  for (const TermId value : values) {
    const std::vector<Assertion>& of_one = Of(value);
    result.insert(result.end(), of_one.begin(), of_one.end());
  }
  return result;
}

const std::vector<Assertion>& Extremes::Of(TermId value) {
  std::vector<Assertion>& result = axioms_[value];
  if (!result.empty()) return result;
  for (const bool largest : {true, false}) {
    const TermId m = arena_.FreshBound("extreme", arena_.Int());
    const TermId k = arena_.FreshBound("robot", arena_.Int());
    const TermId at_m = Substitute(arena_, value, {{robot_, m}});
    const TermId at_k = Substitute(arena_, value, {{robot_, k}});
    const TermId order = largest ? arena_.Le(at_k, at_m) : arena_.Le(at_m, at_k);
    const TermId all = arena_.Forall({k}, arena_.Implies(vocabulary_.IsRobot(k), order));
    result.push_back({arena_.Exists({m}, arena_.And(vocabulary_.IsRobot(m), all)), ""});
  }
  return result;
}

}  // namespace rondo::koord
