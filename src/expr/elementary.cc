#include "expr/elementary.h"

#include <cstdlib>
#include <iterator>

#include "base/check.h"
#include "expr/arena.h"

namespace rondo::expr {

namespace {

constexpr int64_t kLargestExponent = 64;  // written as a product
constexpr size_t kMostDigits = 20'000;

// An integer between -kMost and kMost.
std::optional<int64_t> SmallInteger(const Rational& value, int64_t most) {
  if (!value.IsInteger() || value > Rational(most) || value < Rational(-most)) return std::nullopt;
  return static_cast<int64_t>(value.ToDouble());
}

std::optional<Rational> ExactPower(const Rational& base, const Rational& exponent) {
  if (exponent.IsZero() || base == Rational(1)) return Rational(1);
  if (base.IsZero()) return exponent > Rational(0) ? std::optional(Rational(0)) : std::nullopt;
  constexpr int64_t kMost = 10'000;
  const auto n = SmallInteger(exponent, kMost);
  if (!n || base.Digits() * static_cast<size_t>(std::abs(*n)) > kMostDigits) return std::nullopt;
  Rational result(1);
  for (int64_t i = 0; i < std::abs(*n); ++i) result = result * base;
  return *n < 0 ? Rational(1) / result : result;
}

}  // namespace

std::optional<Elementary> FindElementary(std::string_view name) {
  struct Names {
    std::string_view name, other;
  };
  static constexpr Names kNames[] = {
#define RONDO_ELEMENTARY(kind, name, other, arity, partial) {name, other},
#include "expr/elementary.def"
#undef RONDO_ELEMENTARY
  };
  for (size_t i = 0; i < std::size(kNames); ++i) {
    if (!name.empty() && (name == kNames[i].name || name == kNames[i].other))
      return static_cast<Elementary>(i);
  }
  return std::nullopt;
}

std::optional<Rational> ExactValue(Elementary function, std::span<const Rational> args) {
  const Rational zero(0);
  const Rational one(1);
  const Rational& a = args[0];
  const auto known = [&](const Rational& at, const Rational& value) {
    return a == at ? std::optional(value) : std::nullopt;
  };
  switch (function) {
    case Elementary::kSqrt:
      return a.ExactRoot();
    case Elementary::kAbs:
      return a < zero ? zero - a : a;
    case Elementary::kMin:
      return std::min(a, args[1]);
    case Elementary::kMax:
      return std::max(a, args[1]);
    case Elementary::kSin:
    case Elementary::kTan:
    case Elementary::kAsin:
    case Elementary::kAtan:
      return known(zero, zero);
    case Elementary::kCos:
    case Elementary::kExp:
      return known(zero, one);
    case Elementary::kAcos:
    case Elementary::kLog:
      return known(one, zero);
    case Elementary::kAtan2:
      return args[1] > zero ? known(zero, zero) : std::nullopt;
    case Elementary::kPower:
      return ExactPower(a, args[1]);
    case Elementary::kCount_:
      break;
  }
  return std::nullopt;
}

TermId Arena::Apply(Elementary function, std::vector<TermId> args) {
  CHECK(args.size() == Arity(function));
  std::vector<Rational> values;
  for (const TermId a : args) {
    CHECK(sort_of(a) == real_);
    if (IsNumber(a)) values.push_back(number(a));
  }
  const auto payload = static_cast<uint32_t>(function);
  if (values.size() == args.size()) {
    if (const auto value = ExactValue(function, values)) {
      return Fire(Rewrite::kElementaryConstant, Op::kElementary, real_, payload, std::move(args),
                  Number(real_, *value));
    }
  }
  if (function == Elementary::kPower && IsNumber(args[1])) {
    if (const auto n = SmallInteger(number(args[1]), kLargestExponent)) {
      // x^0 is 1 wherever x has a value.
      TermId product = *n == 0 ? Add(Number(real_, Rational(1)), Zero(args[0])) : Number(real_, Rational(1));
      for (int64_t i = 0; i < std::abs(*n); ++i) product = i == 0 ? args[0] : Mul(product, args[0]);
      const TermId result = *n < 0 ? Divide(Number(real_, Rational(1)), product) : product;
      return Fire(Rewrite::kPowerProduct, Op::kElementary, real_, payload, std::move(args), result);
    }
  }
  return Intern(Op::kElementary, real_, payload, args);
}

}  // namespace rondo::expr
