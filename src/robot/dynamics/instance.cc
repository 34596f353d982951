// Motions with their arguments.
#include <fmt/format.h>

#include "robot/dynamics/motion_problem.h"

namespace rondo::robot {

MotionInstance InstanceOf(const Body& body, const MotionDef& motion, const std::vector<Value>& args,
                          const std::vector<diag::Span>& spans, Evaluator& e) {
  const Arena& arena = e.arena();
  MotionInstance instance;
  const Scope scope = MotionScope(body, motion, args, spans, e);
  instance.motion = &motion;
  std::string list;
  for (const Param& p : motion.params) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", p.name.text);
    instance.arguments.push_back(scope.names.at(p.name.text));
  }
  instance.text = fmt::format("{}({})", motion.name.text, list);
  instance.contract = ContractOf(body, motion, scope, e);
  instance.control = ControlOf(body, motion, scope, e);
  instance.interruptible = motion.interruptible;
  const Value least = e.Evaluate(motion.least, scope);
  instance.known_duration = least.kind == ValueKind::kQuantity && arena.IsNumber(least.terms[0]);
  if (instance.known_duration) instance.least = arena.number(least.terms[0]);
  const lang::Expr& end = e.pool()[motion.most];
  if (end.kind != lang::ExprKind::kName || end.text != "inf") {
    const Value most = e.Evaluate(motion.most, scope);
    if (most.kind == ValueKind::kQuantity && arena.IsNumber(most.terms[0]))
      instance.duration = arena.number(most.terms[0]);
    instance.known_duration = instance.known_duration && instance.duration.has_value();
  }
  return instance;
}

bool StandAlone(const RobotDef& type, Evaluator& e, World& world, const Arguments& given) {
  Arena& arena = e.arena();
  for (const RobotItem& item : type.items) {
    const auto* group = std::get_if<ParamGroup>(&item);
    if (group == nullptr) continue;
    for (const Param& p : group->params) {
      if (!p.value.valid() && !given.contains(p.name.text)) return false;
    }
  }
  world.scope.names.emplace("world", FrameAt(Identity(arena)));
  world.clock = arena.Variable(arena.Declare("clock", {}, arena.Real()));
  world.bodies.resize(1);
  Body& body = world.bodies[0];
  body.name = type.name;
  body.self = Identity(arena);
  body.scope.outer = &world.scope;
  FillBody(type, given, world.clock, body, e);
  return true;
}

std::vector<MotionInstance> MotionsOf(const RobotDef& type, Evaluator& e, World& world,
                                      std::vector<std::string>* left_out) {
  std::vector<MotionInstance> all;
  if (!StandAlone(type, e, world)) {
    if (left_out != nullptr)
      left_out->push_back(fmt::format("{} (a parameter of it has no value)", type.name.text));
    return all;
  }
  Arena& arena = e.arena();
  const Body& body = world.bodies[0];
  for (const RobotItem& item : type.items) {
    const auto* motion = std::get_if<MotionDef>(&item);
    if (motion == nullptr) continue;
    std::vector<Variable> unknowns;
    std::vector<Value> args(motion->params.size());
    std::vector<diag::Span> spans;
    bool known = true;
    for (size_t i = 0; i < args.size(); ++i) {
      const Param& p = motion->params[i];
      spans.push_back(p.name.span);
      if (p.value.valid()) {
        if (e.loose() == nullptr || e.loose()->name != p.name.text) continue;
        const Value own = e.Evaluate(p.value, body.scope);
        if (own.kind != ValueKind::kQuantity) continue;
        const TermId some = arena.FreshConstant(p.name.text, arena.Real());
        args[i] = Quantity(some, own.dimension);
        unknowns.push_back({p.name, own.dimension, some, arena.Number(arena.Real(), e.loose()->least),
                            arena.Number(arena.Real(), e.loose()->most)});
        continue;
      }
      const lang::Dimension* d = lang::FindDimension(p.dimension.text);
      known = known && d != nullptr && p.least.valid() && p.most.valid();
      if (!known) {
        if (left_out != nullptr)
          left_out->push_back(fmt::format("{}.{} (`{}` has neither a value nor a range)", type.name.text,
                                          motion->name.text, p.name.text));
        break;
      }
      const TermId some = arena.Variable(arena.Declare(
          fmt::format("{}.{}.{}", type.name.text, motion->name.text, p.name.text), {}, arena.Real()));
      args[i] = Quantity(some, *d);
      const auto least = e.Measure(p.least, body.scope, *d, "a bound");
      const auto most = e.Measure(p.most, body.scope, *d, "a bound");
      if (!least || !most) return all;
      unknowns.push_back({p.name, *d, some, *least, *most});
    }
    if (!known) continue;
    all.push_back(InstanceOf(body, *motion, args, spans, e));
    all.back().unknowns = std::move(unknowns);
  }
  return all;
}

}  // namespace rondo::robot
