#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/check.h"
#include "koord/prove/execution/executor.h"

namespace rondo::koord {

using expr::Rational;
using lang::ExprKind;
using lang::TypeKind;

// Arrays are equal where they have items: what a model of theirs says of other indices does not count.
TermId Executor::EqualValues(TermId a, TermId b, TypeId type) {
  const lang::Type& t = model_.types[type];
  if (t.kind == TypeKind::kRecord || t.kind == TypeKind::kTuple) {
    const std::vector<TypeId> parts = t.parts;
    std::vector<TermId> equal;
    for (uint32_t i = 0; i < parts.size(); ++i)
      equal.push_back(EqualValues(arena_.Field(a, i), arena_.Field(b, i), parts[i]));
    return arena_.And(equal);
  }
  if (t.kind != TypeKind::kArray) return arena_.Eq(a, b);
  const TypeId element = t.parts[0];
  const TermId length = ArrayLength(type);
  constexpr int64_t kSpelledOut = 64;
  if (const auto count = ConstantInt(length); count && *count <= kSpelledOut) {
    std::vector<TermId> equal;
    for (int64_t i = 0; i < *count; ++i) {
      const TermId index = arena_.IntNumber(i);
      equal.push_back(EqualValues(arena_.Select(a, index), arena_.Select(b, index), element));
    }
    return arena_.And(equal);
  }
  const TermId k = arena_.FreshBound("k", arena_.Int());
  const TermId same = EqualValues(arena_.Select(a, k), arena_.Select(b, k), element);
  return arena_.Forall({k}, arena_.Implies(InRange(k, length), same));
}

TermId Executor::Unary(const lang::Expr& e) {
  const TermId a = Eval(e.args[0]);
  if (e.text == "not") return arena_.Not(a);
  if (arena_.sort(arena_.sort_of(a)).kind != expr::SortKind::kRecord) return arena_.Neg(a);
  std::vector<TermId> parts;
  for (uint32_t i = 0; i < 3; ++i) parts.push_back(arena_.Neg(arena_.Field(a, i)));
  return arena_.MakeRecord(arena_.sort_of(a), std::move(parts));
}

TermId Executor::Binary(const lang::Expr& e) {
  if (e.text == "in") return Membership(e);
  if (e.text == "not in") return arena_.Not(Membership(e));
  if (e.text == "and" || e.text == "implies") {
    const TermId a = Eval(e.args[0]);
    const TermId b = Under(a, e.args[1]);
    return e.text == "and" ? arena_.And(a, b) : arena_.Implies(a, b);
  }
  if (e.text == "or") {
    const TermId a = Eval(e.args[0]);
    return arena_.Or(a, Under(arena_.Not(a), e.args[1]));
  }
  const bool comparison = e.text == "==" || e.text == "!=" || e.text[0] == '<' || e.text[0] == '>';
  if (!comparison) return Arithmetic(e);
  TermId a = EvalAs(e.args[0], model_.TypeOf(e.args[0]));
  TermId b = EvalAs(e.args[1], model_.TypeOf(e.args[1]));
  a = As(a, arena_.sort_of(b));
  b = As(b, arena_.sort_of(a));
  if (e.text == "==" || e.text == "!=") {
    const TypeId type = model_.TypeOf(e.args[0]);
    const TermId equal = arena_.sort_of(a) == arena_.sort_of(b) && !model_.types.IsNumeric(type)
                             ? EqualValues(a, b, type)
                             : arena_.Eq(a, b);
    return e.text == "==" ? equal : arena_.Not(equal);
  }
  if (e.text == "<") return arena_.Lt(a, b);
  if (e.text == "<=") return arena_.Le(a, b);
  if (e.text == ">") return arena_.Lt(b, a);
  return arena_.Le(b, a);
}

TermId Executor::Arithmetic(const lang::Expr& e) {
  TermId a = Eval(e.args[0]);
  TermId b = Eval(e.args[1]);
  const auto is_record = [&](TermId t) {
    return arena_.sort(arena_.sort_of(t)).kind == expr::SortKind::kRecord;
  };
  if (is_record(a) || is_record(b)) {
    const SortId pos = arena_.sort_of(is_record(a) ? a : b);
    const auto part = [&](TermId t, uint32_t i) {
      return is_record(t) ? arena_.Field(t, i) : As(t, arena_.Real());
    };
    if (e.text == "/") {
      Check(CheckKind::kDivision, exprs_[e.args[1]].span,
            arena_.Not(arena_.Eq(As(b, arena_.Real()), arena_.Number(arena_.Real(), Rational(0)))));
    }
    std::vector<TermId> parts;
    for (uint32_t i = 0; i < 3; ++i) {
      const TermId x = part(a, i);
      const TermId y = part(b, i);
      parts.push_back(e.text == "+"   ? arena_.Add(x, y)
                      : e.text == "-" ? arena_.Sub(x, y)
                      : e.text == "*" ? arena_.Mul(x, y)
                                      : arena_.Divide(x, y));
    }
    return arena_.MakeRecord(pos, std::move(parts));
  }
  if (arena_.sort(arena_.sort_of(a)).kind == expr::SortKind::kOpaque ||
      arena_.sort(arena_.sort_of(b)).kind == expr::SortKind::kOpaque) {
    return Concatenate(a, b);
  }
  a = As(a, arena_.sort_of(b));
  b = As(b, arena_.sort_of(a));
  if (e.text == "+") return arena_.Add(a, b);
  if (e.text == "-") return arena_.Sub(a, b);
  if (e.text == "*") return arena_.Mul(a, b);
  const SortId sort = arena_.sort_of(b);
  Check(CheckKind::kDivision, exprs_[e.args[1]].span,
        arena_.Not(arena_.Eq(b, arena_.Number(sort, Rational(0)))));
  if (e.text == "%") return arena_.Mod(a, b);
  return sort == arena_.Int() ? arena_.IntDiv(a, b) : arena_.Divide(a, b);
}

TermId Executor::Concatenate(TermId a, TermId b) {
  vocabulary_.MarkTexts();
  const SortId left = arena_.sort_of(a);
  const SortId right = arena_.sort_of(b);
  const std::string name = fmt::format("concat {} {}", arena_.sort(left).name, arena_.sort(right).name);
  return arena_.Apply(arena_.Declare(name, {left, right}, vocabulary_.SortOf(model_.types.string())), {a, b});
}

TermId Executor::Membership(const lang::Expr& e) {
  const lang::Expr& set = exprs_[e.args[1]];
  const TermId a = Eval(e.args[0]);
  const Ref ref = model_.RefOf(e.args[1]);
  if (ref.kind == RefKind::kBuiltin && static_cast<Builtin>(ref.index) == Builtin::kRect) {
    const TermId low = Eval(set.args[1]);
    const TermId high = Eval(set.args[2]);
    std::vector<TermId> parts;
    for (uint32_t i = 0; i < 3; ++i) {
      parts.push_back(arena_.Le(arena_.Field(low, i), arena_.Field(a, i)));
      parts.push_back(arena_.Le(arena_.Field(a, i), arena_.Field(high, i)));
    }
    return arena_.And(parts);
  }
  if (set.kind == ExprKind::kName && ref.kind == RefKind::kNone) return vocabulary_.IsRobot(a);  // ID
  const TermId list = Eval(e.args[1]);
  return Contains(list, As(a, arena_.sort(arena_.sort_of(list)).parts[0]));
}

TermId Executor::Contains(TermId list, TermId element) {
  const TermId k = arena_.FreshBound("k", arena_.Int());
  return arena_.Exists({k}, arena_.And({arena_.Le(arena_.IntNumber(0), k), arena_.Lt(k, arena_.Length(list)),
                                        arena_.Eq(arena_.At(list, k), element)}));
}

TermId Executor::Junction(bool conjunction, const std::vector<TermId>& parts) {
  return conjunction ? arena_.And(parts) : arena_.Or(parts);
}

// A constant of its own for each robot, and for each time that control gets here.
TermId Executor::Any(ExprId id, const lang::Expr& e) {
  CHECK(frame_.effect != nullptr) << "a choice outside an event got past the checker";
  const TermId pick = arena_.Apply(arena_.Fresh("choice", {arena_.Int()}, arena_.Int()), {frame_.robot});
  TermId first = arena_.IntNumber(0);
  TermId last;
  TermId list;
  if (e.args.size() > 1) {
    first = Eval(e.args[0]);
    last = Eval(e.args[1]);
  } else {
    list = Eval(e.args[0]);
    last = arena_.Sub(arena_.Length(list), arena_.IntNumber(1));
  }
  const TermId some = arena_.Le(first, last);
  Check(CheckKind::kChoice, exprs_[id].span, some);
  frame_.effect->chosen = arena_.And(
      frame_.effect->chosen,
      arena_.Implies(arena_.And(Reached(), some), arena_.And(arena_.Le(first, pick), arena_.Le(pick, last))));
  return list.valid() ? arena_.At(list, pick) : pick;
}

// Over robots: each of them when N_sys is a small number, else a quantifier with its range.
TermId Executor::Quantifier(ExprId id, const lang::Expr& e) {
  const bool forall = e.text == "forall";
  const Model::Domains& domains = model_.domains.at(id);
  struct Bound {
    uint32_t binding;
    DomainKind kind;
    ExprId list;
  };
  std::vector<Bound> all;
  for (size_t b = 0; b < e.binders.size(); ++b) {
    for (const uint32_t binding : domains.bindings[b])
      all.push_back({binding, domains.kinds[b], e.binders[b].domain});
  }
  const auto guard = [&](TermId range, TermId body) {
    return forall ? arena_.Implies(range, body) : arena_.And(range, body);
  };
  const std::function<TermId(size_t)> build = [&](size_t i) -> TermId {
    if (i == all.size()) return Eval(e.args[0]);
    const auto bound = all[i];
    const TypeId type = model_.bindings[bound.binding].type;
    if (bound.kind == DomainKind::kRobots && options_.expand_robots && vocabulary_.fixed_robots()) {
      std::vector<TermId> parts;
      for (int64_t r = 0; r < *vocabulary_.fixed_robots(); ++r) {
        frame_.bindings[bound.binding] = arena_.IntNumber(r);
        parts.push_back(build(i + 1));
      }
      return Junction(forall, parts);
    }
    const bool over_list = bound.kind == DomainKind::kList;
    const TermId list = over_list ? Eval(bound.list) : TermId{};
    const TermId variable = arena_.FreshBound(model_.bindings[bound.binding].name,
                                              over_list ? arena_.Int() : vocabulary_.SortOf(type));
    TermId range = arena_.True();
    if (bound.kind == DomainKind::kRobots) range = vocabulary_.IsRobot(variable);
    if (over_list)
      range = arena_.And(arena_.Le(arena_.IntNumber(0), variable), arena_.Lt(variable, arena_.Length(list)));
    frame_.bindings[bound.binding] = over_list ? arena_.At(list, variable) : variable;
    quantified_.push_back(variable);
    conditions_.push_back(range);
    const TermId body = build(i + 1);
    conditions_.pop_back();
    quantified_.pop_back();
    const TermId whole = guard(range, body);
    return forall ? arena_.Forall({variable}, whole) : arena_.Exists({variable}, whole);
  };
  return build(0);
}

}  // namespace rondo::koord
