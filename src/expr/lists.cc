#include "expr/lists.h"

#include "expr/substitute.h"

namespace rondo::expr {
namespace {

// at(result, k) = at(list, k + shift) for all lower <= k < upper
TermId Copies(Arena& arena, TermId result, TermId list, TermId lower, TermId upper, TermId shift) {
  const TermId k = arena.FreshBound("k", arena.Int());
  const TermId range = arena.And(arena.Le(lower, k), arena.Lt(k, upper));
  const TermId source = arena.At(list, arena.Add(k, shift));
  return arena.Forall({k}, arena.Implies(range, arena.Eq(arena.At(result, k), source)));
}

TermId Copies(Arena& arena, TermId result, TermId list, TermId lower, TermId upper, int shift) {
  return Copies(arena, result, list, lower, upper, arena.IntNumber(shift));
}

// `t` is `list` changed so if it can be, else the same.
TermId If(Arena& arena, TermId possible, TermId changed, TermId t) {
  return arena.And(arena.Implies(possible, changed),
                   arena.Implies(arena.Not(possible), arena.Eq(t, arena.arg(t, 0))));
}

TermId AxiomOfAppend(Arena& arena, TermId t) {
  const TermId list = arena.arg(t, 0);
  const TermId length = arena.Length(list);
  return arena.And({arena.Eq(arena.Length(t), arena.Add(length, arena.IntNumber(1))),
                    arena.Eq(arena.At(t, length), arena.arg(t, 1)),
                    Copies(arena, t, list, arena.IntNumber(0), length, 0)});
}

TermId AxiomOfRemove(Arena& arena, TermId t) {
  const TermId list = arena.arg(t, 0);
  const TermId element = arena.arg(t, 1);
  const TermId length = arena.Length(list);
  const TermId zero = arena.IntNumber(0);
  const TermId k = arena.FreshBound("k", arena.Int());
  const auto absent_below = [&](TermId bound) {
    return arena.Forall({k}, arena.Implies(arena.And(arena.Le(zero, k), arena.Lt(k, bound)),
                                           arena.Not(arena.Eq(arena.At(list, k), element))));
  };
  // The place of the first occurrence, or the length if there is none.
  const TermId place = arena.FreshConstant("place", arena.Int());
  const TermId found = arena.Lt(place, length);
  const TermId shorter = arena.Sub(length, arena.IntNumber(1));
  return arena.And({arena.Le(zero, place), arena.Le(place, length), absent_below(place),
                    arena.Implies(found, arena.And({arena.Eq(arena.At(list, place), element),
                                                    arena.Eq(arena.Length(t), shorter),
                                                    Copies(arena, t, list, zero, place, 0),
                                                    Copies(arena, t, list, place, shorter, 1)})),
                    arena.Implies(arena.Not(found), arena.Eq(t, list))});
}

TermId AxiomOfSet(Arena& arena, TermId t) {
  const TermId list = arena.arg(t, 0);
  const TermId index = arena.arg(t, 1);
  const TermId length = arena.Length(list);
  const TermId zero = arena.IntNumber(0);
  const TermId inside = arena.And(arena.Le(zero, index), arena.Lt(index, length));
  const TermId changed =
      arena.And({arena.Eq(arena.Length(t), length), arena.Eq(arena.At(t, index), arena.arg(t, 2)),
                 Copies(arena, t, list, zero, index, 0),
                 Copies(arena, t, list, arena.Add(index, arena.IntNumber(1)), length, 0)});
  return If(arena, inside, changed, t);
}

TermId AxiomOfInsert(Arena& arena, TermId t) {
  const TermId list = arena.arg(t, 0);
  const TermId index = arena.arg(t, 1);
  const TermId length = arena.Length(list);
  const TermId zero = arena.IntNumber(0);
  const TermId one = arena.IntNumber(1);
  const TermId longer = arena.Add(length, one);
  const TermId changed = arena.And(
      {arena.Eq(arena.Length(t), longer), arena.Eq(arena.At(t, index), arena.arg(t, 2)),
       Copies(arena, t, list, zero, index, 0), Copies(arena, t, list, arena.Add(index, one), longer, -1)});
  return If(arena, arena.And(arena.Le(zero, index), arena.Le(index, length)), changed, t);
}

TermId AxiomOfDrop(Arena& arena, TermId t) {
  const TermId list = arena.arg(t, 0);
  const TermId index = arena.arg(t, 1);
  const TermId length = arena.Length(list);
  const TermId zero = arena.IntNumber(0);
  const TermId shorter = arena.Sub(length, arena.IntNumber(1));
  const TermId changed =
      arena.And({arena.Eq(arena.Length(t), shorter), Copies(arena, t, list, zero, index, 0),
                 Copies(arena, t, list, index, shorter, 1)});
  return If(arena, arena.And(arena.Le(zero, index), arena.Lt(index, length)), changed, t);
}

TermId AxiomOfSlice(Arena& arena, TermId t) {
  const TermId list = arena.arg(t, 0);
  const TermId from = arena.arg(t, 1);
  const TermId to = arena.arg(t, 2);
  const TermId zero = arena.IntNumber(0);
  const TermId length = arena.Sub(to, from);
  const TermId changed =
      arena.And(arena.Eq(arena.Length(t), length), Copies(arena, t, list, zero, length, from));
  const TermId inside =
      arena.And({arena.Le(zero, from), arena.Le(from, to), arena.Le(to, arena.Length(list))});
  return If(arena, inside, changed, t);
}

TermId AxiomOfLiteral(Arena& arena, TermId t) {
  // Raw, for the constructors would simplify what has to be said.
  const SortId element = arena.sort(arena.sort_of(t)).parts[0];
  const std::vector<TermId> items(arena.args(t).begin(), arena.args(t).end());
  std::vector<TermId> facts;
  const TermId length = arena.Raw(Op::kListLength, arena.Int(), 0, {t});
  facts.push_back(
      arena.Raw(Op::kEq, arena.Bool(), 0, {length, arena.IntNumber(static_cast<int64_t>(items.size()))}));
  for (size_t i = 0; i < items.size(); ++i) {
    const TermId at = arena.Raw(Op::kListAt, element, 0, {t, arena.IntNumber(static_cast<int64_t>(i))});
    facts.push_back(arena.Raw(Op::kEq, arena.Bool(), 0, {at, items[i]}));
  }
  return arena.And(facts);
}

// Lists with equal items are equal: for the two sides of an equation.
TermId Extensionality(Arena& arena, TermId equation) {
  const TermId a = arena.arg(equation, 0);
  const TermId b = arena.arg(equation, 1);
  const TermId k = arena.FreshConstant("difference", arena.Int());
  const TermId inside = arena.And(arena.Le(arena.IntNumber(0), k), arena.Lt(k, arena.Length(a)));
  const TermId differ = arena.And(inside, arena.Not(arena.Eq(arena.At(a, k), arena.At(b, k))));
  return arena.Or({equation, arena.Not(arena.Eq(arena.Length(a), arena.Length(b))), differ});
}

}  // namespace

std::vector<TermId> ListAxioms(Arena& arena, std::span<const TermId> formulas,
                               std::unordered_set<TermId>& done) {
  std::unordered_set<TermId> seen;
  std::vector<TermId> lists;
  std::vector<TermId> equations;
  for (const TermId formula : formulas) {
    VisitPostorder(arena, formula, seen, [&](TermId t) {
      if (arena.sort(arena.sort_of(t)).kind == SortKind::kList && !arena.IsOpen(t) && done.insert(t).second) {
        lists.push_back(t);
      }
      const bool equation =
          arena.op(t) == Op::kEq && arena.sort(arena.sort_of(arena.arg(t, 0))).kind == SortKind::kList;
      if (equation && !arena.IsOpen(t) && done.insert(t).second) equations.push_back(t);
    });
  }
  std::vector<TermId> axioms;
  for (const TermId equation : equations) axioms.push_back(Extensionality(arena, equation));
  for (const TermId t : lists) {
    switch (arena.op(t)) {
      case Op::kListMake:
        axioms.push_back(AxiomOfLiteral(arena, t));
        break;
      case Op::kListAppend:
        axioms.push_back(AxiomOfAppend(arena, t));
        break;
      case Op::kListRemove:
        axioms.push_back(AxiomOfRemove(arena, t));
        break;
      case Op::kListSet:
        axioms.push_back(AxiomOfSet(arena, t));
        break;
      case Op::kListInsert:
        axioms.push_back(AxiomOfInsert(arena, t));
        break;
      case Op::kListDrop:
        axioms.push_back(AxiomOfDrop(arena, t));
        break;
      case Op::kListSlice:
        axioms.push_back(AxiomOfSlice(arena, t));
        break;
      default:
        axioms.push_back(arena.Le(arena.IntNumber(0), arena.Length(t)));
        break;  // any list
    }
  }
  return axioms;
}

}  // namespace rondo::expr
