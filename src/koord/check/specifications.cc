#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "koord/check/checker.h"
#include "koord/check/mentions_robot.h"

namespace rondo::koord {

using diag::Kind;
using lang::ExprKind;

void Checker::Specifications() {
  place_ = Place::kSpec;
  for (const AssumeDef* def : model_.assumptions) Assume(*def);
  for (const SummaryDef* def : model_.summaries) Summary(*def);
  for (const InvariantDef* def : model_.invariants) Invariant(*def);
  for (const ResponseDef* def : model_.responses) {
    NeedBool(def->when, "what a response follows");
    NeedBool(def->then, "a response");
  }
  for (const ExploreDef* def : explorations_) {
    for (const ExploreEntry& entry : def->entries) Explore(entry);
  }
}

void Checker::Invariant(const InvariantDef& def) { NeedBool(def.body, "an invariant"); }

void Checker::Assume(const AssumeDef& def) {
  switch (def.kind) {
    case AssumeKind::kInitially:
      NeedBool(def.body, "an assumption");
      return;
    case AssumeKind::kFact:
      NeedBool(def.body, "an assumption");
      RestrictScope(def.body, nullptr, "a general assumption");
      return;
    case AssumeKind::kPort:
      break;
  }
  if (!IsModule(def.module)) {
    diagnostics_.Report(Kind::kKoordUndeclared, def.span, fmt::format("there is no module `{}`", def.module));
  }
  if (def.when.valid()) {
    NeedBool(def.when, "the condition of an assumption");
    RestrictScope(def.when, &def, "a controller assumption");
  }
  old_allowed_ = true;
  NeedBool(def.body, "an assumption");
  old_allowed_ = false;
  RestrictScope(def.body, &def, "a controller assumption");
}

void Checker::Summary(const SummaryDef& def) {
  int index = FindFunction(def.function);
  if (index < 0) index = static_cast<int>(FunctionNamed(def.function, def.parameters.size(), def.span));
  Function& f = model_.functions[static_cast<size_t>(index)];
  if (!f.external()) {
    diagnostics_
        .Report(Kind::kKoordPointlessSpec, def.span,
                fmt::format("`{}` has a body, which says what it does", f.name))
        .At(f.span, "defined here")
        .Help("summaries are for functions without a body");
    return;
  }
  if (!f.declared) {
    f.declared = true;
    f.result = model_.types.FreshVariable();
    for (const std::string& name : def.parameters) {
      f.parameters.push_back(model_.types.FreshVariable());
      f.parameter_names.push_back(name);
    }
  }
  if (f.parameters.size() != def.parameters.size()) {
    diagnostics_
        .Report(Kind::kKoordArity, def.span,
                fmt::format("`{}` takes {} arguments", f.name, f.parameters.size()))
        .Under(fmt::format("{} named here", def.parameters.size()))
        .At(f.span, f.def != nullptr ? "declared here" : "first used here");
    return;
  }
  const std::vector<TypeId> parameters = f.parameters;
  const TypeId result = f.result;
  std::vector<uint32_t> bound;
  for (size_t i = 0; i < parameters.size(); ++i)
    bound.push_back(Bind(def.parameters[i], parameters[i], def.parameter_spans[i]));
  bound.push_back(Bind(def.result, result, def.span));
  model_.bound_by[&def] = bound;
  NeedBool(def.body, "a summary");
  scope_.clear();
  RestrictScope(def.body, nullptr, "a summary");
}

void Checker::RestrictInitial(ExprId id, const Variable& variable) {
  const lang::Expr& e = exprs_[id];
  const Ref ref = model_.RefOf(id);
  const bool reads = (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell) &&
                     e.kind != ExprKind::kCall && model_.variables[ref.index].kind != VariableKind::kParam;
  const bool port = ref.kind == RefKind::kFunction && model_.functions[ref.index].port >= 0;
  const bool calls = ref.kind == RefKind::kFunction && e.kind == ExprKind::kCall && !port;
  const bool robot = !variable.PerRobot() &&
                     (e.kind == ExprKind::kPid || (calls && RobotMentions(model_).InFunction(ref.index)));
  if (reads || port || robot) {
    diagnostics_
        .Report(Kind::kKoordSpecScope, e.span,
                fmt::format("the initial value of `{}` cannot mention this", variable.name))
        .Under(robot ? "all robots share the variable" : "nothing has a value yet")
        .Help("compute it in `init`");
    return;
  }
  for (const ExprId arg : e.args) RestrictInitial(arg, variable);
}

void Checker::RestrictScope(ExprId root, const AssumeDef* port, std::string_view what) {
  const std::function<void(ExprId)> visit = [&](ExprId id) {
    const lang::Expr& e = exprs_[id];
    const Ref ref = model_.RefOf(id);
    const bool names_variable =
        (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell || ref.kind == RefKind::kPortOf) &&
        (e.kind == ExprKind::kName || e.kind == ExprKind::kField || e.kind == ExprKind::kIndex);
    const bool calls_port =
        ref.kind == RefKind::kFunction && e.kind == ExprKind::kCall && model_.functions[ref.index].port >= 0;
    const auto refuse = [&](std::string why) {
      diagnostics_.Report(Kind::kKoordSpecScope, e.span, fmt::format("{} cannot mention this", what))
          .Under(std::move(why));
    };
    if (names_variable) {
      const Variable& v = model_.variables[ref.index];
      if (v.kind != VariableKind::kParam) {
        if (port == nullptr) {
          refuse("state changes, and this must hold at any time");
        } else if (v.module != port->module || ref.kind == RefKind::kPortOf) {
          refuse(fmt::format("only ports of the robot's own `{}`", port->module));
        } else if (v.kind == VariableKind::kActuator && !port->when.valid()) {
          refuse("a robot may set an actuator to anything: say `when` the assumption holds");
        }
      }
    }
    if (calls_port) {
      const Variable& v = model_.variables[static_cast<size_t>(model_.functions[ref.index].port)];
      if (port != nullptr && v.module != port->module)
        refuse(fmt::format("only ports of the robot's own `{}`", port->module));
      if (port != nullptr && port->when.valid()) refuse("what a planner returns is assumed without `when`");
    }
    const bool speaks = ref.kind == RefKind::kFunction && e.kind == ExprKind::kCall && !calls_port &&
                        RobotMentions(model_).InFunction(ref.index);
    if ((e.kind == ExprKind::kPid || speaks) && port == nullptr) refuse("there is no robot here");
    for (const ExprId arg : e.args) visit(arg);
    for (const lang::Binder& b : e.binders) {
      if (b.domain.valid()) visit(b.domain);
    }
  };
  visit(root);
}

}  // namespace rondo::koord
