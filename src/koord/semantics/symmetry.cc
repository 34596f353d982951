#include "koord/semantics/symmetry.h"

#include <algorithm>

namespace rondo::koord::semantics {
namespace {

using lang::ExprKind;

class Judge {
 public:
  explicit Judge(const Model& model) : model_(model), exprs_(model.program->exprs) {
    for (const auto& [id, domains] : model.domains) {
      for (size_t b = 0; b < domains.kinds.size(); ++b) {
        if (domains.kinds[b] != DomainKind::kRobots) continue;
        robots_.insert(robots_.end(), domains.bindings[b].begin(), domains.bindings[b].end());
      }
    }
  }

  bool Symmetric(ExprId id) const {
    const lang::Expr& e = exprs_[id];
    const Ref ref = model_.RefOf(id);
    if (IsRobot(id)) return false;  // in a place that no rule below allows
    // The first robot of several is one that others are not; sums of floats are rounded in an order.
    if (e.kind == ExprKind::kFold &&
        (e.text.starts_with("arg") ||
         (e.text == "sum" && !model_.types.Is(model_.TypeOf(id), lang::TypeKind::kInt))))
      return false;
    // A whole row or array has an order.
    const bool name = e.kind == ExprKind::kName || e.kind == ExprKind::kField;
    if (name && ref.kind == RefKind::kVariable && model_.variables[ref.index].kind == VariableKind::kAllread)
      return false;
    if (ref.kind == RefKind::kCell && e.kind == ExprKind::kIndex) return IsRobot(e.args[1]);
    if (ref.kind == RefKind::kStopped) return IsRobot(e.args[1]);
    if (ref.kind == RefKind::kPortOf) return IsRobot(exprs_[e.args[0]].args[1]);
    if (e.kind == ExprKind::kBinary && (e.text == "==" || e.text == "!=") && IsRobot(e.args[0]) &&
        IsRobot(e.args[1]))
      return true;
    if (e.kind == ExprKind::kBinary && (e.text == "in" || e.text == "not in") && IsRobot(e.args[0]) &&
        exprs_[e.args[1]].kind == ExprKind::kName)
      return true;  // i in ID
    for (const lang::Binder& b : e.binders) {
      if (b.domain.valid() && exprs_[b.domain].kind != ExprKind::kName && !Symmetric(b.domain)) return false;
    }
    const bool call = e.kind == ExprKind::kCall;
    return std::all_of(e.args.begin() + (call ? 1 : 0), e.args.end(), [&](ExprId a) { return Symmetric(a); });
  }
  bool Symmetric(const std::vector<Stmt>& body) const {
    return std::all_of(body.begin(), body.end(), [&](const Stmt& s) {
      const auto good = [&](ExprId e) { return !e.valid() || Symmetric(e); };
      return good(s.target) && (s.kind == StmtKind::kCall ? Method(s.value) : good(s.value)) &&
             std::all_of(s.operands.begin(), s.operands.end(), good) && Symmetric(s.body) &&
             Symmetric(s.orelse);
    });
  }

 private:
  bool Method(ExprId id) const {
    const lang::Expr& call = exprs_[id];
    const lang::Expr& callee = exprs_[call.args[0]];
    if (callee.kind == ExprKind::kField && !callee.args.empty() &&
        model_.RefOf(id).kind == RefKind::kBuiltin && !Symmetric(callee.args[0]))
      return false;
    return std::all_of(call.args.begin() + 1, call.args.end(), [&](ExprId a) { return Symmetric(a); });
  }
  bool IsRobot(ExprId id) const {
    const lang::Expr& e = exprs_[id];
    const Ref ref = model_.RefOf(id);
    return e.kind == ExprKind::kPid ||
           (ref.kind == RefKind::kBinding &&
            std::find(robots_.begin(), robots_.end(), ref.index) != robots_.end());
  }

  const Model& model_;
  const lang::ExprPool& exprs_;
  std::vector<uint32_t> robots_;  // bindings that range over robots
};

}  // namespace

bool IsSymmetric(const Model& model) {
  const Judge judge(model);
  const auto good = [&](ExprId e) { return !e.valid() || judge.Symmetric(e); };
  for (const Variable& v : model.variables) {
    if (!good(v.initial)) return false;
  }
  for (const Function& f : model.functions) {
    if (f.def != nullptr && f.def->has_body && !judge.Symmetric(f.def->body)) return false;
  }
  for (const EventDef* e : model.events) {
    if (!good(e->pre) || !judge.Symmetric(e->body)) return false;
  }
  for (const InitDef* i : model.inits) {
    if (!judge.Symmetric(i->body)) return false;
  }
  for (const InvariantDef* i : model.invariants) {
    if (!good(i->body)) return false;
  }
  for (const AssumeDef* a : model.assumptions) {
    if (!good(a->when) || !good(a->body)) return false;
  }
  for (const auto& [_, e] : model.exploration.choices) {
    if (!good(e)) return false;
  }
  for (const auto& [_, entry] : model.exploration.functions) {
    if (!good(entry->body)) return false;
  }
  return true;
}

}  // namespace rondo::koord::semantics
