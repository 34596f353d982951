// The constructors of Boolean terms, equality and quantifiers.
#include <algorithm>

#include "base/check.h"
#include "expr/arena.h"

namespace rondo::expr {

TermId Arena::Number(SortId sort, const Rational& value) {
  CHECK(sort == real_ || (sort == int_ && value.IsInteger())) << value.ToString();
  const auto [it, fresh] = number_ids_.emplace(value.Numerator() + "/" + value.Denominator(),
                                               static_cast<uint32_t>(numbers_.size()));
  if (fresh) numbers_.push_back(value);
  return Intern(Op::kNumber, sort, it->second, {});
}

TermId Arena::Member(SortId sort, uint32_t member) {
  CHECK(this->sort(sort).kind == SortKind::kEnum && member < this->sort(sort).names.size());
  return Intern(Op::kMember, sort, member, {});
}

TermId Arena::Variable(SymbolId id) {
  CHECK(symbol(id).parameters.empty());
  return Intern(Op::kVariable, symbol(id).result, id.value, {});
}

TermId Arena::Not(TermId a) {
  CHECK(sort_of(a) == bool_);
  const auto fire = [&](Rewrite rewrite, TermId result) {
    return Fire(rewrite, Op::kNot, bool_, 0, {a}, result);
  };
  switch (op(a)) {
    case Op::kBool:
      return fire(Rewrite::kNotConstant, a == true_ ? false_ : true_);
    case Op::kNot:
      return fire(Rewrite::kNotNot, arg(a, 0));
    case Op::kLe:
      return fire(Rewrite::kNotComparison, Lt(arg(a, 1), arg(a, 0)));
    case Op::kLt:
      return fire(Rewrite::kNotComparison, Le(arg(a, 1), arg(a, 0)));
    default:
      return Intern(Op::kNot, bool_, 0, std::vector{a});  // every other operator: nothing to simplify
  }
}

TermId Arena::And(const std::vector<TermId>& args) { return Junction(Op::kAnd, args); }
TermId Arena::Or(const std::vector<TermId>& args) { return Junction(Op::kOr, args); }

TermId Arena::Junction(Op op, const std::vector<TermId>& args) {
  const TermId neutral = op == Op::kAnd ? true_ : false_;
  const TermId zero = op == Op::kAnd ? false_ : true_;
  std::vector<TermId> flat;
  std::vector<Rewrite> fired;
  for (const TermId a : args) {
    CHECK(sort_of(a) == bool_);
    if (this->op(a) == op) {
      fired.push_back(Rewrite::kJunctionFlatten);
      const auto inner = this->args(a);
      flat.insert(flat.end(), inner.begin(), inner.end());
    } else {
      flat.push_back(a);
    }
  }
  std::vector<TermId> kept;
  std::unordered_set<TermId> seen;
  TermId result;
  for (const TermId a : flat) {
    if (a == neutral) {
      fired.push_back(Rewrite::kJunctionNeutral);
    } else if (a == zero) {
      fired.push_back(Rewrite::kJunctionZero);
      result = zero;
    } else if (!seen.insert(a).second) {
      fired.push_back(Rewrite::kJunctionSame);
    } else {
      kept.push_back(a);
    }
  }
  for (const TermId a : kept) {
    // Both may be false: an atomic formula about what has no value, and its negation.
    if (op == Op::kOr && IsPartial(a)) continue;
    if (this->op(a) == Op::kNot && seen.contains(arg(a, 0))) {
      fired.push_back(Rewrite::kJunctionOpposite);
      result = zero;
    }
  }
  if (!result.valid()) {
    if (kept.empty()) {
      result = neutral;
    } else if (kept.size() == 1) {
      result = kept[0];
    } else {
      std::sort(kept.begin(), kept.end());
      result = Intern(op, bool_, 0, kept);
    }
  }
  for (const Rewrite rewrite : fired) Fire(rewrite, op, bool_, 0, args, result);
  return result;
}

TermId Arena::Eq(TermId a, TermId b) {
  CHECK(sort_of(a) == sort_of(b)) << sort(sort_of(a)).name << " = " << sort(sort_of(b)).name;
  const auto fire = [&](Rewrite rewrite, TermId result) {
    return Fire(rewrite, Op::kEq, bool_, 0, {a, b}, result);
  };
  // Where a term has no value, neither the equation nor its negation holds.
  const bool partial = sort_of(a) != bool_ && (IsPartial(a) || IsPartial(b));
  if (a == b && !partial) return fire(Rewrite::kEqReflexive, true_);
  const bool constants = (op(a) == Op::kNumber || op(a) == Op::kMember) && op(a) == op(b);
  if (constants) return fire(Rewrite::kEqConstants, false_);
  if (sort_of(a) == bool_) {
    if (a == true_) return fire(Rewrite::kEqBoolean, b);
    if (b == true_) return fire(Rewrite::kEqBoolean, a);
    if (a == false_) return fire(Rewrite::kEqBoolean, Not(b));
    if (b == false_) return fire(Rewrite::kEqBoolean, Not(a));
  }
  if (op(a) == Op::kRecord && op(b) == Op::kRecord) {
    std::vector<TermId> fields;
    for (size_t i = 0; i < args(a).size(); ++i) fields.push_back(Eq(arg(a, i), arg(b, i)));
    return fire(Rewrite::kEqRecords, And(fields));
  }
  if (!partial && (sort_of(a) == int_ || sort_of(a) == real_)) {
    if (const auto distance = ConstantDistance(a, b))
      return fire(Rewrite::kEqDistance, Constant(distance->IsZero()));
  }
  if (b < a) return fire(Rewrite::kEqOrder, Intern(Op::kEq, bool_, 0, std::vector{b, a}));
  return Intern(Op::kEq, bool_, 0, std::vector{a, b});
}

TermId Arena::Ite(TermId c, TermId a, TermId b) {
  CHECK(sort_of(c) == bool_ && sort_of(a) == sort_of(b));
  const SortId s = sort_of(a);
  const auto fire = [&](Rewrite rewrite, TermId result) {
    return Fire(rewrite, Op::kIte, s, 0, {c, a, b}, result);
  };
  if (op(c) == Op::kBool) return fire(Rewrite::kIteConstant, c == true_ ? a : b);
  if (a == b && !IsPartial(c)) return fire(Rewrite::kIteSame, a);
  if (op(c) == Op::kNot) return fire(Rewrite::kIteNot, Ite(arg(c, 0), b, a));
  if (s == bool_) {
    if (a == true_) return fire(Rewrite::kIteBoolean, Or(c, b));
    if (a == false_) return fire(Rewrite::kIteBoolean, And(Not(c), b));
    if (b == true_) return fire(Rewrite::kIteBoolean, Or(Not(c), a));
    if (b == false_) return fire(Rewrite::kIteBoolean, And(c, a));
  }
  return Intern(Op::kIte, s, 0, std::vector{c, a, b});
}

TermId Arena::Forall(const std::vector<TermId>& variables, TermId body) {
  return Quantify(Op::kForall, variables, body);
}
TermId Arena::Exists(const std::vector<TermId>& variables, TermId body) {
  return Quantify(Op::kExists, variables, body);
}

TermId Arena::Quantify(Op op, const std::vector<TermId>& variables, TermId body) {
  CHECK(sort_of(body) == bool_);
  for (const TermId v : variables) CHECK(this->op(v) == Op::kVariable && symbol(symbol_of(v)).bound);
  std::vector<TermId> all = variables;
  all.push_back(body);
  // No sort is empty, so a quantifier whose variables do not occur says what its body says.
  if (variables.empty() || !IsOpen(body)) {
    return variables.empty() ? body
                             : Fire(Rewrite::kQuantifierUnused, op, bool_,
                                    static_cast<uint32_t>(variables.size()), std::move(all), body);
  }
  return Intern(op, bool_, static_cast<uint32_t>(variables.size()), all);
}

}  // namespace rondo::expr
