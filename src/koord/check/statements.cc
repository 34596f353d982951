#include <fmt/format.h>

#include <utility>

#include "koord/check/checker.h"
#include "koord/check/targets.h"

namespace rondo::koord {

using diag::Kind;
using diag::Span;
using lang::ExprKind;
using lang::TypeKind;

void Checker::Body(const std::vector<Stmt>& body) {
  const Stmt* ended = nullptr;
  const size_t depth = scope_.size();  // local variables end with their block
  for (const Stmt& stmt : body) {
    if (ended != nullptr) {
      diagnostics_.Report(Kind::kKoordUnreachable, stmt.span, "this statement is never reached")
          .At(ended->span, "nothing here runs on");
      ended = nullptr;
    }
    Statement(stmt);
    if (stmt.kind == StmtKind::kStop || stmt.kind == StmtKind::kBreak || stmt.kind == StmtKind::kContinue ||
        stmt.kind == StmtKind::kReturn) {
      ended = &stmt;
    }
  }
  scope_.resize(depth);
}

void Checker::DeclareLocal(const Stmt& stmt) {
  const TypeId type = TypeOf(stmt.type);
  NeedType(stmt.value, type, "the value of a local variable");
  const std::string& name = stmt.names[0];
  const auto known = [&](diag::Span span) {
    diagnostics_
        .Report(Kind::kKoordDuplicate, stmt.name_spans[0], fmt::format("there is a `{}` already", name))
        .At(span, "declared here");
  };
  if (const int v = FindVariable(name); v >= 0) known(model_.variables[static_cast<size_t>(v)].span);
  for (const uint32_t b : scope_) {
    if (model_.bindings[b].name == name) known(model_.bindings[b].span);
  }
  const uint32_t binding = Bind(name, type, stmt.name_spans[0]);
  model_.bound_by[&stmt] = {binding};
  locals_.insert(binding);
}

void Checker::Statement(const Stmt& stmt) {
  const auto misplaced = [&](std::string message) -> diag::Diagnostic& {
    return diagnostics_.Report(Kind::kKoordMisplacedStatement, stmt.span, std::move(message));
  };
  switch (stmt.kind) {
    case StmtKind::kAssign:
    case StmtKind::kAddAssign:
    case StmtKind::kIncrement:
      return Assign(stmt);
    case StmtKind::kLocal:
      return DeclareLocal(stmt);
    case StmtKind::kPass:
      return;
    case StmtKind::kCall:
      statement_call_ = stmt.value;
      Expr(stmt.value);
      // l.remove(x) and l.append(x) write their list.
      if (model_.RefOf(stmt.value).kind == RefKind::kBuiltin) {
        const auto builtin = static_cast<Builtin>(model_.RefOf(stmt.value).index);
        if (WritesList(builtin)) {
          Target(exprs_[exprs_[stmt.value].args[0]].args[0]);
        }
      }
      return;
    case StmtKind::kStream: {
      writing_ = true;
      const TypeId type = Expr(stmt.target);
      writing_ = false;
      if (!model_.types.Is(type, TypeKind::kStream) && !model_.types.Is(type, TypeKind::kError)) {
        diagnostics_.Report(Kind::kKoordStreamMisuse, exprs_[stmt.target].span, "only a stream takes `<<`")
            .Under(fmt::format("this is a `{}`", model_.types.Name(type)));
      }
      for (const ExprId e : stmt.operands) Expr(e);
      return;
    }
    case StmtKind::kStop:
      if (place_ == Place::kFunction)
        misplaced("a function cannot stop the robot").Help("return a value and `stop` in the event");
      return;
    case StmtKind::kBreak:
    case StmtKind::kContinue:
      if (loops_ == 0)
        misplaced(fmt::format("`{}` outside a loop", stmt.kind == StmtKind::kBreak ? "break" : "continue"));
      return;
    case StmtKind::kReturn: {
      if (place_ != Place::kFunction) {
        if (stmt.value.valid()) {
          Expr(stmt.value);
          misplaced("only functions return a value").Help("`return` alone ends an event");
        }
        return;
      }
      if (!stmt.value.valid()) return;
      const TypeId given = Expr(stmt.value);
      const Function& f = model_.functions[static_cast<size_t>(function_)];
      if (!model_.types.Coerce(given, f.result)) {
        diagnostics_
            .Report(Kind::kKoordTypeMismatch, exprs_[stmt.value].span,
                    fmt::format("`{}` returns a `{}`", f.name, model_.types.Name(f.result)))
            .Under(fmt::format("this is a `{}`", model_.types.Name(given)))
            .At(f.span, "declared here");
      }
      return;
    }
    case StmtKind::kIf:
      NeedBool(stmt.value, "a condition");
      Body(stmt.body);
      Body(stmt.orelse);
      return;
    case StmtKind::kForIn:
      return LoopIn(stmt);
    case StmtKind::kForRange:
      return LoopRange(stmt);
    case StmtKind::kWhile:
      NeedBool(stmt.value, "the condition of a loop");
      NeedType(stmt.operands[0], model_.types.integer(), "the number of iterations");
      ++loops_;
      Body(stmt.body);
      --loops_;
      return;
    case StmtKind::kAtomic:
      if (place_ != Place::kEvent) misplaced("`atomic` belongs into an event");
      ++atomic_;
      Body(stmt.body);
      --atomic_;
      return;
  }
}

void Checker::LoopIn(const Stmt& stmt) {
  auto& types = model_.types;
  const TypeId list = Expr(stmt.value);
  TypeId element = types.FreshVariable();
  if (types.Is(list, TypeKind::kArray)) {
    element = types[list].parts[0];
  } else if (!types.Is(list, TypeKind::kError) && !types.Unify(list, types.List(element))) {
    element = Mismatch(exprs_[stmt.value].span,
                       fmt::format("a loop runs over a list, not over a `{}`", types.Name(list)));
  }
  std::vector<TypeId> parts{element};
  if (stmt.names.size() > 1) {
    parts.clear();
    if (types.Is(element, TypeKind::kTuple) && types[element].parts.size() == stmt.names.size()) {
      parts = types[element].parts;
    } else {
      if (!types.Is(element, TypeKind::kError)) {
        diagnostics_.Report(
            Kind::kKoordArity, stmt.name_spans.front().To(stmt.name_spans.back()),
            fmt::format("{} variables for items of type `{}`", stmt.names.size(), types.Name(element)));
      }
      parts.assign(stmt.names.size(), types.error());
    }
  }
  const size_t depth = scope_.size();
  std::vector<uint32_t> bound;
  for (size_t i = 0; i < stmt.names.size(); ++i)
    bound.push_back(Bind(stmt.names[i], parts[i], stmt.name_spans[i]));
  model_.bound_by[&stmt] = bound;
  ++loops_;
  Body(stmt.body);
  --loops_;
  scope_.resize(depth);
}

void Checker::LoopRange(const Stmt& stmt) {
  NeedType(stmt.value, model_.types.integer(), "the first value of a loop");
  NeedType(stmt.operands[0], model_.types.integer(), "the end of a loop");
  const size_t depth = scope_.size();
  model_.bound_by[&stmt] = {Bind(stmt.names[0], model_.types.integer(), stmt.name_spans[0])};
  ++loops_;
  Body(stmt.body);
  --loops_;
  scope_.resize(depth);
}

void Checker::Assign(const Stmt& stmt) {
  auto& types = model_.types;
  const TypeId target = Target(stmt.target);
  const bool plus = stmt.kind != StmtKind::kAssign;
  if (stmt.value.valid() && target.valid() && !plus && IsArrayLiteral(stmt.value, target)) {
    NeedArray(stmt.value, target, "the value");
  } else if (stmt.value.valid()) {
    const TypeId given = Expr(stmt.value);
    if (!target.valid()) return;
    if (!types.Coerce(given, target)) {
      auto& report = diagnostics_.Report(
          Kind::kKoordTypeMismatch, exprs_[stmt.value].span,
          fmt::format("a `{}` cannot be assigned to a `{}`", types.Name(given), types.Name(target)));
      report.Under(fmt::format("this is a `{}`", types.Name(given)));
      report.At(exprs_[stmt.target].span, fmt::format("this is a `{}`", types.Name(target)));
      return;
    }
  }
  if (!target.valid() || !plus) return;
  const bool addable = types.IsNumeric(target) || types.Is(target, TypeKind::kError) ||
                       types.Is(target, TypeKind::kString) ||
                       (stmt.kind == StmtKind::kAddAssign && types.Resolve(target) == types.pos());
  if (!addable) {
    Mismatch(exprs_[stmt.target].span,
             fmt::format("`{}` needs a number, not a `{}`",
                         stmt.kind == StmtKind::kIncrement ? "++" : "+=", types.Name(target)));
  }
}

TypeId Checker::Target(ExprId id) {
  const lang::Expr& e = exprs_[id];
  // The innermost name decides whether writing is allowed.
  ExprId root = id;
  while (true) {
    const lang::Expr& r = exprs_[root];
    if ((r.kind == ExprKind::kField && !IsModuleName(r.args[0])) || r.kind == ExprKind::kIndex) {
      root = r.args[0];
    } else {
      break;
    }
  }
  writing_ = true;
  // Parts of a target are looked at more than once.
  const bool may_choose = std::exchange(may_choose_, false);
  const size_t before = diagnostics_.errors();
  const TypeId type = Expr(id);
  may_choose_ = may_choose;
  writing_ = false;
  if (diagnostics_.errors() != before) return {};
  for (ExprId part = id; part != root; part = exprs_[part].args[0]) {
    if (model_.RefOf(part).kind != RefKind::kOpaqueField) continue;
    const std::string name = model_.types.Name(model_.TypeOf(exprs_[part].args[0]));
    diagnostics_.Report(Kind::kKoordNotAssignable, exprs_[part].span, "this cannot be assigned to")
        .Under(fmt::format("nothing says what a `{}` consists of", name))
        .Help(fmt::format("declare it: `def adt {}:` and its members below", name));
    return {};
  }
  const Ref ref = model_.RefOf(root);
  // `x[pid]` is resolved at the index, `x` alone at the name.
  ExprId cell = id;
  while (model_.RefOf(cell).kind != RefKind::kCell && cell != root) cell = exprs_[cell].args[0];
  const Ref cell_ref = model_.RefOf(cell);
  if (cell_ref.kind == RefKind::kCell) return TargetRoot(cell, cell_ref.index).valid() ? type : TypeId{};
  if (ref.kind == RefKind::kVariable) return TargetRoot(root, ref.index).valid() ? type : TypeId{};
  if (ref.kind == RefKind::kBinding && locals_.contains(ref.index)) return type;
  if (ref.kind == RefKind::kBinding && place_ == Place::kFunction) {
    const auto it = model_.bound_by.find(model_.functions[static_cast<size_t>(function_)].def);
    if (it != model_.bound_by.end()) {
      for (const uint32_t b : it->second) {
        if (b == ref.index) return type;
      }
    }
  }
  auto& report = diagnostics_.Report(Kind::kKoordNotAssignable, e.span, "this cannot be assigned to");
  if (ref.kind == RefKind::kBinding)
    report.At(model_.bindings[ref.index].span, "a variable of a loop or quantifier");
  if (ref.kind == RefKind::kSystemSize) report.Under("the number of robots is fixed");
  return {};
}

TypeId Checker::TargetRoot(ExprId id, size_t variable) {
  const Variable& v = model_.variables[variable];
  const Span span = exprs_[id].span;
  if (place_ == Place::kFunction) {
    diagnostics_.Report(Kind::kKoordNotAssignable, span, fmt::format("a function cannot write `{}`", v.name))
        .Help("return the value and assign it in the event");
    return {};
  }
  if (model_.types.Is(v.type, TypeKind::kStream)) {
    diagnostics_
        .Report(Kind::kKoordStreamMisuse, span, fmt::format("stream `{}` cannot be assigned to", v.name))
        .Help(fmt::format("write `{} << value`", v.name));
    return {};
  }
  switch (v.kind) {
    case VariableKind::kSensor:
      diagnostics_.Report(Kind::kKoordSensorWrite, span, fmt::format("sensor `{}` can only be read", v.name))
          .At(v.span, "declared as a sensor here");
      return {};
    case VariableKind::kParam:
      diagnostics_.Report(Kind::kKoordNotAssignable, span, fmt::format("parameter `{}` is fixed", v.name))
          .At(v.span, "declared here");
      return {};
    case VariableKind::kAllread: {
      const bool own =
          model_.RefOf(id).kind == RefKind::kCell && exprs_[exprs_[id].args[1]].kind == ExprKind::kPid;
      if (own) return v.type;
      diagnostics_
          .Report(Kind::kKoordAllreadOwnership, span,
                  fmt::format("a robot can write only its own cell `{}[pid]`", v.name))
          .At(v.span, "declared `allread` here");
      return {};
    }
    case VariableKind::kAllwrite:
      if (place_ == Place::kEvent && atomic_ == 0) {
        diagnostics_
            .Report(Kind::kKoordLostUpdate, span,
                    fmt::format("another robot may write `{}` in the same round", v.name))
            .Under("only the last writer's value stays")
            .Help("put the statements that decide this value into `atomic:`");
      }
      return v.type;
    case VariableKind::kLocal:
    case VariableKind::kActuator:
      return v.type;
  }
  return {};
}

}  // namespace rondo::koord
