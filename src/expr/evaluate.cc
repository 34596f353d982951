#include "expr/evaluate.h"

#include <unordered_map>

#include "expr/elementary.h"
#include "expr/substitute.h"

namespace rondo::expr {
namespace {

using Maybe = std::optional<Value>;

class Evaluator {
 public:
  Evaluator(const Arena& arena, const Valuation& valuation) : arena_(arena), valuation_(valuation) {}

  Maybe operator()(TermId root) {
    std::unordered_set<TermId> seen;
    VisitPostorder(arena_, root, seen, [&](TermId t) { values_.emplace(t, One(t)); });
    return values_.at(root);
  }

 private:
  const Maybe& Arg(TermId t, size_t i) const { return values_.at(arena_.arg(t, i)); }
  static bool Is(const Maybe& v, bool truth) { return v && v->IsBool() && v->AsBool() == truth; }

  // One operand may decide: `false and ?` is false.
  Maybe Junction(TermId t, bool neutral) const {
    bool open = false;
    for (const TermId arg : arena_.args(t)) {
      const Maybe& v = values_.at(arg);
      if (Is(v, !neutral)) return Value{!neutral};
      open = open || !v;
    }
    return open ? std::nullopt : Maybe(Value{neutral});
  }

  Maybe Number(TermId t) const {
    for (const TermId arg : arena_.args(t)) {
      const Maybe& v = values_.at(arg);
      if (!v || !v->IsNumber()) return std::nullopt;
    }
    const auto n = [&](size_t i) -> const Rational& { return Arg(t, i)->AsNumber(); };
    switch (arena_.op(t)) {
      case Op::kAdd: {
        Rational sum;
        for (size_t i = 0; i < arena_.args(t).size(); ++i) sum = sum + n(i);
        return Value{sum};
      }
      case Op::kMul:
        return Value{n(0) * n(1)};
      case Op::kToReal:
        return Value{n(0)};
      case Op::kLe:
        return Value{n(0) <= n(1)};
      case Op::kLt:
        return Value{n(0) < n(1)};
      default:
        break;  // the divisions
    }
    if (n(1).IsZero()) return std::nullopt;
    if (arena_.op(t) == Op::kDivide) return Value{n(0) / n(1)};
    const Rational quotient = EuclideanQuotient(n(0), n(1));
    return arena_.op(t) == Op::kIntDiv ? Value{quotient} : Value{n(0) - n(1) * quotient};
  }

  Maybe One(TermId t) const {
    const Term& term = arena_.term(t);
    switch (term.op) {
      case Op::kBool:
        return Value{t == arena_.True()};
      case Op::kNumber:
        return Value{arena_.number(t)};
      case Op::kMember:
        return Value{arena_.sort(term.sort).names[term.payload]};
      case Op::kNot:
        return Arg(t, 0) ? Maybe(Value{!Arg(t, 0)->AsBool()}) : std::nullopt;
      case Op::kAnd:
        return Junction(t, true);
      case Op::kOr:
        return Junction(t, false);
      case Op::kEq:
        return Arg(t, 0) && Arg(t, 1) ? Maybe(Value{*Arg(t, 0) == *Arg(t, 1)}) : std::nullopt;
      case Op::kIte:
        return Is(Arg(t, 0), true) ? Arg(t, 1) : Is(Arg(t, 0), false) ? Arg(t, 2) : std::nullopt;
      case Op::kAdd:
      case Op::kMul:
      case Op::kDivide:
      case Op::kIntDiv:
      case Op::kMod:
      case Op::kLe:
      case Op::kLt:
      case Op::kToReal:
        return Number(t);
      case Op::kRecord: {
        Value::Fields fields;
        for (size_t i = 0; i < arena_.args(t).size(); ++i) {
          if (!Arg(t, i)) return std::nullopt;
          fields.push_back(*Arg(t, i));
        }
        return Value{std::move(fields)};
      }
      case Op::kField:
        if (!Arg(t, 0)) return std::nullopt;
        return std::get<Value::Fields>(Arg(t, 0)->data)[term.payload];
      case Op::kElementary: {
        std::vector<Rational> numbers;
        for (size_t i = 0; i < arena_.args(t).size(); ++i) {
          if (!Arg(t, i)) return std::nullopt;
          numbers.push_back(Arg(t, i)->AsNumber());
        }
        const auto value = ExactValue(static_cast<Elementary>(term.payload), numbers);
        return value ? Maybe(Value{*value}) : std::nullopt;
      }
      case Op::kForall:
      case Op::kExists:
      case Op::kStore:
        return std::nullopt;
      case Op::kVariable:
      case Op::kApply:
      case Op::kSelect:
      case Op::kListMake:
      case Op::kListLength:
      case Op::kListAt:
      case Op::kListAppend:
      case Op::kListRemove:
      case Op::kListSet:
      case Op::kListInsert:
      case Op::kListDrop:
      case Op::kListSlice:
        return valuation_(t);
    }
    return std::nullopt;
  }

  const Arena& arena_;
  const Valuation& valuation_;
  std::unordered_map<TermId, Maybe> values_;
};

}  // namespace

std::optional<Value> Evaluate(const Arena& arena, TermId term, const Valuation& valuation) {
  return Evaluator(arena, valuation)(term);
}

}  // namespace rondo::expr
