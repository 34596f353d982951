#include <fmt/format.h>

#include "koord/check/checker.h"
#include "lang/suggest.h"

namespace rondo::koord {

using diag::Kind;
using lang::TypeKind;

int Checker::FindFunction(const std::string& name) const {
  int found = -1;
  for (size_t i = 0; i < model_.functions.size(); ++i) {
    const Function& f = model_.functions[i];
    if (f.name == name || (f.port >= 0 && f.name.ends_with("." + name))) found = static_cast<int>(i);
  }
  return found;
}

void Checker::Explore(const ExploreEntry& entry) {
  if (entry.kind == ExploreKind::kFunction) return ExploreFunction(entry);
  if (!Claim("explore " + entry.name, entry.span)) return;
  const std::string& name = entry.name;
  if (name == "N_sys" || name == "Nsys" || name == "numAgents" || name == "numBots") {
    if (entry.kind == ExploreKind::kValue) {
      NeedType(entry.body, model_.types.integer(), "the number of robots");
    } else {
      NeedType(entry.body, model_.types.List(model_.types.integer()), "a choice of team sizes");
    }
    model_.exploration.robots = entry.body;
    return;
  }
  int found = FindVariable(name);
  for (size_t i = 0; found < 0 && i < model_.variables.size(); ++i) {
    const Variable& v = model_.variables[i];
    if (!v.module.empty() && v.name == v.module + "." + name) found = static_cast<int>(i);
  }
  if (found < 0) return Undeclared(name, entry.span);
  ExploreVariable(entry, static_cast<size_t>(found));
}

void Checker::ExploreVariable(const ExploreEntry& entry, size_t index) {
  const Variable variable = model_.variables[index];
  const auto refuse = [&](std::string message) -> diag::Diagnostic& {
    return diagnostics_.Report(Kind::kKoordPointlessSpec, entry.span, std::move(message))
        .At(variable.span, "declared here");
  };
  if (variable.function >= 0) {
    refuse(fmt::format("`{}` is called, so it needs a body", variable.name))
        .Help(fmt::format("write `{}(target) = ...`", variable.name));
    return;
  }
  if (variable.initial.valid()) {
    refuse(fmt::format("`{}` has a value already", variable.name));
    return;
  }
  if (model_.types.Is(variable.type, TypeKind::kArray)) {
    refuse("arrays cannot be chosen as a whole").Help("give initial values in `init`");
    return;
  }
  const std::string what = fmt::format("a value of `{}`", variable.name);
  if (variable.kind == VariableKind::kParam) {
    if (entry.kind == ExploreKind::kChoice) {
      refuse("a parameter has one value").Help(fmt::format("write `{} = ...`", variable.name));
      return;
    }
    NeedType(entry.body, variable.type, what);
    model_.exploration.values[index] = entry.body;
  } else if (entry.kind == ExploreKind::kChoice) {
    if (exprs_[entry.body].kind == lang::ExprKind::kList) {
      for (const ExprId item : exprs_[entry.body].args) NeedType(item, variable.type, what);
      model_.type_of[entry.body.index()] = model_.types.List(variable.type);
    } else {
      grid_element_ = variable.type;
      NeedType(entry.body, model_.types.List(variable.type),
               fmt::format("the values of `{}`", variable.name));
      grid_element_ = TypeId();
    }
    model_.exploration.choices[index] = entry.body;
  } else {
    refuse(fmt::format("`{}` changes", variable.name))
        .Help(fmt::format("write `{} in [...]`, the values that it may take", variable.name));
    return;
  }
  RestrictInitial(entry.body, variable);
}

void Checker::ExploreFunction(const ExploreEntry& entry) {
  const int found = FindFunction(entry.name);
  if (found < 0) return Undeclared(entry.name, entry.span);
  const auto index = static_cast<size_t>(found);
  const Function f = model_.functions[index];
  if (!Claim("explore " + f.name, entry.span)) return;
  if (!f.external()) {
    diagnostics_.Report(Kind::kKoordPointlessSpec, entry.span, fmt::format("`{}` has a body already", f.name))
        .At(f.span, "defined here");
    return;
  }
  if (!f.declared) return;  // a callable port that nobody calls
  if (f.parameters.size() != entry.parameters.size()) {
    diagnostics_
        .Report(Kind::kKoordArity, entry.span,
                fmt::format("`{}` takes {} arguments", f.name, f.parameters.size()))
        .Under(fmt::format("{} named here", entry.parameters.size()))
        .At(f.span, f.def != nullptr ? "declared here" : "first used here");
    return;
  }
  std::vector<uint32_t> bound;
  for (size_t i = 0; i < f.parameters.size(); ++i)
    bound.push_back(Bind(entry.parameters[i], f.parameters[i], entry.parameter_spans[i]));
  model_.bound_by[&entry] = bound;
  function_ = found;
  NeedType(entry.body, f.result, fmt::format("the result of `{}`", f.name));
  function_ = -1;
  scope_.clear();
  if (f.port < 0) {
    RestrictScope(entry.body, nullptr, "the body of a function");
  } else {
    // A planner may look at the sensors of its robot.
    AssumeDef port{AssumeKind::kPort, {}, {}, entry.span, {}, {}};
    port.module = model_.variables[static_cast<size_t>(f.port)].module;
    RestrictScope(entry.body, &port, "the body of a planner");
  }
  model_.exploration.functions[index] = &entry;
}

}  // namespace rondo::koord
