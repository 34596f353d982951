#include "koord/check/mentions_robot.h"

#include <algorithm>

namespace rondo::koord {

bool RobotMentions::In(ExprId id) {
  if (!id.valid()) return false;
  const lang::Expr& e = model_.program->exprs[id];
  const Ref ref = model_.RefOf(id);
  const bool call = e.kind == lang::ExprKind::kCall;
  if (e.kind == lang::ExprKind::kPid) return true;
  if (ref.kind == RefKind::kVariable && !call) {
    const VariableKind kind = model_.variables[ref.index].kind;
    if (kind == VariableKind::kLocal || kind == VariableKind::kSensor || kind == VariableKind::kActuator)
      return true;
  }
  if (ref.kind == RefKind::kFunction && call && InFunction(ref.index)) return true;
  return std::any_of(e.args.begin(), e.args.end(), [this](ExprId a) { return In(a); });
}

bool RobotMentions::In(const std::vector<Stmt>& body) {
  return std::any_of(body.begin(), body.end(), [this](const Stmt& s) {
    return In(s.value) || In(s.target) ||
           std::any_of(s.operands.begin(), s.operands.end(), [this](ExprId e) { return In(e); }) ||
           In(s.body) || In(s.orelse);
  });
}

bool RobotMentions::InFunction(size_t function) {
  const Function& f = model_.functions[function];
  if (f.port >= 0) return true;
  if (f.external() || !looking_at_.insert(function).second) return false;
  const bool mentions = In(f.def->body);
  looking_at_.erase(function);
  return mentions;
}

}  // namespace rondo::koord
