#include "solve/icp/prepare/lower.h"

#include <fmt/format.h>

#include "base/check.h"

namespace rondo::solve::icp {
namespace {

using expr::Op;
using expr::SortKind;

struct Unsupported {
  std::string what;
};

class Lowering {
 public:
  Lowering(const expr::Arena& from, Lowered& to) : from_(from), to_(to), arena_(to.arena) {}

  TermId Formula(TermId t, bool positive) {
    auto& memo = positive ? positive_ : negative_;
    if (const auto it = memo.find(t); it != memo.end()) return it->second;
    const TermId result = NewFormula(t, positive);
    memo.emplace(t, result);
    return result;
  }

 private:
  bool IsBool(TermId t) const { return from_.sort_of(t) == from_.Bool(); }

  TermId NewFormula(TermId t, bool positive) {
    const auto args = from_.args(t);
    const Op op = from_.op(t);
    switch (op) {
      case Op::kBool:
        return arena_.Constant((t == from_.True()) == positive);
      case Op::kNot:
        return Formula(args[0], !positive);
      case Op::kAnd:
      case Op::kOr: {
        std::vector<TermId> parts;
        for (const TermId a : args) parts.push_back(Formula(a, positive));
        return (op == Op::kAnd) == positive ? arena_.And(parts) : arena_.Or(parts);
      }
      case Op::kEq:
        if (IsBool(args[0])) {
          return arena_.Or(arena_.And(Formula(args[0], true), Formula(args[1], positive)),
                           arena_.And(Formula(args[0], false), Formula(args[1], !positive)));
        }
        return Literal(arena_.Eq(Number(args[0]), Number(args[1])), positive);
      case Op::kIte:
        return arena_.Or(arena_.And(Formula(args[0], true), Formula(args[1], positive)),
                         arena_.And(Formula(args[0], false), Formula(args[2], positive)));
      case Op::kLe:
        return Literal(arena_.Le(Number(args[0]), Number(args[1])), positive);
      case Op::kLt:
        return Literal(arena_.Lt(Number(args[0]), Number(args[1])), positive);
      case Op::kVariable:
        return Literal(arena_.Le(Constant(1), Declared(t, Variable::Kind::kBool)), positive);
      default:
        throw Unsupported{fmt::format("formulas made with `{}`", Name(op))};
    }
  }

  TermId Literal(TermId atom, bool positive) { return positive ? atom : arena_.Not(atom); }
  TermId Constant(const Rational& value) { return arena_.Number(arena_.Real(), value); }

  TermId Declared(TermId t, Variable::Kind kind) {
    const TermId v =
        arena_.Variable(arena_.Declare(from_.symbol(from_.symbol_of(t)).name, {}, arena_.Real()));
    to_.variables.emplace(v, Variable{t, kind});
    return v;
  }

  TermId Number(TermId t) {
    if (const auto it = numbers_.find(t); it != numbers_.end()) return it->second;
    const TermId result = NewNumber(t);
    numbers_.emplace(t, result);
    return result;
  }

  TermId NewNumber(TermId t) {
    const SortKind sort = from_.sort(from_.sort_of(t)).kind;
    if (sort != SortKind::kReal && sort != SortKind::kInt && sort != SortKind::kEnum)
      throw Unsupported{fmt::format("values of sort `{}`", from_.sort(from_.sort_of(t)).name)};
    const auto args = from_.args(t);
    const auto arg = [&](size_t i) { return Number(args[i]); };
    switch (from_.op(t)) {
      case Op::kNumber:
        return Constant(from_.number(t));
      case Op::kMember:
        return Constant(from_.term(t).payload);
      case Op::kVariable:
        return Declared(t, sort == SortKind::kReal  ? Variable::Kind::kReal
                           : sort == SortKind::kInt ? Variable::Kind::kInt
                                                    : Variable::Kind::kEnum);
      case Op::kIte: {
        const TermId then = arg(1);
        return arena_.Ite(Formula(args[0], true), then, arg(2));
      }
      case Op::kAdd: {
        std::vector<TermId> parts;
        for (size_t i = 0; i < args.size(); ++i) parts.push_back(arg(i));
        return arena_.Add(std::move(parts));
      }
      case Op::kMul: {
        const TermId left = arg(0);
        return arena_.Mul(left, arg(1));
      }
      case Op::kDivide: {
        const TermId left = arg(0);
        return arena_.Divide(left, arg(1));
      }
      case Op::kToReal:
        return arg(0);
      case Op::kElementary: {
        std::vector<TermId> parts;
        for (size_t i = 0; i < args.size(); ++i) parts.push_back(arg(i));
        return arena_.Apply(from_.elementary_of(t), std::move(parts));
      }
      default:
        throw Unsupported{fmt::format("terms made with `{}`", Name(from_.op(t)))};
    }
  }

  const expr::Arena& from_;
  Lowered& to_;
  expr::Arena& arena_;
  std::unordered_map<TermId, TermId> positive_, negative_, numbers_;
};

}  // namespace

void Lower(const Query& query, Lowered& lowered) {
  Lowering lowering(*query.arena, lowered);
  try {
    for (const Assertion& a : query.assertions)
      lowered.conjuncts.push_back(lowering.Formula(a.formula, true));
  } catch (const Unsupported& reason) {
    lowered.unsupported = reason.what;
    return;
  }
  expr::Arena& arena = lowered.arena;
  const auto number = [&](int64_t n) { return arena.Number(arena.Real(), Rational(n)); };
  for (const auto& [term, variable] : lowered.variables) {
    if (variable.kind != Variable::Kind::kBool && variable.kind != Variable::Kind::kEnum) continue;
    const expr::Sort& sort = query.arena->sort(query.arena->sort_of(variable.source));
    const int64_t last =
        variable.kind == Variable::Kind::kBool ? 1 : static_cast<int64_t>(sort.names.size()) - 1;
    lowered.conjuncts.push_back(arena.And(arena.Le(number(0), term), arena.Le(term, number(last))));
  }
}

TermId Negate(expr::Arena& arena, TermId formula) {
  const Op op = arena.op(formula);
  if (op != Op::kAnd && op != Op::kOr) return arena.Not(formula);
  std::vector<TermId> parts;
  for (const TermId a : arena.args(formula)) parts.push_back(a);
  for (TermId& part : parts) part = Negate(arena, part);
  return op == Op::kAnd ? arena.Or(parts) : arena.And(parts);
}

}  // namespace rondo::solve::icp
