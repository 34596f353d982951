#include "solve/icp/prepare/literal.h"

#include "base/check.h"

namespace rondo::solve::icp {

using expr::Op;

namespace {

// The coefficient and the rest of one summand.
std::pair<Rational, TermId> Split(const expr::Arena& arena, TermId t) {
  if (arena.op(t) == Op::kMul && arena.IsNumber(arena.arg(t, 0)))
    return {arena.number(arena.arg(t, 0)), arena.arg(t, 1)};
  return {Rational(1), t};
}

Relation Mirrored(Relation r) {
  return static_cast<Relation>((r & kEqual) | ((r & kLess) != 0 ? kGreater : 0) |
                               ((r & kGreater) != 0 ? kLess : 0));
}

}  // namespace

bool Holds(const Rational& a, Relation relation, const Rational& b) {
  const Relation is = a < b ? kLess : a == b ? kEqual : kGreater;
  return (relation & is) != 0;
}

std::optional<Literal> AsLiteral(expr::Arena& arena, TermId formula) {
  Relation relation = 0;
  TermId atom = formula;
  switch (arena.op(formula)) {
    case Op::kLe:
      relation = kLess | kEqual;
      break;
    case Op::kLt:
      relation = kLess;
      break;
    case Op::kEq:
      relation = kEqual;
      break;
    case Op::kNot:
      atom = arena.arg(formula, 0);
      if (arena.op(atom) != Op::kEq) return std::nullopt;
      relation = kLess | kGreater;
      break;
    default:
      return std::nullopt;
  }
  const TermId difference = arena.Sub(arena.arg(atom, 0), arena.arg(atom, 1));
  Rational constant;
  TermId rest = difference;
  if (arena.IsNumber(difference)) {
    return Literal{difference, relation, Rational(0)};
  }
  if (arena.op(difference) == Op::kAdd && arena.IsNumber(arena.arg(difference, 0))) {
    constant = arena.number(arena.arg(difference, 0));
    rest = arena.Sub(difference, arena.arg(difference, 0));
  }
  const TermId first = arena.op(rest) == Op::kAdd ? arena.arg(rest, 0) : rest;
  const Rational lead = Split(arena, first).first;
  const TermId monic = arena.Mul(arena.Number(arena.Real(), Rational(1) / lead), rest);
  const Rational bound = Rational(0) - constant / lead;
  return Literal{monic, lead < Rational(0) ? Mirrored(relation) : relation, bound};
}

TermId ToFormula(expr::Arena& arena, const Literal& literal) {
  const TermId bound = arena.Number(arena.Real(), literal.bound);
  switch (literal.relation) {
    case 0:
      return arena.False();
    case kLess:
      return arena.Lt(literal.term, bound);
    case kLess | kEqual:
      return arena.Le(literal.term, bound);
    case kEqual:
      return arena.Eq(literal.term, bound);
    case kGreater | kEqual:
      return arena.Le(bound, literal.term);
    case kGreater:
      return arena.Lt(bound, literal.term);
    case kLess | kGreater:
      return arena.Not(arena.Eq(literal.term, bound));
    default:
      return arena.True();
  }
}

TermId Normalised(expr::Arena& arena, TermId formula) {
  const Op op = arena.op(formula);
  if (op == Op::kAnd || op == Op::kOr) {
    std::vector<TermId> parts(arena.args(formula).begin(), arena.args(formula).end());
    for (TermId& part : parts) part = Normalised(arena, part);
    return op == Op::kAnd ? arena.And(parts) : arena.Or(parts);
  }
  const auto literal = AsLiteral(arena, formula);
  return literal && !arena.IsNumber(literal->term) ? ToFormula(arena, *literal) : formula;
}

}  // namespace rondo::solve::icp
