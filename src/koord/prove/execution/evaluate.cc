#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/check.h"
#include "koord/prove/execution/executor.h"

namespace rondo::koord {

using expr::Rational;
using lang::ExprKind;
using lang::TypeKind;

namespace {

// Are all parts of the one conjunction parts of the other?
bool Among(const expr::Arena& arena, TermId part, TermId whole) {
  const auto parts = [&](TermId t) {
    if (arena.op(t) != expr::Op::kAnd) return std::vector<TermId>{t};
    return std::vector<TermId>(arena.args(t).begin(), arena.args(t).end());
  };
  const std::vector<TermId> known = parts(whole);
  const std::vector<TermId> wanted = parts(part);
  return std::all_of(wanted.begin(), wanted.end(),
                     [&](TermId t) { return std::find(known.begin(), known.end(), t) != known.end(); });
}

}  // namespace

Executor::Executor(Vocabulary& vocabulary, diag::Diagnostics& diagnostics, ExecutionOptions options)
    : vocabulary_(vocabulary),
      arena_(vocabulary.arena()),
      model_(vocabulary.model()),
      exprs_(vocabulary.model().program->exprs),
      diagnostics_(diagnostics),
      options_(options) {}

TermId Executor::Specification(ExprId e, const View& view, TermId robot, const View* old,
                               const std::map<uint32_t, TermId>& bindings) {
  const Frame saved = std::move(frame_);
  frame_ = Frame{&view, old, robot, false, nullptr, nullptr, bindings};
  used_robot_ = false;
  const TermId result = Eval(e);
  frame_ = saved;
  return result;
}

TermId Executor::Value(ExprId e, TypeId type, const View& parameters, TermId robot) {
  State state;
  state.value = parameters.value;
  state.path = arena_.True();
  state.broke = state.continued = state.ended = state.locked = state.stopped = arena_.False();
  Effect effect;
  frame_ = Frame{&parameters, nullptr, robot, false, &state, &effect, {}};
  const TermId value = EvalAs(e, type);
  if (!effect.checks.empty()) {
    diagnostics_
        .Report(diag::Kind::kKoordUndefinedOperation, effect.checks[0].span,
                "this initial value may be undefined")
        .Help("compute it in `init`, behind a condition");
  }
  return value;
}

TermId Executor::Robot() {
  used_robot_ = true;
  return frame_.robot;
}

TermId Executor::Reached() const {
  std::vector<TermId> parts = conditions_;
  if (frame_.state != nullptr) {
    parts.push_back(frame_.state->path);
    parts.push_back(Live());
  }
  return arena_.And(parts);
}

void Executor::Check(CheckKind kind, diag::Span span, TermId holds) {
  TermId reached = Reached();
  if (holds == arena_.True() || Among(arena_, holds, reached)) return;
  // Below a quantifier the operation must be defined for each value of its variables.
  if (!quantified_.empty()) {
    holds = arena_.Forall(quantified_, arena_.Implies(reached, holds));
    if (arena_.IsOpen(reached)) reached = arena_.True();
  }
  (InProgram() ? frame_.effect->checks : specification_checks_).push_back({kind, span, reached, holds});
}

TermId Executor::Under(TermId condition, ExprId e) {
  conditions_.push_back(condition);
  const TermId result = Eval(e);
  conditions_.pop_back();
  return result;
}

TermId Executor::As(TermId term, SortId sort) {
  return arena_.sort_of(term) == arena_.Int() && sort == arena_.Real() ? arena_.ToReal(term) : term;
}

TermId Executor::EvalAs(ExprId id, TypeId type) {
  const TermId term = Eval(id);
  const SortId sort = vocabulary_.SortOf(type);
  // A list literal of ints where a list of floats is needed.
  if (arena_.op(term) == expr::Op::kListMake && arena_.sort_of(term) != sort) {
    const SortId element = arena_.sort(sort).parts[0];
    std::vector<TermId> items;
    for (const TermId item : std::vector<TermId>(arena_.args(term).begin(), arena_.args(term).end()))
      items.push_back(As(item, element));
    return arena_.MakeList(element, std::move(items));
  }
  return As(term, sort);
}

TermId Executor::Eval(ExprId id) {
  const lang::Expr& e = exprs_[id];
  const Ref ref = model_.RefOf(id);
  switch (e.kind) {
    case ExprKind::kError:
      break;
    case ExprKind::kInt:
      return arena_.Number(arena_.Int(), *Rational::Parse(e.text));
    case ExprKind::kFloat:
      return arena_.Number(arena_.Real(), *Rational::Parse(e.text));
    case ExprKind::kString:
      vocabulary_.MarkTexts();
      return vocabulary_.StringLiteral(e.text);
    case ExprKind::kBool:
      return arena_.Constant(e.text == "true");
    case ExprKind::kPid:
      return Robot();
    case ExprKind::kName:
    case ExprKind::kField:
    case ExprKind::kIndex:
      switch (ref.kind) {
        case RefKind::kVariable:
          return ReadVariable(ref.index);
        case RefKind::kCell:
          return ReadCell(ref.index, Eval(e.args[1]), id);
        case RefKind::kPortOf:
          return ReadCell(ref.index, Eval(exprs_[e.args[0]].args[1]), id);
        case RefKind::kBinding:
          return frame_.bindings.at(ref.index);
        case RefKind::kMember:
          return arena_.Member(vocabulary_.SortOf(model_.TypeOf(id)), ref.index);
        case RefKind::kSystemSize:
          return vocabulary_.robots();
        case RefKind::kStopped: {
          const TermId robot = Eval(e.args[1]);
          Check(CheckKind::kIndex, e.span, vocabulary_.IsRobot(robot));
          if (!vocabulary_.robots_stop()) return arena_.False();
          return arena_.Select(frame_.view->stopped, robot);
        }
        case RefKind::kOpaqueField:
          return arena_.Apply(vocabulary_.Function(ref.index, ""), {Eval(e.args[0])});
        case RefKind::kFunction:
        case RefKind::kBuiltin:
        case RefKind::kNone:
          break;
      }
      if (e.kind == ExprKind::kField) return arena_.Field(Eval(e.args[0]), ref.index);
      CHECK(e.kind == ExprKind::kIndex) << "an unresolved name got past the checker: " << e.text;
      return Index(id, e);
    case ExprKind::kCall:
      return Call(id, e);
    case ExprKind::kUnary:
      return Unary(e);
    case ExprKind::kBinary:
      return Binary(e);
    case ExprKind::kList: {
      if (model_.types.Is(model_.TypeOf(id), lang::TypeKind::kArray)) return MakeArray(id, e);
      const SortId element = arena_.sort(vocabulary_.SortOf(model_.TypeOf(id))).parts[0];
      std::vector<TermId> items;
      for (const ExprId item : e.args) items.push_back(As(Eval(item), element));
      return arena_.MakeList(element, std::move(items));
    }
    case ExprKind::kTuple: {
      std::vector<TermId> items;
      for (const ExprId item : e.args) items.push_back(Eval(item));
      return arena_.MakeRecord(vocabulary_.SortOf(model_.TypeOf(id)), std::move(items));
    }
    case ExprKind::kQuantifier:
      return Quantifier(id, e);
    case ExprKind::kFold:
      return Fold(id, e);
    case ExprKind::kConditional: {
      const TermId condition = Eval(e.args[0]);
      const SortId sort = vocabulary_.SortOf(model_.TypeOf(id));
      const TermId then = As(Under(condition, e.args[1]), sort);
      const TermId otherwise = As(Under(arena_.Not(condition), e.args[2]), sort);
      return arena_.Ite(condition, then, otherwise);
    }
    case ExprKind::kAny:
      return Any(id, e);
    case ExprKind::kQuantity:
      break;  // not part of Koord
  }
  CHECK(false) << "an erroneous expression got past the checker";
  return {};
}

// What the array has behind its items does not matter (see `EqualValues`).
TermId Executor::MakeArray(ExprId id, const lang::Expr& e) {
  const TypeId type = model_.TypeOf(id);
  const TypeId item = model_.types[type].parts[0];
  TermId array = arena_.FreshConstant("array", vocabulary_.SortOf(type));
  for (size_t i = 0; i < e.args.size(); ++i)
    array = arena_.Store(array, arena_.IntNumber(static_cast<int64_t>(i)), EvalAs(e.args[i], item));
  return array;
}

TermId Executor::HasInitialValue(size_t variable, TermId whole, const View& parameters, TermId robot) {
  const Variable& v = model_.variables[variable];
  TypeId type = v.type;
  const bool filled = model_.filled.contains(variable);
  while (filled && model_.types.Is(type, lang::TypeKind::kArray)) type = model_.types[type].parts[0];
  const TermId value = Value(v.initial, type, parameters, robot);
  // Lengths of arrays are made of parameters.
  frame_ = Frame{&parameters, nullptr, robot, false, nullptr, nullptr, {}};
  if (filled) return Filled(whole, v.type, value);
  return model_.types.Is(type, lang::TypeKind::kArray) ? EqualValues(whole, value, type)
                                                       : arena_.Eq(whole, value);
}

TermId Executor::Filled(TermId whole, TypeId type, TermId value) {
  if (!model_.types.Is(type, lang::TypeKind::kArray)) return arena_.Eq(whole, value);
  const TypeId item = model_.types[type].parts[0];
  const TermId length = ArrayLength(type);
  constexpr int64_t kSpelledOut = 256;
  if (const auto count = ConstantInt(length); count && *count <= kSpelledOut) {
    std::vector<TermId> parts;
    for (int64_t i = 0; i < *count; ++i)
      parts.push_back(Filled(arena_.Select(whole, arena_.IntNumber(i)), item, value));
    return arena_.And(parts);
  }
  const TermId k = arena_.FreshBound("k", arena_.Int());
  return arena_.Forall({k}, arena_.Implies(InRange(k, length), Filled(arena_.Select(whole, k), item, value)));
}

// Rule Var-Lookup: from the robot's own copy, never from what others write in this round.
TermId Executor::ReadVariable(size_t v) {
  const Variable& variable = model_.variables[v];
  if (variable.kind == VariableKind::kParam) return frame_.view->value[v];
  if (InProgram()) {
    const TermId value = frame_.state->value[v];
    if (variable.kind == VariableKind::kSensor || variable.kind == VariableKind::kAllwrite) {
      frame_.effect->reads.push_back({v, {}, value, Reached()});
    }
    return value;
  }
  const TermId value = frame_.view->value[v];
  if (!variable.PerRobot() || variable.kind == VariableKind::kAllread) return value;
  return arena_.Select(value, Robot());
}

TermId Executor::ReadCell(size_t v, TermId robot, ExprId at) {
  Check(CheckKind::kIndex, exprs_[at].span, vocabulary_.IsRobot(robot));
  if (!InProgram()) return arena_.Select(frame_.view->value[v], robot);
  const TermId value = arena_.Select(frame_.state->value[v], robot);
  if (quantified_.empty()) frame_.effect->reads.push_back({v, robot, value, Reached()});
  return value;
}

TermId Executor::Index(ExprId id, const lang::Expr& e) {
  const TermId base = Eval(e.args[0]);
  const TermId index = Eval(e.args[1]);
  if (model_.types.Is(model_.TypeOf(e.args[0]), TypeKind::kList)) {
    Check(CheckKind::kIndex, exprs_[id].span, InRange(index, arena_.Length(base)));
    return arena_.At(base, index);
  }
  Check(CheckKind::kIndex, exprs_[id].span, InRange(index, ArrayLength(model_.TypeOf(e.args[0]))));
  return arena_.Select(base, index);
}

TermId Executor::InRange(TermId index, TermId length) {
  return arena_.And(arena_.Le(arena_.IntNumber(0), index), arena_.Lt(index, length));
}

// The length that its type states: a term over parameters and the number of robots.
TermId Executor::ArrayLength(TypeId array) {
  const std::string& length = model_.types[array].length;
  if (length == kRobotsLength) return vocabulary_.robots();
  return Eval(model_.lengths.at(length));
}

}  // namespace rondo::koord
