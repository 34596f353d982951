#include "expr/elementary.h"

#include "base/check.h"
#include "expr/arena.h"

namespace rondo::expr {

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
  return Intern(Op::kElementary, real_, payload, args);
}

}  // namespace rondo::expr
