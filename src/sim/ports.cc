#include "sim/ports.h"

#include <fmt/format.h>

#include <map>

namespace rondo::sim {

using koord::VariableKind;
using koord::semantics::FromFloat;
using lang::TypeKind;

namespace {

// What a port of this name and type means to every body.
PortRole RoleOf(const lang::TypeTable& types, const std::string& name, lang::TypeId type, bool sensor) {
  const auto is_point = [&](lang::TypeId t) { return types.Resolve(t) == types.pos(); };
  const bool list = types.Is(type, TypeKind::kList);
  const lang::TypeId item = list ? types[type].parts[0] : type;
  if (!sensor) {
    if (is_point(type) && name == "target") return PortRole::kTarget;
    return list && is_point(item) && name == "path" ? PortRole::kPath : PortRole::kOwn;
  }
  if (is_point(type) && (name == "psn" || name == "position" || name == "pos")) return PortRole::kPosition;
  if (is_point(type) && name == "velocity") return PortRole::kVelocity;
  if (types.Is(type, TypeKind::kFloat) && (name == "heading" || name == "yaw")) return PortRole::kHeading;
  if (types.Is(type, TypeKind::kBool) && name == "reached") return PortRole::kReached;
  const bool scans = list && name == "pscan" && types.Is(item, TypeKind::kTuple) &&
                     types[item].parts.size() == 2 && is_point(types[item].parts[0]);
  return scans ? PortRole::kScans : PortRole::kOwn;
}

// Can the program read or set that port of a body?
bool Fits(const lang::TypeTable& types, lang::TypeId type, const BodyPort& port, bool sensor) {
  if (!sensor && !port.settable) return false;
  switch (port.kind) {
    case BodyPort::Kind::kPoint:
      return types.Resolve(type) == types.pos();
    case BodyPort::Kind::kNumber:
      return types.Is(type, TypeKind::kFloat);
    case BodyPort::Kind::kBool:
      return types.Is(type, TypeKind::kBool);
  }
  return false;
}

std::string Describe(const BodyPort& port) {
  const char* what = port.kind == BodyPort::Kind::kPoint    ? "a `pos`"
                     : port.kind == BodyPort::Kind::kNumber ? "a `float`"
                                                            : "a `bool`";
  return fmt::format("{} that can {}", what, port.settable ? "be read and set" : "only be read");
}

class Finder {
 public:
  Finder(const koord::Model& model, const std::vector<FleetRobot>& robots, diag::Diagnostics& diagnostics,
         const std::set<std::string>& elsewhere)
      : model_(model), robots_(robots), diagnostics_(diagnostics), elsewhere_(elsewhere) {
    // Robots of one kind have the same ports.
    for (const FleetRobot& robot : robots) {
      auto& body = bodies_[robot.from + "\n" + robot.model];
      if (body == nullptr) body = robot.make();
      of_robot_.push_back(body.get());
    }
  }

  std::vector<Port> Run() {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const koord::Variable& variable = model_.variables[v];
      const bool sensor = variable.kind == VariableKind::kSensor;
      if ((sensor || variable.kind == VariableKind::kActuator) && variable.function < 0 &&
          !model_.types.Is(variable.type, TypeKind::kStream))
        Find(v, sensor);
    }
    return std::move(ports_);
  }

 private:
  void Find(size_t v, bool sensor) {
    const koord::Variable& variable = model_.variables[v];
    const std::string name = variable.name.substr(variable.module.size() + 1);
    Port port{v, RoleOf(model_.types, name, variable.type, sensor), {}};
    if (elsewhere_.contains(name)) {
      port.own.resize(robots_.size());
      ports_.push_back(std::move(port));
      return;
    }
    for (size_t r = 0; r < robots_.size(); ++r) {
      const FleetRobot& robot = robots_[r];
      auto own = of_robot_[r]->FindPort(name);
      // Who has a port for targets goes through waypoints, like every body.
      const bool goes = port.role == PortRole::kTarget || port.role == PortRole::kPath;
      if (goes) own.reset();
      const bool can_go = robot.from.empty() || of_robot_[r]->FindPort("target");
      if (own && !Fits(model_.types, variable.type, *own, sensor))
        return Lacks(variable, robot)
                   .Note(fmt::format("`{}` has one of this name: {}", robot.model, Describe(*own))),
               void();
      if (!own && (port.role == PortRole::kOwn || (goes && !can_go)))
        return Help(Lacks(variable, robot), robot, sensor);
      port.own.push_back(own);
    }
    ports_.push_back(std::move(port));
  }

  diag::Diagnostic& Lacks(const koord::Variable& variable, const FleetRobot& robot) {
    return diagnostics_.Report(diag::Kind::kKoordNotExecutable, variable.span,
                               fmt::format("robot `{}` has no port `{}` of type `{}`", robot.name,
                                           variable.name, model_.types.Name(variable.type)));
  }

  static void Help(diag::Diagnostic& report, const FleetRobot& robot, bool sensor) {
    if (!robot.from.empty()) {
      report.Help(fmt::format("declare it in the robot type `{}` of `{}`: `port NAME = ...`{}", robot.model,
                              robot.from, sensor ? "" : ", an input that its controller does not set"));
      return;
    }
    report.Help(
        sensor
            ? "sensors: `pos psn`, `pos velocity`, `float heading`, `bool reached`, `List<pos, Scan> pscan`; "
              "robot types of `.rondo` files have others"
            : "actuators: `pos target`, `List<pos> path`; robot types of `.rondo` files have others");
  }

  const koord::Model& model_;
  const std::vector<FleetRobot>& robots_;
  diag::Diagnostics& diagnostics_;
  const std::set<std::string>& elsewhere_;
  std::map<std::string, std::unique_ptr<Body>> bodies_;
  std::vector<const Body*> of_robot_;
  std::vector<Port> ports_;
};

}  // namespace

bool IsActuator(const koord::Model& model, const Port& port) {
  return model.variables[port.variable].kind == VariableKind::kActuator;
}

void ReadSensor(const Port& port, size_t robot, const Body& body, Word* at) {
  if (const auto& own = port.own[robot]) {
    std::array<double, 3> values{};
    const bool point = own->kind == BodyPort::Kind::kPoint;
    body.ReadPort(*own, std::span(values).first(point ? 3 : 1));
    if (point) return WritePoint(values, at);
    *at = own->kind == BodyPort::Kind::kBool ? static_cast<Word>(values[0] != 0) : FromFloat(values[0] + 0.0);
    return;
  }
  switch (port.role) {
    case PortRole::kPosition:
      return WritePoint(body.position(), at);
    case PortRole::kVelocity:
      return WritePoint(body.velocity(), at);
    case PortRole::kHeading:
      *at = FromFloat(body.yaw() + 0.0);
      return;
    case PortRole::kReached:
      *at = static_cast<Word>(body.reached());
      return;
    case PortRole::kScans:
    case PortRole::kTarget:
    case PortRole::kPath:
    case PortRole::kOwn:
      return;
  }
}

void ReadAtRest(const koord::Model& model, const Port& port, size_t robot, const Body& body, Heap& heap,
                Word* at) {
  if (port.role == PortRole::kScans) {
    *at = heap.Intern(std::vector<Word>());
  } else if (port.own[robot] || !IsActuator(model, port)) {
    ReadSensor(port, robot, body, at);
  } else if (port.role == PortRole::kPath) {
    *at = EncodePath(heap, {body.position()});
  } else if (port.role == PortRole::kTarget) {
    WritePoint(body.position(), at);
  }
}

void Obey(const Port& port, size_t robot, const Heap& heap, const Word* at, Body& body) {
  if (const auto& own = port.own[robot]) {
    std::array<double, 3> values{};
    const size_t parts = own->kind == BodyPort::Kind::kPoint ? 3 : 1;
    for (size_t i = 0; i < parts; ++i) values[i] = koord::semantics::ToFloat(at[i]);
    body.WritePort(*own, std::span(values).first(parts));
  } else if (port.role == PortRole::kPath) {
    body.Follow(DecodePath(heap, *at));
  } else if (const Point target = ReadPoint(at); body.path() != std::vector<Point>{target}) {
    body.Follow({target});
  }
}

std::vector<Port> FindPorts(const koord::Model& model, const std::vector<FleetRobot>& robots,
                            diag::Diagnostics& diagnostics, const std::set<std::string>& elsewhere) {
  return Finder(model, robots, diagnostics, elsewhere).Run();
}

}  // namespace rondo::sim
