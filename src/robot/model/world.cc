#include "robot/model/world.h"

#include <fmt/format.h>

#include "lang/suggest.h"
#include "robot/model/body.h"

namespace rondo::robot {

using diag::Kind;

namespace {

class Builder {
 public:
  Builder(const WorldDef& source, const RobotTypes& types, Evaluator& evaluator)
      : source_(source), types_(types), e_(evaluator), arena_(evaluator.arena()) {}

  std::unique_ptr<World> Run() {
    world_->source = &source_;
    world_->clock = arena_.Variable(arena_.Declare("clock", {}, arena_.Real()));
    world_->scope.names.emplace("world", FrameAt(Identity(arena_)));
    for (const EnvironmentDef& e : source_.environments) Environment(e);
    world_->bodies.resize(source_.components.size());
    std::map<std::string, size_t, std::less<>> index;
    for (size_t i = 0; i < source_.components.size(); ++i) {
      const Name& name = source_.components[i].name;
      if (!index.emplace(name.text, i).second || world_->scope.names.contains(name.text)) Duplicate(name);
    }
    std::vector<bool> built(source_.components.size());
    // Who carries others comes before them; what is left stands on itself.
    for (bool progress = true; progress;) {
      progress = false;
      for (size_t i = 0; i < built.size(); ++i) {
        const Component& c = source_.components[i];
        const auto parent = c.parent.text.empty() ? index.end() : index.find(c.parent.text);
        if (built[i] || (parent != index.end() && !built[parent->second])) continue;
        Put(i, parent == index.end() ? std::nullopt : std::optional(parent->second));
        built[i] = progress = true;
      }
    }
    for (size_t i = 0; i < built.size(); ++i) {
      if (built[i]) continue;
      const Component& c = source_.components[i];
      e_.diagnostics()
          .Report(Kind::kRobotMount, c.parent.span,
                  fmt::format("nothing carries `{}` in the end", c.name.text))
          .Note("robots that stand on each other in a circle stand nowhere");
      Put(i, i);
    }
    for (const ObstacleDef& o : source_.obstacles) {
      auto shape = e_.ShapeAt(o.shape, world_->scope, "a shape");
      if (!shape) continue;
      if (!IsConstant(arena_, *shape)) Moves(e_.SpanOf(o.shape), "an obstacle stands still");
      world_->obstacles.push_back({o.name, std::move(*shape)});
    }
    const auto coordinate = [&](const char* name) {
      return arena_.Variable(arena_.Declare(fmt::format("world.{}", name), {}, arena_.Real()));
    };
    world_->point = {coordinate("x"), coordinate("y"), coordinate("z")};
    world_->point_scope.outer = &world_->scope;
    world_->point_scope.names = {{"x", Quantity(world_->point[0], kLength)},
                                 {"y", Quantity(world_->point[1], kLength)},
                                 {"z", Quantity(world_->point[2], kLength)},
                                 {"here", PointAt(world_->point)}};
    return std::move(world_);
  }

 private:
  void Duplicate(const Name& name) {
    e_.diagnostics().Report(Kind::kChoreoDuplicate, name.span,
                            fmt::format("`{}` is declared twice", name.text));
  }

  void Environment(const EnvironmentDef& def) {
    Members members;
    for (const StateGroup& group : def.outputs) {
      for (Variable& v : DeclareVariables(group, def.name.text, world_->scope, e_)) {
        if (!members.emplace(v.name.text, Quantity(v.term, v.dimension)).second) Duplicate(v.name);
        world_->environment.push_back(std::move(v));
      }
    }
    Value value;
    value.kind = ValueKind::kComponent;
    value.members = std::make_shared<const Members>(std::move(members));
    if (!world_->scope.names.emplace(def.name.text, std::move(value)).second) Duplicate(def.name);
  }

  void Put(size_t i, std::optional<size_t> parent) {
    const Component& c = source_.components[i];
    const auto type = types_.find(c.type.text);
    Body& body = world_->bodies[i];
    body.name = c.name;
    body.scope.outer = &world_->scope;
    body.self = Identity(arena_);
    if (!c.parent.text.empty()) {
      Mount(c, parent, body);
    } else if (c.place.valid()) {
      if (auto pose = e_.Place(c.place, world_->scope, body.self)) body.self = *pose;
      if (!IsConstant(arena_, body.self))
        Moves(e_.SpanOf(c.place), "what is put somewhere in the world stands still there");
    }
    if (type == types_.end()) {
      std::vector<std::string> names;
      for (const auto& [known, def] : types_) names.push_back(known);
      auto& report = e_.diagnostics().Report(Kind::kChoreoUndeclared, c.type.span,
                                             fmt::format("there is no robot type `{}`", c.type.text));
      if (const std::string near = lang::Suggest(c.type.text, names); !near.empty())
        report.Help(fmt::format("did you mean `{}`?", near)).Fix(c.type.span, near);
    } else {
      Arguments given;
      for (const Argument& a : c.args) Given(a, *type->second, given);
      FillBody(*type->second, given, world_->clock, body, e_);
    }
    world_->scope.names[c.name.text] = SeenFromOutside(body);
  }

  void Moves(diag::Span span, std::string message) {
    e_.diagnostics()
        .Report(Kind::kRobotType, span, std::move(message))
        .Note("this depends on the state of a robot")
        .Help("a robot that is carried by another one stands on a mount: `on cart.top`");
  }

  void Given(const Argument& a, const RobotDef& type, Arguments& given) {
    if (a.name.text.empty()) {
      e_.diagnostics().Report(Kind::kChoreoArity, e_.SpanOf(a.value),
                              "parameters of a robot are given by name");
      return;
    }
    if (!HasParameter(type, a.name.text)) {
      e_.diagnostics().Report(
          Kind::kChoreoUndeclared, a.name.span,
          fmt::format("`{}` has no parameter and no input `{}`", type.name.text, a.name.text));
      return;
    }
    Value v = e_.Evaluate(a.value, world_->scope);
    if (!given.emplace(a.name.text, std::pair(std::move(v), e_.SpanOf(a.value))).second)
      e_.diagnostics().Report(Kind::kChoreoArity, a.name.span,
                              fmt::format("`{}` is given twice", a.name.text));
  }

  void Mount(const Component& c, std::optional<size_t> parent, Body& body) {
    if (!parent) {
      std::vector<std::string> names;
      for (const Component& other : source_.components) names.push_back(other.name.text);
      auto& report = e_.diagnostics().Report(Kind::kChoreoUndeclared, c.parent.span,
                                             fmt::format("there is no robot `{}`", c.parent.text));
      if (const std::string near = lang::Suggest(c.parent.text, names); !near.empty())
        report.Help(fmt::format("did you mean `{}`?", near)).Fix(c.parent.span, near);
      return;
    }
    if (&world_->bodies[*parent] == &body) return;  // said already
    const Body& carrier = world_->bodies[*parent];
    body.parent = parent;
    const auto mount = carrier.mounts.find(c.mount.text);
    if (mount != carrier.mounts.end()) {
      body.self = mount->second;
      return;
    }
    if (carrier.type == nullptr) return;
    auto& report = e_.diagnostics().Report(
        Kind::kRobotMount, c.mount.span, fmt::format("`{}` has no mount `{}`", c.parent.text, c.mount.text));
    std::string names;
    for (const auto& [name, pose] : carrier.mounts)
      names += fmt::format("{}`{}`", names.empty() ? "" : ", ", name);
    report.Note(names.empty() ? "it has no mounts at all" : fmt::format("its mounts: {}", names));
  }

  const WorldDef& source_;
  const RobotTypes& types_;
  Evaluator& e_;
  Arena& arena_;
  std::unique_ptr<World> world_ = std::make_unique<World>();
};

}  // namespace

std::unique_ptr<World> BuildWorld(const WorldDef& source, const RobotTypes& types, Evaluator& evaluator) {
  return Builder(source, types, evaluator).Run();
}

}  // namespace rondo::robot
