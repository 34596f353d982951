#include <fmt/format.h>

#include <utility>

#include "base/check.h"
#include "koord/prove/execution/executor.h"

namespace rondo::koord {

using expr::Rational;

TermId Executor::Call(ExprId id, const lang::Expr& e) {
  const Ref ref = model_.RefOf(id);
  if (ref.kind == RefKind::kFunction) return CallFunction(e, ref.index);
  CHECK(ref.kind == RefKind::kBuiltin);
  return CallBuiltin(e, static_cast<Builtin>(ref.index), model_.TypeOf(id));
}

TermId Executor::CallFunction(const lang::Expr& e, size_t index) {
  const Function& f = model_.functions[index];
  if (!f.external()) return Inline(e, f);
  std::vector<TermId> args;
  if (f.port >= 0) args.push_back(Robot());
  for (size_t i = 0; i < f.parameters.size(); ++i) args.push_back(EvalAs(e.args[i + 1], f.parameters[i]));
  return arena_.Apply(vocabulary_.Function(index, frame_.view->planner_suffix), std::move(args));
}

// The body is executed in place, on a state that has nothing but the parameters.
TermId Executor::Inline(const lang::Expr& e, const Function& f) {
  std::map<uint32_t, TermId> bindings;
  const std::vector<uint32_t>& parameters = model_.bound_by.at(f.def);
  for (size_t i = 0; i < parameters.size(); ++i)
    bindings[parameters[i]] = EvalAs(e.args[i + 1], f.parameters[i]);
  const SortId sort = vocabulary_.SortOf(f.result);
  // A function that ends without `return` returns some value of its type: a different one at each call.
  std::vector<TermId> key;
  std::vector<SortId> key_sorts;
  if (frame_.robot.valid()) {
    key.push_back(frame_.robot);
    key_sorts.push_back(arena_.Int());
  }
  const TermId missing = arena_.Apply(arena_.Fresh("no return " + f.name, key_sorts, sort), key);
  State inner;
  if (frame_.state != nullptr) {
    inner = *frame_.state;
    inner.path = Reached();
  } else {
    inner.value = frame_.view->value;
    inner.path = arena_.True();
    inner.locked = arena_.False();
    inner.stopped = arena_.False();
  }
  inner.broke = inner.continued = inner.ended = arena_.False();
  inner.result = missing;
  Effect ignored;  // what a specification computes is nobody's effect
  Frame saved = frame_;
  // In a program the path has them; values of specifications do not depend on them.
  std::vector<TermId> conditions = conditions_;
  if (InProgram()) conditions_.clear();
  frame_.bindings = std::move(bindings);
  frame_.bindings.insert(saved.bindings.begin(), saved.bindings.end());
  frame_.in_specification = frame_.in_specification || frame_.state == nullptr;
  frame_.state = &inner;
  if (frame_.effect == nullptr) frame_.effect = &ignored;
  Body(f.def->body);
  Check(CheckKind::kReturn, f.span, inner.ended);
  frame_ = std::move(saved);
  conditions_ = std::move(conditions);
  return inner.result;
}

// As an integer, in terms of `floor`.
TermId Executor::Rounded(TermId x, Builtin builtin) {
  const bool whole = arena_.sort_of(x) == arena_.Int();
  const TermId zero = arena_.Number(arena_.sort_of(x), Rational(0));
  if (builtin == Builtin::kSign) {
    return arena_.Ite(arena_.Lt(zero, x), arena_.IntNumber(1),
                      arena_.Ite(arena_.Lt(x, zero), arena_.IntNumber(-1), arena_.IntNumber(0)));
  }
  if (whole) return x;
  const auto floor = [&](TermId t) { return arena_.Apply(vocabulary_.Floor(), {t}); };
  const auto ceil = [&](TermId t) { return arena_.Neg(floor(arena_.Neg(t))); };
  if (builtin == Builtin::kFloor) return floor(x);
  if (builtin == Builtin::kCeil) return ceil(x);
  const TermId half = arena_.Number(arena_.Real(), Rational(1) / Rational(2));
  return arena_.Ite(arena_.Le(zero, x), floor(arena_.Add(x, half)), ceil(arena_.Sub(x, half)));
}

TermId Executor::CallBuiltin(const lang::Expr& e, Builtin builtin, TypeId type) {
  switch (builtin) {
    case Builtin::kPos: {
      std::vector<TermId> parts;
      for (size_t i = 1; i < e.args.size(); ++i) parts.push_back(As(Eval(e.args[i]), arena_.Real()));
      while (parts.size() < 3) parts.push_back(arena_.Number(arena_.Real(), Rational(0)));
      return arena_.MakeRecord(vocabulary_.SortOf(model_.types.pos()), std::move(parts));
    }
    case Builtin::kMid:
    case Builtin::kDist: {
      std::vector<ExprId> points(e.args.begin() + 1, e.args.end());
      if (points.size() == 1) points = exprs_[points[0]].args;
      const TermId a = Eval(points[0]);
      const TermId b = Eval(points[1]);
      const bool numbers = arena_.sort(arena_.sort_of(a)).kind != expr::SortKind::kRecord;
      const auto half = [&](TermId x, TermId y) {
        return arena_.Divide(arena_.Add(x, y), arena_.Number(arena_.Real(), Rational(2)));
      };
      if (numbers) {
        const TermId x = As(a, arena_.Real());
        const TermId y = As(b, arena_.Real());
        if (builtin == Builtin::kMid) return half(x, y);
        return arena_.Ite(arena_.Le(x, y), arena_.Sub(y, x), arena_.Sub(x, y));
      }
      if (builtin == Builtin::kDist) return arena_.Apply(vocabulary_.Dist(), {a, b});
      std::vector<TermId> parts;
      for (uint32_t i = 0; i < 3; ++i) parts.push_back(half(arena_.Field(a, i), arena_.Field(b, i)));
      return arena_.MakeRecord(arena_.sort_of(a), std::move(parts));
    }
    case Builtin::kLen:
      return arena_.Length(Eval(e.args[1]));
    case Builtin::kAbs: {
      const TermId a = Eval(e.args[1]);
      return arena_.Ite(arena_.Le(arena_.Number(arena_.sort_of(a), Rational(0)), a), a, arena_.Neg(a));
    }
    case Builtin::kMin:
    case Builtin::kMax: {
      const SortId sort = vocabulary_.SortOf(type);
      TermId result = As(Eval(e.args[1]), sort);
      for (size_t i = 2; i < e.args.size(); ++i) {
        const TermId next = As(Eval(e.args[i]), sort);
        result = builtin == Builtin::kMin ? arena_.Ite(arena_.Le(result, next), result, next)
                                          : arena_.Ite(arena_.Le(next, result), result, next);
      }
      return result;
    }
    case Builtin::kRecord: {
      const std::vector<TypeId> parts = model_.types[type].parts;
      std::vector<TermId> fields;
      for (size_t i = 0; i < parts.size(); ++i) fields.push_back(EvalAs(e.args[i + 1], parts[i]));
      return arena_.MakeRecord(vocabulary_.SortOf(type), std::move(fields));
    }
    case Builtin::kSqrt: {
      const TermId x = As(Eval(e.args[1]), arena_.Real());
      Check(CheckKind::kRoot, e.span, arena_.Le(arena_.Number(arena_.Real(), Rational(0)), x));
      return arena_.Apply(vocabulary_.Sqrt(), {x});
    }
    case Builtin::kHypot: {
      const TermId x = As(Eval(e.args[1]), arena_.Real());
      const TermId y = As(Eval(e.args[2]), arena_.Real());
      return arena_.Apply(vocabulary_.Sqrt(), {arena_.Add(arena_.Mul(x, x), arena_.Mul(y, y))});
    }
    case Builtin::kFloor:
    case Builtin::kCeil:
    case Builtin::kRound:
    case Builtin::kSign:
      return Rounded(Eval(e.args[1]), builtin);
    case Builtin::kOld: {
      const View* now = std::exchange(frame_.view, frame_.old);
      CHECK(frame_.view != nullptr);
      const TermId result = Eval(e.args[1]);
      frame_.view = now;
      return result;
    }
    case Builtin::kContains: {
      const TermId list = Eval(exprs_[e.args[0]].args[0]);
      return Contains(list, As(Eval(e.args[1]), arena_.sort(arena_.sort_of(list)).parts[0]));
    }
    case Builtin::kFront: {
      const TermId list = Eval(exprs_[e.args[0]].args[0]);
      const TermId first = arena_.IntNumber(0);
      Check(CheckKind::kIndex, e.span, InRange(first, arena_.Length(list)));
      return arena_.At(list, first);
    }
    case Builtin::kSlice: {
      const TermId list = Eval(e.args[1]);
      const TermId from = Eval(e.args[2]);
      const TermId to = e.args.size() > 3 ? Eval(e.args[3]) : arena_.Length(list);
      Check(CheckKind::kIndex, e.span,
            arena_.And({arena_.Le(arena_.IntNumber(0), from), arena_.Le(from, to),
                        arena_.Le(to, arena_.Length(list))}));
      return arena_.Slice(list, from, to);
    }
    case Builtin::kRect:
    case Builtin::kGrid:
    case Builtin::kInsert:
    case Builtin::kPop:
    case Builtin::kRemove:
    case Builtin::kClear:
    case Builtin::kAppend:
      break;  // not values
  }
  CHECK(false) << "a builtin that is no value got past the checker";
  return {};
}

}  // namespace rondo::koord
