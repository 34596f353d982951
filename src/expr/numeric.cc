#include "expr/numeric.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "expr/substitute.h"

namespace rondo::expr {

double Numeric::operator()(TermId term) {
  if (const auto it = known_.find(term); it != known_.end()) return it->second;
  std::unordered_set<TermId> seen;
  VisitPostorder(arena_, term, seen, [&](TermId t) {
    if (arena_.sort_of(t) != arena_.Bool() && !known_.contains(t)) known_.emplace(t, One(t));
  });
  return known_.at(term);
}

double Numeric::One(TermId term) {
  const auto arg = [&](size_t i) { return known_.at(arena_.arg(term, i)); };
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  switch (arena_.op(term)) {
    case Op::kNumber:
      return arena_.number(term).ToDouble();
    case Op::kVariable:
      return 0;
    case Op::kIte:
      return Violation(arena_.arg(term, 0)) == 0 ? arg(1) : arg(2);
    case Op::kAdd: {
      double sum = 0;
      for (const TermId a : arena_.args(term)) sum += known_.at(a);
      return sum;
    }
    case Op::kMul:
      return arg(0) * arg(1);
    case Op::kDivide:
      return arg(0) / arg(1);
    case Op::kToReal:
      return arg(0);
    case Op::kElementary:
      break;
    default:
      return kNone;
  }
  switch (arena_.elementary_of(term)) {
    case Elementary::kSqrt:
      return std::sqrt(arg(0));
    case Elementary::kAbs:
      return std::abs(arg(0));
    case Elementary::kMin:
      return std::min(arg(0), arg(1));
    case Elementary::kMax:
      return std::max(arg(0), arg(1));
    case Elementary::kSin:
      return std::sin(arg(0));
    case Elementary::kCos:
      return std::cos(arg(0));
    case Elementary::kTan:
      return std::tan(arg(0));
    case Elementary::kAsin:
      return std::asin(arg(0));
    case Elementary::kAcos:
      return std::acos(arg(0));
    case Elementary::kAtan:
      return std::atan(arg(0));
    case Elementary::kAtan2:
      return std::atan2(arg(0), arg(1));
    case Elementary::kExp:
      return std::exp(arg(0));
    case Elementary::kLog:
      return arg(0) > 0 ? std::log(arg(0)) : kNone;
    case Elementary::kPower:
      return arg(0) == 0 && arg(1) < 0 ? kNone : std::pow(arg(0), arg(1));
    case Elementary::kCount_:
      break;
  }
  return kNone;
}

double Numeric::Miss(TermId formula, bool positive) {
  constexpr double kFalse = std::numeric_limits<double>::infinity();
  const auto difference = [&] { return (*this)(arena_.arg(formula, 0)) - (*this)(arena_.arg(formula, 1)); };
  const auto above = [](double d) { return d > 0 ? d : d <= 0 ? 0 : kFalse; };
  // Of what is strict: equal is not enough, by next to nothing.
  const auto beyond = [&](double d) { return d == 0 ? std::numeric_limits<double>::denorm_min() : above(d); };
  const Op op = arena_.op(formula);
  switch (op) {
    case Op::kBool:
      return (formula == arena_.True()) == positive ? 0 : kFalse;
    case Op::kNot:
      return Miss(arena_.arg(formula, 0), !positive);
    case Op::kAnd:
    case Op::kOr: {
      const bool all = (op == Op::kAnd) == positive;
      double miss = all ? 0 : kFalse;
      for (const TermId a : arena_.args(formula)) {
        const double m = Miss(a, positive);
        miss = all ? std::max(miss, m) : std::min(miss, m);
      }
      return miss;
    }
    case Op::kIte: {
      const bool then = Violation(arena_.arg(formula, 0)) == 0;
      return Miss(arena_.arg(formula, then ? 1 : 2), positive);
    }
    case Op::kEq: {
      if (arena_.sort_of(arena_.arg(formula, 0)) == arena_.Bool()) {
        const bool a = Violation(arena_.arg(formula, 0)) == 0, b = Violation(arena_.arg(formula, 1)) == 0;
        return (a == b) == positive ? 0 : kFalse;
      }
      const double d = std::abs(difference());
      if (positive) return above(d);
      return d > 0 ? 0 : kFalse;
    }
    case Op::kLe:
      return positive ? above(difference()) : beyond(-difference());
    case Op::kLt:
      return positive ? beyond(difference()) : above(-difference());
    default:
      break;
  }
  return kFalse;
}

}  // namespace rondo::expr
