#include "choreo/prove/curve.h"

#include <algorithm>

#include "robot/values/value.h"

namespace rondo::choreo {

using expr::Arena;
using expr::Elementary;
using expr::Op;
using expr::Rational;
using expr::TermId;

namespace {

enum class Bend : uint8_t { kConstant, kAffine, kConvex, kConcave, kUnknown };

Bend Mirrored(Bend b) {
  return b == Bend::kConvex ? Bend::kConcave : b == Bend::kConcave ? Bend::kConvex : b;
}

Bend Sum(Bend a, Bend b) {
  if (a == Bend::kUnknown || b == Bend::kUnknown) return Bend::kUnknown;
  if (a <= Bend::kAffine) return std::max(a, b);
  if (b <= Bend::kAffine || a == b) return a;
  return Bend::kUnknown;
}

// Of the term as a function of the clock alone.
Bend BendOf(Arena& arena, TermId term, TermId clock) {
  if (term == clock) return Bend::kAffine;
  if (!robot::VariablesOf(arena, {term}).contains(clock)) return Bend::kConstant;
  const std::vector<TermId> args(arena.args(term).begin(), arena.args(term).end());
  if (arena.op(term) == Op::kAdd) {
    Bend sum = Bend::kConstant;
    for (const TermId a : args) sum = Sum(sum, BendOf(arena, a, clock));
    return sum;
  }
  if (arena.op(term) == Op::kMul) {
    const Bend a = BendOf(arena, args[0], clock);
    const Bend b = BendOf(arena, args[1], clock);
    if (args[0] == args[1] && a == Bend::kAffine) return Bend::kConvex;
    if (a != Bend::kConstant && b != Bend::kConstant) return Bend::kUnknown;
    const TermId factor = a == Bend::kConstant ? args[0] : args[1];
    const Bend other = a == Bend::kConstant ? b : a;
    if (other == Bend::kAffine) return Bend::kAffine;
    const TermId zero = arena.Number(arena.Real(), Rational(0));
    if (robot::IsBelow(arena, zero, factor)) return other;
    return robot::IsBelow(arena, factor, zero) ? Mirrored(other) : Bend::kUnknown;
  }
  if (arena.op(term) != Op::kElementary) return Bend::kUnknown;
  const Bend a = BendOf(arena, args[0], clock);
  if (arena.elementary_of(term) == Elementary::kAbs && a == Bend::kAffine) return Bend::kConvex;
  const bool max = arena.elementary_of(term) == Elementary::kMax;
  if (!max && arena.elementary_of(term) != Elementary::kMin) return Bend::kUnknown;
  const Bend b = BendOf(arena, args[1], clock);
  const Bend wanted = max ? Bend::kConvex : Bend::kConcave;
  const auto fits = [&](Bend x) { return x <= Bend::kAffine || x == wanted; };
  return fits(a) && fits(b) ? wanted : Bend::kUnknown;
}

}  // namespace

bool HoldsBetween(Arena& arena, TermId formula, TermId clock) {
  const std::vector<TermId> args(arena.args(formula).begin(), arena.args(formula).end());
  switch (arena.op(formula)) {
    case Op::kAnd:
      return std::ranges::all_of(args, [&](TermId a) { return HoldsBetween(arena, a, clock); });
    case Op::kLe:
    case Op::kLt:
      return Sum(BendOf(arena, args[0], clock), Mirrored(BendOf(arena, args[1], clock))) <= Bend::kConvex;
    case Op::kEq:
      return arena.sort_of(args[0]) == arena.Real() && BendOf(arena, args[0], clock) <= Bend::kAffine &&
             BendOf(arena, args[1], clock) <= Bend::kAffine;
    default:
      return false;
  }
}

bool IsContinuous(const Arena& arena, TermId term, const std::vector<TermId>& changing) {
  const auto variables = robot::VariablesOf(arena, {term});
  if (std::ranges::none_of(changing, [&](TermId v) { return variables.contains(v); })) return true;
  const auto args = arena.args(term);
  const auto all = [&] {
    return std::ranges::all_of(args, [&](TermId a) { return IsContinuous(arena, a, changing); });
  };
  switch (arena.op(term)) {
    case Op::kVariable:
      return true;
    case Op::kAdd:
    case Op::kMul:
      return all();
    case Op::kDivide: {
      const auto below = robot::VariablesOf(arena, {args[1]});
      return std::ranges::none_of(changing, [&](TermId v) { return below.contains(v); }) && all();
    }
    case Op::kElementary:
      switch (arena.elementary_of(term)) {
        case Elementary::kSqrt:
        case Elementary::kAbs:
        case Elementary::kMin:
        case Elementary::kMax:
        case Elementary::kSin:
        case Elementary::kCos:
        case Elementary::kAsin:
        case Elementary::kAcos:
        case Elementary::kAtan:
        case Elementary::kExp:
        case Elementary::kLog:
          return all();
        case Elementary::kTan:
        case Elementary::kAtan2:
        case Elementary::kPower:
        case Elementary::kCount_:
          return false;
      }
      return false;
    default:
      return false;
  }
}

TermId Tightened(Arena& arena, TermId formula, const Rational& spare) {
  const std::vector<TermId> args(arena.args(formula).begin(), arena.args(formula).end());
  const auto slack = arena.Number(arena.Real(), spare);
  std::vector<TermId> parts;
  switch (arena.op(formula)) {
    case Op::kAnd:
    case Op::kOr:
      for (const TermId a : args) parts.push_back(Tightened(arena, a, spare));
      return arena.op(formula) == Op::kAnd ? arena.And(parts) : arena.Or(parts);
    case Op::kLe:
    case Op::kLt:
      return arena.Le(arena.Add(args[0], slack), args[1]);
    default:
      return formula;
  }
}

}  // namespace rondo::choreo
