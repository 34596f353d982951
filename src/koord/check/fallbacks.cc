#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "koord/check/checker.h"
#include "koord/check/targets.h"
#include "lang/suggest.h"

namespace rondo::koord {

using diag::Kind;

namespace {

// Does a function compute its result from its arguments, parameters and `pid` alone?
class Computes {
 public:
  explicit Computes(const Model& model) : model_(model) {}

  bool Function(size_t index) {
    const koord::Function& f = model_.functions[index];
    if (f.external()) return false;
    if (!seen_.insert(index).second) return true;  // recursion is reported elsewhere
    return Body(f.def->body);
  }

 private:
  bool Body(const std::vector<Stmt>& body) {
    return std::ranges::all_of(body, [&](const Stmt& s) {
      return Expr(s.target) && Expr(s.value) &&
             std::ranges::all_of(s.operands, [&](ExprId e) { return Expr(e); }) && Body(s.body) &&
             Body(s.orelse);
    });
  }
  bool Expr(ExprId id) {
    if (!id.valid()) return true;
    const lang::Expr& e = model_.program->exprs[id];
    const Ref ref = model_.RefOf(id);
    const bool call = e.kind == lang::ExprKind::kCall;
    if (ref.kind == RefKind::kCell || ref.kind == RefKind::kPortOf || ref.kind == RefKind::kOpaqueField)
      return false;
    if (ref.kind == RefKind::kVariable && !call && model_.variables[ref.index].kind != VariableKind::kParam)
      return false;
    if (ref.kind == RefKind::kFunction && call && !Function(ref.index)) return false;
    return std::ranges::all_of(e.args, [&](ExprId arg) { return Expr(arg); }) &&
           std::ranges::all_of(e.binders, [&](const lang::Binder& b) { return Expr(b.domain); });
  }

  const Model& model_;
  std::set<size_t> seen_;
};

}  // namespace

bool Model::FallsBack(size_t variable) const {
  const Variable& v = variables[variable];
  return v.kind == VariableKind::kActuator &&
         std::ranges::any_of(fallbacks, [&](const FallbackDef* def) { return def->module == v.module; });
}

void Checker::CheckFallback(const FallbackDef& def) {
  if (!IsModule(def.module)) {
    auto& report = diagnostics_.Report(Kind::kKoordFallback, def.span,
                                       fmt::format("there is no module `{}`", def.module));
    const std::vector<std::string> known(modules_.begin(), modules_.end());
    if (const std::string near = lang::Suggest(def.module, known); !near.empty())
      report.Help(fmt::format("did you mean `{}`?", near)).Fix(def.span, near);
    return;
  }
  const bool acts = std::ranges::any_of(model_.variables, [&](const Variable& v) {
    return v.module == def.module && v.kind == VariableKind::kActuator;
  });
  if (!acts) {
    diagnostics_.Report(Kind::kKoordFallback, def.span, fmt::format("`{}` has no actuators", def.module))
        .Under("there is nothing to set");
    return;
  }
  const size_t before = diagnostics_.errors();
  place_ = Place::kEvent;
  fallback_ = def.module;
  Body(def.code.body);
  fallback_.clear();
  if (diagnostics_.errors() == before) RestrictFallback(def, def.code.body);
  if (diagnostics_.errors() != before) return;
  const std::set<size_t> set = SetOnEveryPath(def.code.body);
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.kind != VariableKind::kActuator || variable.module != def.module || set.contains(v))
      continue;
    diagnostics_
        .Report(Kind::kKoordFallback, def.span,
                fmt::format("the fallback of `{}` does not always set `{}`", def.module, variable.name))
        .At(variable.span, "declared here")
        .Help("say what every actuator of the module gets, on each path");
  }
}

// The variables that a body assigns as a whole, whatever it decides.
std::set<size_t> Checker::SetOnEveryPath(const std::vector<Stmt>& body) const {
  std::set<size_t> set;
  for (const Stmt& stmt : body) {
    if (stmt.kind == StmtKind::kAssign && model_.RefOf(stmt.target).kind == RefKind::kVariable)
      set.insert(model_.RefOf(stmt.target).index);
    if (stmt.kind != StmtKind::kIf) continue;
    const std::set<size_t> otherwise = SetOnEveryPath(stmt.orelse);
    for (const size_t v : SetOnEveryPath(stmt.body)) {
      if (otherwise.contains(v)) set.insert(v);
    }
  }
  return set;
}

// A fallback has to have values at any moment, without a word from other robots: it writes actuators of its module, and
// reads nothing that others write or that the team agrees on.
void Checker::RestrictFallback(const FallbackDef& def, const std::vector<Stmt>& body) {
  for (const Stmt& stmt : body) {
    const bool plain = stmt.kind == StmtKind::kAssign || stmt.kind == StmtKind::kLocal ||
                       stmt.kind == StmtKind::kIf || stmt.kind == StmtKind::kPass;
    if (!plain) {
      diagnostics_.Report(Kind::kKoordFallback, stmt.span, "a fallback cannot do this")
          .Under("it sets actuators at once: `=`, `if`, local variables");
      continue;
    }
    if (stmt.target.valid()) {
      const Ref ref = model_.RefOf(stmt.target);
      const ExprId root = RootOf(model_, stmt.target);
      const Ref target = model_.RefOf(root);
      const bool local = ref.kind == RefKind::kBinding || target.kind == RefKind::kBinding;
      const bool own = target.kind == RefKind::kVariable &&
                       model_.variables[target.index].kind == VariableKind::kActuator &&
                       model_.variables[target.index].module == def.module;
      if (!own && !local)
        diagnostics_
            .Report(Kind::kKoordFallback, exprs_[stmt.target].span,
                    fmt::format("the fallback of `{}` cannot write this", def.module))
            .Under(fmt::format("only actuators of `{}`", def.module));
      // Items of arrays are chosen by expressions.
      for (ExprId part = stmt.target; part != root; part = exprs_[part].args[0]) {
        for (size_t i = 1; i < exprs_[part].args.size(); ++i) RestrictFallback(def, exprs_[part].args[i]);
      }
    }
    if (stmt.value.valid()) RestrictFallback(def, stmt.value);
    RestrictFallback(def, stmt.body);
    RestrictFallback(def, stmt.orelse);
  }
}

void Checker::RestrictFallback(const FallbackDef& def, ExprId id) {
  const lang::Expr& e = exprs_[id];
  const Ref ref = model_.RefOf(id);
  const auto refuse = [&](std::string why) {
    diagnostics_
        .Report(Kind::kKoordFallback, e.span,
                fmt::format("the fallback of `{}` cannot read this", def.module))
        .Under(std::move(why))
        .Help("it reads the robot's own sensors, parameters and `pid`");
  };
  const bool names =
      e.kind == lang::ExprKind::kName || e.kind == lang::ExprKind::kField || e.kind == lang::ExprKind::kIndex;
  if (names &&
      (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell || ref.kind == RefKind::kPortOf)) {
    const VariableKind kind = model_.variables[ref.index].kind;
    if (ref.kind == RefKind::kPortOf ||
        (kind != VariableKind::kSensor && kind != VariableKind::kParam && kind != VariableKind::kActuator))
      return refuse("who falls back has lost what the team agrees on");
  }
  if (ref.kind == RefKind::kOpaqueField) return refuse("only an external function looks inside");
  if (ref.kind == RefKind::kFunction && e.kind == lang::ExprKind::kCall) {
    const Function& f = model_.functions[ref.index];
    if (f.external()) return refuse("an external function may take long, or give nothing");
    if (!Computes(model_).Function(ref.index))
      return refuse(fmt::format("`{}` needs more than its arguments", f.name));
  }
  for (const ExprId arg : e.args) RestrictFallback(def, arg);
}

}  // namespace rondo::koord
