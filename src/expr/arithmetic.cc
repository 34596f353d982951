// The constructors of numeric terms: sums are kept in linear normal form, so that equal sums have equal ids.
#include <algorithm>
#include <map>

#include "base/check.h"
#include "expr/arena.h"
#include "expr/defined.h"

namespace rondo::expr {
namespace {

/// constant + sum of coefficient * term
struct Linear {
  Rational constant;
  std::map<TermId, Rational> coefficients;
};

void Accumulate(const Arena& arena, TermId t, const Rational& factor, Linear& sum) {
  switch (arena.op(t)) {
    case Op::kNumber:
      sum.constant = sum.constant + factor * arena.number(t);
      return;
    case Op::kAdd:
      for (const TermId arg : arena.args(t)) Accumulate(arena, arg, factor, sum);
      return;
    case Op::kMul:
      if (arena.IsNumber(arena.arg(t, 0))) {
        Accumulate(arena, arena.arg(t, 1), factor * arena.number(arena.arg(t, 0)), sum);
        return;
      }
      break;
    default:
      break;  // any other operator is one term of the sum
  }
  Rational& coefficient = sum.coefficients[t];
  coefficient = coefficient + factor;
}

}  // namespace

// Builds no terms: comparisons are made far more often than they can be decided here.
std::optional<Rational> Arena::ConstantDistance(TermId a, TermId b) const {
  if (a == b) return Rational(0);
  const auto composed = [&](TermId t) {
    return op(t) == Op::kNumber || op(t) == Op::kAdd || op(t) == Op::kMul;
  };
  if (!composed(a) && !composed(b)) return std::nullopt;
  Linear sum;
  Accumulate(*this, a, Rational(1), sum);
  Accumulate(*this, b, Rational(-1), sum);
  for (const auto& [t, coefficient] : sum.coefficients) {
    if (!coefficient.IsZero()) return std::nullopt;
  }
  return sum.constant;
}

TermId Arena::Add(std::vector<TermId> args) {
  CHECK(!args.empty());
  const SortId s = sort_of(args[0]);
  Linear sum;
  for (const TermId a : args) {
    CHECK(sort_of(a) == s && (s == int_ || s == real_));
    Accumulate(*this, a, Rational(1), sum);
  }
  std::vector<TermId> parts;
  if (!sum.constant.IsZero()) parts.push_back(Number(s, sum.constant));
  for (const auto& [t, coefficient] : sum.coefficients) {
    if (coefficient.IsZero()) {
      if (IsPartial(t)) parts.push_back(Zero(t));
      continue;
    }
    parts.push_back(
        coefficient == Rational(1) ? t : Intern(Op::kMul, s, 0, std::vector{Number(s, coefficient), t}));
  }
  TermId result;
  if (parts.empty()) {
    result = Number(s, Rational(0));
  } else if (parts.size() == 1) {
    result = parts[0];
  } else {
    result = Intern(Op::kAdd, s, 0, parts);
  }
  const bool plain = op(result) == Op::kAdd && std::ranges::equal(this->args(result), args);
  return plain ? result : Fire(Rewrite::kAddNormal, Op::kAdd, s, 0, std::move(args), result);
}

// 0 * t: zero where t has a value, else none.
TermId Arena::Zero(TermId t) {
  const TermId zero = Number(sort_of(t), Rational(0));
  if (!IsPartial(t)) return zero;
  const bool already = op(t) == Op::kIte && arg(t, 1) == zero && arg(t, 0) == Defined(*this, arg(t, 2));
  return already ? t : Ite(Defined(*this, t), zero, t);
}

TermId Arena::Neg(TermId a) { return Mul(Number(sort_of(a), Rational(-1)), a); }

TermId Arena::Mul(TermId a, TermId b) {
  const SortId s = sort_of(a);
  CHECK(s == sort_of(b) && (s == int_ || s == real_));
  const auto fire = [&](Rewrite rewrite, TermId result) {
    return Fire(rewrite, Op::kMul, s, 0, {a, b}, result);
  };
  if (IsNumber(a) && IsNumber(b)) return fire(Rewrite::kMulConstants, Number(s, number(a) * number(b)));
  if (IsNumber(b)) return fire(Rewrite::kMulOrder, Mul(b, a));
  if (IsNumber(a)) {
    if (number(a).IsZero()) return fire(Rewrite::kMulConstants, Zero(b));
    if (number(a) == Rational(1)) return fire(Rewrite::kMulConstants, b);
    if (op(b) == Op::kAdd || (op(b) == Op::kMul && IsNumber(arg(b, 0)))) {
      Linear sum;
      Accumulate(*this, b, number(a), sum);
      std::vector<TermId> parts{Number(s, sum.constant)};
      for (const auto& [t, c] : sum.coefficients)
        parts.push_back(Intern(Op::kMul, s, 0, std::vector{Number(s, c), t}));
      return fire(Rewrite::kMulDistribute, Add(std::move(parts)));
    }
    return Intern(Op::kMul, s, 0, std::vector{a, b});
  }
  if (b < a) return fire(Rewrite::kMulOrder, Intern(Op::kMul, s, 0, std::vector{b, a}));
  return Intern(Op::kMul, s, 0, std::vector{a, b});
}

TermId Arena::Divide(TermId a, TermId b) {
  CHECK(sort_of(a) == real_ && sort_of(b) == real_);
  if (IsNumber(b) && !number(b).IsZero()) {
    return Fire(Rewrite::kDivideConstant, Op::kDivide, real_, 0, {a, b},
                Mul(Number(real_, Rational(1) / number(b)), a));
  }
  return Intern(Op::kDivide, real_, 0, std::vector{a, b});
}

TermId Arena::IntDiv(TermId a, TermId b) {
  CHECK(sort_of(a) == int_ && sort_of(b) == int_);
  if (IsNumber(a) && IsNumber(b) && !number(b).IsZero()) {
    return Fire(Rewrite::kIntDivConstants, Op::kIntDiv, int_, 0, {a, b},
                Number(int_, EuclideanQuotient(number(a), number(b))));
  }
  return Intern(Op::kIntDiv, int_, 0, std::vector{a, b});
}

TermId Arena::Mod(TermId a, TermId b) {
  CHECK(sort_of(a) == int_ && sort_of(b) == int_);
  if (IsNumber(a) && IsNumber(b) && !number(b).IsZero()) {
    return Fire(Rewrite::kModConstants, Op::kMod, int_, 0, {a, b},
                Number(int_, number(a) - number(b) * EuclideanQuotient(number(a), number(b))));
  }
  return Intern(Op::kMod, int_, 0, std::vector{a, b});
}

TermId Arena::Le(TermId a, TermId b) { return Compare(Op::kLe, a, b); }
TermId Arena::Lt(TermId a, TermId b) { return Compare(Op::kLt, a, b); }

TermId Arena::Compare(Op op, TermId a, TermId b) {
  CHECK(sort_of(a) == sort_of(b) && (sort_of(a) == int_ || sort_of(a) == real_));
  // Where a term has no value, neither the comparison nor its negation holds.
  if (IsPartial(a) || IsPartial(b)) return Intern(op, bool_, 0, std::vector{a, b});
  if (const auto distance = ConstantDistance(a, b)) {
    const bool holds = op == Op::kLe ? *distance <= Rational(0) : *distance < Rational(0);
    return Fire(Rewrite::kCompareDistance, op, bool_, 0, {a, b}, Constant(holds));
  }
  return Intern(op, bool_, 0, std::vector{a, b});
}

TermId Arena::ToReal(TermId a) {
  if (sort_of(a) == real_) return a;
  CHECK(sort_of(a) == int_);
  if (IsNumber(a)) {
    return Fire(Rewrite::kToRealConstant, Op::kToReal, real_, 0, {a}, Number(real_, number(a)));
  }
  return Intern(Op::kToReal, real_, 0, std::vector{a});
}

}  // namespace rondo::expr
