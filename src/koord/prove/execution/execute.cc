#include <fmt/format.h>

#include <functional>

#include "base/check.h"
#include "koord/check/targets.h"
#include "koord/prove/execution/executor.h"

namespace rondo::koord {

using expr::Rational;
using lang::ExprKind;
using lang::TypeKind;

// -- whole events

Executor::State Executor::StartState(const View& start, TermId robot) {
  State state;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    const bool own = variable.PerRobot() && variable.kind != VariableKind::kAllread && variable.function < 0;
    state.value.push_back(own ? arena_.Select(start.value[v], robot) : start.value[v]);
  }
  state.path = arena_.True();
  state.broke = state.continued = state.ended = state.locked = state.stopped = arena_.False();
  return state;
}

Effect Executor::Finish(State& state, Effect effect) {
  effect.locks = state.locked;
  effect.stops = state.stopped;
  effect.value = state.value;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (model_.variables[v].kind == VariableKind::kAllread)
      effect.value[v] = arena_.Select(state.value[v], frame_.robot);
  }
  return effect;
}

Effect Executor::Run(const EventDef& event, const View& start, TermId robot) {
  State state = StartState(start, robot);
  Effect effect;
  effect.chosen = arena_.True();
  frame_ = Frame{&start, nullptr, robot, false, &state, &effect, {}};
  // Rule SelectEvent: the precondition is evaluated on the robot's own copy.
  const TermId guard = event.pre.valid() ? Eval(event.pre) : arena_.True();
  const TermId runs =
      vocabulary_.robots_stop() ? arena_.Not(arena_.Select(start.stopped, robot)) : arena_.True();
  effect.enabled = arena_.And(guard, runs);
  state.path = guard;
  Body(event.body);
  return Finish(state, std::move(effect));
}

Effect Executor::RunInit(const View& start, TermId robot) {
  State state = StartState(start, robot);
  Effect effect;
  effect.chosen = arena_.True();
  frame_ = Frame{&start, nullptr, robot, false, &state, &effect, {}};
  effect.enabled = arena_.True();
  for (const InitDef* init : model_.inits) {
    Body(init->body);
    state.ended = arena_.False();
  }
  return Finish(state, std::move(effect));
}

// -- statements

TermId Executor::Live() const {
  const State& s = *frame_.state;
  return arena_.And({arena_.Not(s.broke), arena_.Not(s.continued), arena_.Not(s.ended)});
}

Executor::State Executor::Merge(TermId condition, const State& then, const State& otherwise) {
  const auto pick = [&](TermId a, TermId b) {
    return a == b || !a.valid() ? a : arena_.Ite(condition, a, b);
  };
  State result;
  for (size_t v = 0; v < then.value.size(); ++v)
    result.value.push_back(pick(then.value[v], otherwise.value[v]));
  result.broke = pick(then.broke, otherwise.broke);
  result.continued = pick(then.continued, otherwise.continued);
  result.ended = pick(then.ended, otherwise.ended);
  result.locked = pick(then.locked, otherwise.locked);
  result.stopped = pick(then.stopped, otherwise.stopped);
  result.result = pick(then.result, otherwise.result);
  return result;
}

// Rules StmtSeq1 and StmtSeq2.
void Executor::Body(const std::vector<Stmt>& body) {
  for (const Stmt& stmt : body) Execute(stmt);
}

void Executor::Execute(const Stmt& stmt) {
  State& state = *frame_.state;
  const TermId live = Live();
  if (live == arena_.False()) return;
  const auto set_flag = [&](TermId& flag) { flag = arena_.Or(flag, live); };
  switch (stmt.kind) {
    case StmtKind::kAssign:
      return Assign(stmt.target, EvalAs(stmt.value, model_.TypeOf(stmt.target)));
    case StmtKind::kAddAssign:
    case StmtKind::kIncrement: {
      const TypeId type = model_.TypeOf(stmt.target);
      const TermId old = Eval(stmt.target);
      const TermId more = stmt.kind == StmtKind::kIncrement ? arena_.Number(arena_.sort_of(old), Rational(1))
                                                            : EvalAs(stmt.value, type);
      if (model_.types.IsNumeric(type)) return Assign(stmt.target, arena_.Add(old, more));
      if (arena_.sort(arena_.sort_of(old)).kind == expr::SortKind::kRecord) {
        std::vector<TermId> parts;
        for (uint32_t i = 0; i < 3; ++i)
          parts.push_back(arena_.Add(arena_.Field(old, i), arena_.Field(more, i)));
        return Assign(stmt.target, arena_.MakeRecord(arena_.sort_of(old), std::move(parts)));
      }
      return Assign(stmt.target, Concatenate(old, more));
    }
    case StmtKind::kLocal: {
      const uint32_t binding = model_.bound_by.at(&stmt)[0];
      frame_.bindings[binding] = EvalAs(stmt.value, model_.bindings[binding].type);
      return;
    }
    case StmtKind::kPass:
      return;
    case StmtKind::kCall:
      return Method(stmt);
    case StmtKind::kStream:
      for (const ExprId e : stmt.operands) Eval(e);
      return;
    case StmtKind::kStop:
      state.stopped = arena_.Or(state.stopped, live);
      return set_flag(state.ended);
    case StmtKind::kBreak:
      return set_flag(state.broke);
    case StmtKind::kContinue:
      return set_flag(state.continued);
    case StmtKind::kReturn:
      if (stmt.value.valid() && state.result.valid()) {
        const TermId value = As(Eval(stmt.value), arena_.sort_of(state.result));
        state.result = arena_.Ite(live, value, state.result);
      }
      return set_flag(state.ended);
    case StmtKind::kIf:
      return If(stmt);
    case StmtKind::kForIn:
      return LoopIn(stmt);
    case StmtKind::kForRange:
      return LoopRange(stmt);
    case StmtKind::kWhile:
      return LoopWhile(stmt);
    case StmtKind::kAtomic:
      // One lock for each event; without it the event is a skip, so control gets past this point only with
      // the lock.
      state.locked = arena_.Or(state.locked, Reached());
      return Body(stmt.body);
  }
}

void Executor::If(const Stmt& stmt) {
  const TermId condition = Eval(stmt.value);
  State* whole = frame_.state;
  const TermId path = whole->path;
  State then = *whole;
  then.path = arena_.And(path, condition);
  State otherwise = *whole;
  otherwise.path = arena_.And(path, arena_.Not(condition));
  if (condition != arena_.False()) {
    frame_.state = &then;
    Body(stmt.body);
  }
  if (condition != arena_.True()) {
    frame_.state = &otherwise;
    Body(stmt.orelse);
  }
  frame_.state = whole;
  *whole = Merge(condition, then, otherwise);
  whole->path = path;
}

// -- writing

void Executor::Method(const Stmt& stmt) {
  const Ref ref = model_.RefOf(stmt.value);
  const lang::Expr& call = exprs_[stmt.value];
  if (ref.kind != RefKind::kBuiltin) {
    for (size_t i = 1; i < call.args.size(); ++i) Eval(call.args[i]);
    return;  // the value of a function called as a statement is not used
  }
  const auto builtin = static_cast<Builtin>(ref.index);
  if (!WritesList(builtin)) {
    for (size_t i = 1; i < call.args.size(); ++i) Eval(call.args[i]);
    return;
  }
  const ExprId target = exprs_[call.args[0]].args[0];
  const TermId list = Eval(target);
  if (builtin == Builtin::kClear)
    return Assign(target, arena_.MakeList(arena_.sort(arena_.sort_of(list)).parts[0], {}));
  if (builtin == Builtin::kPop || builtin == Builtin::kInsert) return ChangeAt(stmt, target, list, builtin);
  const TermId element = As(Eval(call.args[1]), arena_.sort(arena_.sort_of(list)).parts[0]);
  if (builtin == Builtin::kAppend) return Assign(target, arena_.Append(list, element));
  const TermId k = arena_.FreshBound("k", arena_.Int());
  Check(CheckKind::kRemove, stmt.span,
        arena_.Exists({k}, arena_.And({arena_.Le(arena_.IntNumber(0), k), arena_.Lt(k, arena_.Length(list)),
                                       arena_.Eq(arena_.At(list, k), element)})));
  Assign(target, arena_.Remove(list, element));
}

// `l.insert(i, x)` and `l.pop(i)`.
void Executor::ChangeAt(const Stmt& stmt, ExprId target, TermId list, Builtin builtin) {
  const lang::Expr& call = exprs_[stmt.value];
  const TermId index = call.args.size() > 1 ? Eval(call.args[1]) : arena_.IntNumber(0);
  const TermId length = arena_.Length(list);
  if (builtin == Builtin::kPop) {
    Check(CheckKind::kIndex, stmt.span, InRange(index, length));
    return Assign(target, arena_.Drop(list, index));
  }
  const TermId element = As(Eval(call.args[2]), arena_.sort(arena_.sort_of(list)).parts[0]);
  Check(CheckKind::kIndex, stmt.span,
        arena_.And(arena_.Le(arena_.IntNumber(0), index), arena_.Le(index, length)));
  Assign(target, arena_.Insert(list, index, element));
}

// Writes `value` at `target`: a member or item of a variable is a change of the whole.
void Executor::Assign(ExprId target, TermId value) {
  const lang::Expr& e = exprs_[target];
  const Ref ref = model_.RefOf(target);
  if (ref.kind == RefKind::kVariable) return AssignRoot(ref.index, value, {}, {});
  if (ref.kind == RefKind::kCell) return AssignRoot(ref.index, value, frame_.robot, {});
  if (ref.kind == RefKind::kBinding) {
    TermId& slot = frame_.bindings.at(ref.index);
    slot = arena_.Ite(arena_.And(Live(), frame_.state->path), value, slot);
    return;
  }
  const ExprId inner = e.args[0];
  if (e.kind == ExprKind::kIndex && model_.types.Is(model_.TypeOf(inner), TypeKind::kArray))
    return AssignCell(target, value);
  const TermId whole = Eval(inner);
  if (e.kind == ExprKind::kField) {
    std::vector<TermId> parts;
    const size_t count = arena_.sort(arena_.sort_of(whole)).parts.size();
    for (uint32_t i = 0; i < count; ++i) parts.push_back(i == ref.index ? value : arena_.Field(whole, i));
    return Assign(inner, arena_.MakeRecord(arena_.sort_of(whole), std::move(parts)));
  }
  CHECK(e.kind == ExprKind::kIndex);
  const TermId index = Eval(e.args[1]);
  Check(CheckKind::kIndex, e.span, InRange(index, arena_.Length(whole)));
  Assign(inner, arena_.Set(whole, index, value));
}

// `a[i][j]` of a variable with arrays of arrays: the variable, and the indices from the outer one on.
std::optional<size_t> Executor::SharedArrayOf(ExprId target, std::vector<ExprId>& indices) const {
  while (exprs_[target].kind == ExprKind::kIndex && model_.RefOf(target).kind == RefKind::kNone &&
         model_.types.Is(model_.TypeOf(exprs_[target].args[0]), TypeKind::kArray)) {
    indices.insert(indices.begin(), exprs_[target].args[1]);
    target = exprs_[target].args[0];
  }
  const Ref root = model_.RefOf(target);
  return root.kind == RefKind::kVariable ? std::optional<size_t>(root.index) : std::nullopt;
}

// An item of an array. A cell of a shared variable, however deep, has a last writer of its own.
void Executor::AssignCell(ExprId target, TermId value) {
  const lang::Expr& e = exprs_[target];
  std::vector<ExprId> places;
  const std::optional<size_t> root = SharedArrayOf(target, places);
  if (!root) {
    const TermId whole = Eval(e.args[0]);
    const TermId index = Eval(e.args[1]);
    Check(CheckKind::kIndex, e.span, InRange(index, ArrayLength(model_.TypeOf(e.args[0]))));
    return Assign(e.args[0], arena_.Store(whole, index, value));
  }
  TypeId type = model_.variables[*root].type;
  std::vector<TermId> indices;
  for (const ExprId place : places) {
    indices.push_back(Eval(place));
    Check(CheckKind::kIndex, e.span, InRange(indices.back(), ArrayLength(type)));
    type = model_.types[type].parts[0];
  }
  AssignRoot(*root, value, {}, std::move(indices));
}

// Rules SvarAssign and LvarAssign. `robot`: of the cell of an `allread` variable. `indices`: of the part of
// an array that is written.
void Executor::AssignRoot(size_t v, TermId value, TermId robot, std::vector<TermId> indices) {
  State& state = *frame_.state;
  const Variable& variable = model_.variables[v];
  const TermId old = state.value[v];
  if (robot.valid()) indices.insert(indices.begin(), robot);
  // From the inside out: store(a, i, store(a[i], j, value)).
  const std::function<TermId(TermId, size_t)> stored = [&](TermId whole, size_t depth) {
    if (depth == indices.size()) return value;
    return arena_.Store(whole, indices[depth], stored(arena_.Select(whole, indices[depth]), depth + 1));
  };
  const TermId fresh = arena_.Ite(Live(), stored(old, 0), old);
  if (variable.kind == VariableKind::kAllwrite) frame_.effect->writes.push_back({v, Reached(), indices});
  state.value[v] = fresh;
}

}  // namespace rondo::koord
