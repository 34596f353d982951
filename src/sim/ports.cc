#include "sim/ports.h"

#include <fmt/format.h>

namespace rondo::sim {

using koord::VariableKind;
using lang::TypeKind;

std::vector<Port> FindPorts(const koord::Model& model, diag::Diagnostics& diagnostics) {
  std::vector<Port> ports;
  const auto& types = model.types;
  for (size_t v = 0; v < model.variables.size(); ++v) {
    const koord::Variable& variable = model.variables[v];
    const bool sensor = variable.kind == VariableKind::kSensor;
    if ((!sensor && variable.kind != VariableKind::kActuator) || variable.function >= 0) continue;
    if (types.Is(variable.type, TypeKind::kStream)) continue;
    const std::string name = variable.name.substr(variable.module.size() + 1);
    const bool point = types.Resolve(variable.type) == types.pos();
    const bool list = types.Is(variable.type, TypeKind::kList);
    const lang::TypeId item = list ? types[variable.type].parts[0] : variable.type;
    if (sensor && point && (name == "psn" || name == "position" || name == "pos")) {
      ports.push_back({v, PortRole::kPosition});
    } else if (sensor && point && name == "velocity") {
      ports.push_back({v, PortRole::kVelocity});
    } else if (sensor && types.Is(variable.type, TypeKind::kFloat) && (name == "heading" || name == "yaw")) {
      ports.push_back({v, PortRole::kHeading});
    } else if (sensor && types.Is(variable.type, TypeKind::kBool) && name == "reached") {
      ports.push_back({v, PortRole::kReached});
    } else if (sensor && list && name == "pscan" && types.Is(item, TypeKind::kTuple) &&
               types[item].parts.size() == 2 && types.Resolve(types[item].parts[0]) == types.pos()) {
      ports.push_back({v, PortRole::kScans});
    } else if (!sensor && point && name == "target") {
      ports.push_back({v, PortRole::kTarget});
    } else if (!sensor && list && types.Resolve(item) == types.pos() && name == "path") {
      ports.push_back({v, PortRole::kPath});
    } else {
      diagnostics
          .Report(diag::Kind::kKoordNotExecutable, variable.span,
                  fmt::format("no simulated robot has a port `{}` of type `{}`", variable.name,
                              types.Name(variable.type)))
          .Help(
              sensor
                  ? "sensors: `pos psn`, `pos velocity`, `float heading`, `bool reached`, `List<pos, Scan> pscan`"
                  : "actuators: `pos target`, `List<pos> path`");
    }
  }
  return ports;
}

}  // namespace rondo::sim
