#include "reach/invariants/terms.h"

#include <algorithm>

#include "expr/substitute.h"

namespace rondo::reach::invariants {

using expr::Elementary;
using expr::Op;

namespace {

// if a <= b then b else a, and the like: the larger or the smaller of two, which does not jump.
bool IsExtreme(const expr::Arena& arena, TermId choice) {
  const TermId condition = arena.arg(choice, 0);
  if (arena.op(condition) != Op::kLe && arena.op(condition) != Op::kLt) return false;
  const TermId a = arena.arg(condition, 0);
  const TermId b = arena.arg(condition, 1);
  const TermId then = arena.arg(choice, 1);
  const TermId otherwise = arena.arg(choice, 2);
  return (then == a && otherwise == b) || (then == b && otherwise == a);
}

bool IsContinuousHere(const expr::Arena& arena, TermId t) {
  switch (arena.op(t)) {
    case Op::kBool:
    case Op::kNumber:
    case Op::kVariable:
    case Op::kNot:
    case Op::kAnd:
    case Op::kOr:
    case Op::kAdd:
    case Op::kMul:
    case Op::kLe:
    case Op::kLt:
      return true;
    case Op::kEq:
      return arena.sort_of(arena.arg(t, 0)) == arena.Real();
    case Op::kDivide:
      return arena.IsNumber(arena.arg(t, 1)) && !arena.number(arena.arg(t, 1)).IsZero();
    case Op::kIte:
      return IsExtreme(arena, t);
    case Op::kElementary:
      switch (arena.elementary_of(t)) {
        case Elementary::kAbs:
        case Elementary::kMin:
        case Elementary::kMax:
        case Elementary::kSin:
        case Elementary::kCos:
        case Elementary::kExp:
        case Elementary::kAtan:
          return true;
        default:
          return false;
      }
    default:
      return false;
  }
}

class Differentiation {
 public:
  Differentiation(expr::Arena& arena, const std::vector<TermId>& states, const std::vector<TermId>& rates)
      : arena_(arena), states_(states), rates_(rates) {}

  std::optional<TermId> Of(TermId t) {
    const std::vector<TermId> args(arena_.args(t).begin(), arena_.args(t).end());
    switch (arena_.op(t)) {
      case Op::kNumber:
        return Number(0);
      case Op::kVariable: {
        const auto it = std::ranges::find(states_, t);
        if (it == states_.end()) return std::nullopt;
        return rates_[static_cast<size_t>(it - states_.begin())];
      }
      case Op::kAdd: {
        std::vector<TermId> sum;
        for (const TermId a : args) {
          const auto rate = Of(a);
          if (!rate) return std::nullopt;
          sum.push_back(*rate);
        }
        return arena_.Add(std::move(sum));
      }
      case Op::kMul: {
        std::vector<TermId> sum;
        for (size_t i = 0; i < args.size(); ++i) {
          auto product = Of(args[i]);
          if (!product) return std::nullopt;
          for (size_t k = 0; k < args.size(); ++k) {
            if (k != i) product = arena_.Mul(*product, args[k]);
          }
          sum.push_back(*product);
        }
        return arena_.Add(std::move(sum));
      }
      case Op::kElementary:
        return OfElementary(t, args[0]);
      default:
        return std::nullopt;
    }
  }

 private:
  TermId Number(int64_t value) { return arena_.Number(arena_.Real(), Rational(value)); }

  std::optional<TermId> OfElementary(TermId t, TermId argument) {
    TermId outer;
    switch (arena_.elementary_of(t)) {
      case Elementary::kSin:
        outer = arena_.Apply(Elementary::kCos, {argument});
        break;
      case Elementary::kCos:
        outer = arena_.Neg(arena_.Apply(Elementary::kSin, {argument}));
        break;
      case Elementary::kExp:
        outer = t;
        break;
      default:
        return std::nullopt;
    }
    const auto inner = Of(argument);
    if (!inner) return std::nullopt;
    return arena_.Mul(outer, *inner);
  }

  expr::Arena& arena_;
  const std::vector<TermId>& states_;
  const std::vector<TermId>& rates_;
};

}  // namespace

bool IsContinuous(const expr::Arena& arena, TermId term) {
  bool continuous = true;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, term, seen,
                       [&](TermId t) { continuous = continuous && IsContinuousHere(arena, t); });
  return continuous;
}

std::optional<TermId> RateOf(expr::Arena& arena, TermId term, const std::vector<TermId>& states,
                             const std::vector<TermId>& rates) {
  return Differentiation(arena, states, rates).Of(term);
}

}  // namespace rondo::reach::invariants
