#include "solve/icp/point.h"

#include <algorithm>
#include <cmath>

#include "expr/elementary.h"
#include "expr/substitute.h"
#include "solve/icp/tape/tape.h"
#include "verdict/truth.h"

namespace rondo::solve::icp {

using expr::Elementary;
using expr::Op;
using expr::Rational;
using expr::TermId;
using interval::Interval;

namespace {

verdict::Truth Not(verdict::Truth t) {
  return t == verdict::Truth::kTrue    ? verdict::Truth::kFalse
         : t == verdict::Truth::kFalse ? verdict::Truth::kTrue
                                       : verdict::Truth::kOpen;
}

// Angles beyond what interval arithmetic tells apart are brought near zero exactly: by whole turns, pi
// between two rationals.
Interval WithoutTurns(Interval a) {
  constexpr double kLarge = 0x1p15;
  constexpr double kLargest = 0x1p100;
  const double size = std::max(std::fabs(a.lo), std::fabs(a.hi));
  if (size <= kLarge || !(size < kLargest) || a.hi - a.lo > 8) return a;
  static const Rational kLow =
      *Rational::Parse("6.28318530717958647692528676655900576839433879875021164194988918461563281257");
  static const Rational kHigh =
      *Rational::Parse("6.28318530717958647692528676655900576839433879875021164194988918461563281258");
  const Rational lo = Rational::FromDouble(a.lo);
  const Rational hi = Rational::FromDouble(a.hi);
  const Rational turns = (lo / kLow).Floor();
  const bool positive = turns > Rational(0);
  const Rational most = turns * (positive ? kHigh : kLow);
  const Rational least = turns * (positive ? kLow : kHigh);
  return {Enclose(lo - most).lo, Enclose(hi - least).hi};
}

Interval Apply(Elementary f, Interval a, Interval b) {
  switch (f) {
    case Elementary::kSqrt:
      return Sqrt(a);
    case Elementary::kAbs:
      return Abs(a);
    case Elementary::kMin:
      return Min(a, b);
    case Elementary::kMax:
      return Max(a, b);
    case Elementary::kSin:
      return Sin(WithoutTurns(a));
    case Elementary::kCos:
      return Cos(WithoutTurns(a));
    case Elementary::kTan:
      return Tan(a);
    case Elementary::kAsin:
      return Asin(a);
    case Elementary::kAcos:
      return Acos(a);
    case Elementary::kAtan:
      return Atan(a);
    case Elementary::kAtan2:
      return Atan2(a, b);
    case Elementary::kExp:
      return Exp(a);
    case Elementary::kLog:
      return Log(a);
    case Elementary::kPower:
      return Exp(b * Log(a));
    case Elementary::kCount_:
      break;
  }
  return {};
}

bool InDomain(Elementary f, Interval a, Interval b) {
  switch (f) {
    case Elementary::kSqrt:
      return a.lo >= 0;
    case Elementary::kLog:
    case Elementary::kPower:  // other values are exact, or some number
      return a.lo > 0;
    case Elementary::kAsin:
    case Elementary::kAcos:
      return a.lo >= -1 && a.hi <= 1;
    case Elementary::kTan:
      return !(Cos(a).Contains(0));
    case Elementary::kAtan2:
      return !(a.Contains(0) && b.Contains(0));
    default:
      return true;
  }
}

}  // namespace

const PointChecker::Value& PointChecker::Number(TermId t) {
  std::unordered_set<TermId> seen;
  if (!values_.contains(t)) {
    expr::VisitPostorder(arena_, t, seen, [this](TermId part) {
      if (arena_.sort_of(part) != arena_.Bool() && !values_.contains(part))
        values_.emplace(part, NewNumber(part));
    });
  }
  return values_.at(t);
}

std::optional<Rational> PointChecker::Exact(TermId term) {
  const Value& v = Number(term);
  return v.defined ? v.exact : std::nullopt;
}

Interval PointChecker::Enclosure(TermId term) {
  const Value& v = Number(term);
  return v.defined ? v.range : Interval::Empty();
}

PointChecker::Value PointChecker::NewNumber(TermId t) {
  const auto args = arena_.args(t);
  const auto value = [&](size_t i) -> const Value& { return values_.at(args[i]); };
  const auto exactly = [](const Rational& r) { return Value{r, Enclose(r), true}; };
  bool all_exact = true;
  bool all_defined = true;
  for (const TermId a : args) {
    const auto it = values_.find(a);
    if (it == values_.end()) continue;
    all_exact = all_exact && it->second.exact.has_value();
    all_defined = all_defined && it->second.defined;
  }
  Value result;
  result.defined = all_defined;
  switch (arena_.op(t)) {
    case Op::kNumber:
      return exactly(arena_.number(t));
    case Op::kVariable: {
      if (const auto it = widened_.find(t); it != widened_.end()) return {std::nullopt, it->second, true};
      const auto it = point_.find(t);
      if (it == point_.end()) return {std::nullopt, {}, false};
      return exactly(it->second);
    }
    case Op::kAdd: {
      Rational sum;
      Interval range{0, 0};
      for (size_t i = 0; i < args.size(); ++i) {
        if (all_exact) sum = sum + *value(i).exact;
        range = range + value(i).range;
      }
      if (all_exact && all_defined) return exactly(sum);
      result.range = range;
      return result;
    }
    case Op::kMul:
      if (all_exact && all_defined) return exactly(*value(0).exact * *value(1).exact);
      result.range = args[0] == args[1] ? Sqr(value(0).range) : value(0).range * value(1).range;
      return result;
    case Op::kDivide:
      result.defined = result.defined && !value(1).range.Contains(0);
      if (result.defined && all_exact) return exactly(*value(0).exact / *value(1).exact);
      if (result.defined) result.range = value(0).range / value(1).range;
      return result;
    case Op::kIte: {
      const verdict::Truth condition = Check(args[0]);
      if (condition == verdict::Truth::kOpen) return {std::nullopt, {}, false};
      return values_.at(args[condition == verdict::Truth::kTrue ? 1 : 2]);
    }
    case Op::kElementary: {
      const Elementary f = arena_.elementary_of(t);
      std::vector<Rational> numbers;
      if (all_exact) {
        for (size_t i = 0; i < args.size(); ++i) numbers.push_back(*value(i).exact);
        if (const auto exact = expr::ExactValue(f, numbers); exact && all_defined) return exactly(*exact);
      }
      const Interval a = value(0).range;
      const Interval b = args.size() > 1 ? value(1).range : Interval{};
      result.defined = result.defined && InDomain(f, a, b);
      if (result.defined) result.range = Apply(f, a, b);
      return result;
    }
    default:
      return {std::nullopt, {}, false};
  }
}

verdict::Truth PointChecker::Compare(TermId atom, bool positive) {
  const Value a = Number(arena_.arg(atom, 0));
  const Value b = Number(arena_.arg(atom, 1));
  if (!a.defined || !b.defined) return verdict::Truth::kOpen;
  verdict::Truth truth = verdict::Truth::kOpen;
  const Op op = arena_.op(atom);
  if (a.exact && b.exact) {
    const bool holds = op == Op::kEq   ? *a.exact == *b.exact
                       : op == Op::kLe ? *a.exact <= *b.exact
                                       : *a.exact < *b.exact;
    truth = holds ? verdict::Truth::kTrue : verdict::Truth::kFalse;
  } else if (op == Op::kEq) {
    if (Meet(a.range, b.range).IsEmpty()) truth = verdict::Truth::kFalse;
  } else if (a.range.hi < b.range.lo || (op == Op::kLe && a.range.hi == b.range.lo)) {
    truth = verdict::Truth::kTrue;
  } else if (a.range.lo > b.range.hi || (op == Op::kLt && a.range.lo == b.range.hi)) {
    truth = verdict::Truth::kFalse;
  }
  return positive ? truth : Not(truth);
}

verdict::Truth PointChecker::Check(TermId formula) {
  switch (arena_.op(formula)) {
    case Op::kBool:
      return formula == arena_.True() ? verdict::Truth::kTrue : verdict::Truth::kFalse;
    case Op::kAnd:
    case Op::kOr: {
      const verdict::Truth decides =
          arena_.op(formula) == Op::kAnd ? verdict::Truth::kFalse : verdict::Truth::kTrue;
      verdict::Truth result = Not(decides);
      for (const TermId part : arena_.args(formula)) {
        const verdict::Truth t = Check(part);
        if (t == decides) return t;
        if (t == verdict::Truth::kOpen) result = t;
      }
      return result;
    }
    case Op::kNot:
      return Compare(arena_.arg(formula, 0), false);
    default:
      return Compare(formula, true);
  }
}

}  // namespace rondo::solve::icp
