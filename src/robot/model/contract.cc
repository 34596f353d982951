#include <fmt/format.h>

#include <algorithm>

#include "robot/model/body.h"
#include "robot/model/world.h"

namespace rondo::robot {

using diag::Kind;
using lang::Dimension;

namespace {

// Motions of one name must differ in how many arguments they take.
void CheckOverloads(const RobotDef& type, Evaluator& e) {
  std::vector<const MotionDef*> motions;
  const auto needed = [](const MotionDef& m) {
    return std::ranges::count_if(m.params, [](const Param& p) { return !p.value.valid(); });
  };
  for (const RobotItem& item : type.items) {
    const auto* motion = std::get_if<MotionDef>(&item);
    if (motion == nullptr) continue;
    for (const MotionDef* other : motions) {
      if (other->name.text != motion->name.text) continue;
      if (needed(*other) > std::ssize(motion->params) || needed(*motion) > std::ssize(other->params))
        continue;
      e.diagnostics()
          .Report(Kind::kChoreoDuplicate, motion->name.span,
                  fmt::format("a call of `{}` may mean either of two motions", motion->name.text))
          .At(other->name.span, "the other one")
          .Help("motions of one name differ in how many arguments they take");
    }
    motions.push_back(motion);
  }
}

}  // namespace

Scope MotionScope(const Body& body, const MotionDef& motion, const std::vector<Value>& args,
                  const std::vector<diag::Span>& spans, Evaluator& e) {
  Scope scope;
  scope.outer = &body.scope;
  for (size_t i = 0; i < motion.params.size(); ++i) {
    const Param& p = motion.params[i];
    const bool given = args[i].kind != ValueKind::kError;
    Value value = given ? args[i] : p.value.valid() ? e.Evaluate(p.value, scope) : Value{};
    const diag::Span span = given || !p.value.valid() ? spans[i] : e.SpanOf(p.value);
    // A parameter measures what is declared; else what its default measures.
    std::optional<Dimension> wanted;
    if (const Dimension* d = lang::FindDimension(p.dimension.text)) {
      wanted = *d;
    } else if (given && p.value.valid() && p.dimension.text.empty()) {
      const Value usual = e.Evaluate(p.value, scope);
      if (usual.kind == ValueKind::kQuantity && !usual.any_dimension) wanted = usual.dimension;
    }
    if (wanted && value.kind == ValueKind::kQuantity) {
      if (!value.any_dimension && !(value.dimension == *wanted)) {
        value = e.WrongUnit(span, value,
                            fmt::format("{} for `{}`", Describe(Quantity({}, *wanted)), p.name.text));
      } else {
        value = Quantity(value.terms[0], *wanted);
      }
    } else if (wanted && value.kind != ValueKind::kError) {
      value = e.WrongType(span, value, "a quantity");
    } else if (p.dimension.text == "point" && value.kind != ValueKind::kPoint) {
      value = e.WrongType(span, value, "a point of the world");
    }
    // A number outside of the declared values.
    const auto bound = [&](ExprId limit) -> std::optional<TermId> {
      if (!limit.valid() || value.kind != ValueKind::kQuantity) return std::nullopt;
      return e.Measure(limit, scope, value.dimension, "a bound");
    };
    const auto least = bound(p.least);
    const auto most = bound(p.most);
    Arena& arena = e.arena();
    if ((least && arena.Le(*least, value.terms[0]) == arena.False()) ||
        (most && arena.Le(value.terms[0], *most) == arena.False())) {
      e.diagnostics()
          .Report(Kind::kRobotRange, span,
                  fmt::format("`{}` is not for this value of `{}`", motion.name.text, p.name.text))
          .At(p.name.span, "its values are declared here");
    }
    scope.names.emplace(p.name.text, std::move(value));
  }
  return scope;
}

Contract ContractOf(const Body& body, const MotionDef& motion, const Scope& scope, Evaluator& e) {
  Arena& arena = e.arena();
  std::vector<TermId> pre, assume, during, post;
  Contract contract;
  contract.footprint = body.body;
  contract.modifies.resize(body.states.size());
  Scope begins{&scope, {}};  // no time has passed
  begins.names.emplace("clock", Quantity(arena.Number(arena.Real(), expr::Rational(0)), kTime));
  for (const Clause& clause : motion.clauses) {
    const std::string& word = clause.keyword.text;
    if (word == "footprint") {
      if (auto shape = e.ShapeAt(clause.value, scope, "a shape")) contract.footprint = std::move(shape);
      continue;
    }
    for (const Name& name : clause.names) {
      size_t i = 0;
      while (i < body.states.size() && body.states[i].name.text != name.text) ++i;
      if (i < body.states.size()) {
        contract.modifies[i] = true;
      } else {
        e.diagnostics().Report(Kind::kChoreoUndeclared, name.span,
                               fmt::format("`{}` has no state `{}`", body.type->name.text, name.text));
      }
    }
    if (!clause.value.valid()) continue;
    const TermId formula = e.Formula(clause.value, word == "pre" ? begins : scope, "a formula");
    (word == "pre" ? pre : word == "assume" ? assume : word == "during" ? during : post).push_back(formula);
  }
  contract.pre = arena.And(pre);
  contract.assume = arena.And(assume);
  contract.during = arena.And(during);
  contract.post = arena.And(post);
  return contract;
}

std::optional<Control> ControlOf(const Body& body, const MotionDef& motion, const Scope& scope,
                                 Evaluator& e) {
  if (motion.controls.empty()) return body.control;
  return ReadControl(body, motion.controls[0], scope, e);
}

void CheckRobot(const RobotDef& type, Evaluator& e) {
  Arena& arena = e.arena();
  World world;
  world.scope.names.emplace("world", FrameAt(Identity(arena)));
  const TermId clock = arena.Variable(arena.Declare("clock", {}, arena.Real()));
  Body body;
  body.name = type.name;
  body.self = Identity(arena);
  body.scope.outer = &world.scope;
  Arguments given;
  // Parameters without a default are some number.
  for (const RobotItem& item : type.items) {
    const auto* group = std::get_if<ParamGroup>(&item);
    if (group == nullptr) continue;
    for (const Param& p : group->params) {
      if (p.value.valid()) continue;
      const Dimension* d = lang::FindDimension(p.dimension.text);
      Value some = d == nullptr ? Value{} : Quantity(arena.FreshConstant(p.name.text, arena.Real()), *d);
      given.emplace(p.name.text, std::pair(std::move(some), p.name.span));
    }
  }
  FillBody(type, given, clock, body, e);
  CheckOverloads(type, e);
  for (const RobotItem& item : type.items) {
    const auto* motion = std::get_if<MotionDef>(&item);
    if (motion == nullptr) continue;
    std::vector<Value> args(motion->params.size());
    std::vector<diag::Span> spans;
    for (size_t i = 0; i < args.size(); ++i) {
      const Param& p = motion->params[i];
      spans.push_back(p.name.span);
      if (p.value.valid()) continue;
      const auto fresh = [&] { return arena.FreshConstant(p.name.text, arena.Real()); };
      if (const Dimension* d = lang::FindDimension(p.dimension.text)) {
        args[i] = Quantity(fresh(), *d);
      } else if (p.dimension.text == "point") {
        args[i] = PointAt({fresh(), fresh(), fresh()});
      } else if (!p.dimension.text.empty()) {
        e.diagnostics()
            .Report(Kind::kChoreoUndeclared, p.dimension.span,
                    fmt::format("there is no dimension `{}`", p.dimension.text))
            .Help(
                "one of `length`, `angle`, `time`, `speed`, `acceleration`, `angular_speed`, `number`, `point`");
      }
    }
    const Scope scope = MotionScope(body, *motion, args, spans, e);
    ContractOf(body, *motion, scope, e);
    ControlOf(body, *motion, scope, e);
    if (motion->controls.size() > 1) {
      e.diagnostics().Report(Kind::kChoreoDuplicate, motion->controls[1].span,
                             fmt::format("`{}` has two controllers", motion->name.text));
    }
  }
}

}  // namespace rondo::robot
