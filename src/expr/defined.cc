#include "expr/defined.h"

#include "expr/elementary.h"
#include "expr/substitute.h"

namespace rondo::expr {

TermId Undefined(Arena& arena, TermId term) {
  if (!arena.IsPartial(term)) return arena.False();
  std::vector<TermId> partial;
  std::unordered_set<TermId> seen;
  VisitPostorder(arena, term, seen, [&](TermId t) {
    if (arena.op(t) != Op::kElementary) return;
    if (IsPartialFunction(arena.elementary_of(t))) partial.push_back(t);
  });
  const auto number = [&](int64_t n) { return arena.Number(arena.Real(), Rational(n)); };
  std::vector<TermId> outside;
  for (const TermId t : partial) {
    const TermId a = arena.arg(t, 0);
    switch (arena.elementary_of(t)) {
      case Elementary::kSqrt:
        outside.push_back(arena.Lt(a, number(0)));
        break;
      case Elementary::kLog:
        outside.push_back(arena.Le(a, number(0)));
        break;
      default:
        outside.push_back(arena.Lt(a, number(-1)));
        outside.push_back(arena.Lt(number(1), a));
    }
  }
  return arena.Or(outside);
}

TermId Complement(Arena& arena, TermId formula) {
  if (!arena.IsPartial(formula)) return arena.Not(formula);
  const std::vector<TermId> args(arena.args(formula).begin(), arena.args(formula).end());
  std::vector<TermId> parts;
  switch (arena.op(formula)) {
    case Op::kAnd:
    case Op::kOr:
      for (const TermId a : args) parts.push_back(Complement(arena, a));
      return arena.op(formula) == Op::kAnd ? arena.Or(parts) : arena.And(parts);
    case Op::kIte:
      // Either branch may be the one; what is undefined is in neither.
      return arena.And(arena.Or(Complement(arena, args[0]), Complement(arena, args[1])),
                       arena.Or(Complement(arena, arena.Not(args[0])), Complement(arena, args[2])));
    default:
      // An atomic formula, or its negation.
      return arena.Or(arena.Not(formula), Undefined(arena, formula));
  }
}

}  // namespace rondo::expr
