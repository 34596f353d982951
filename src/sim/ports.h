#pragma once

#include <vector>

#include "diag/diagnostic.h"
#include "koord/check/model.h"

namespace rondo::sim {

/// What a port of a program means to a simulated body.
enum class PortRole : uint8_t {
  kPosition,  ///< sensor of a point: `psn`, `position`
  kVelocity,  ///< sensor of a point: `velocity`
  kHeading,   ///< sensor, float: `heading`, `yaw`
  kReached,   ///< sensor, bool
  kScans,     ///< sensor, list of pairs of a position and a scan: those of the last round
  kTarget,    ///< actuator, a point
  kPath,      ///< actuator, a list of points
};
struct Port {
  size_t variable;
  PortRole role;
};

/// The ports of the program, by name and type. One that no body has is reported.
std::vector<Port> FindPorts(const koord::Model& model, diag::Diagnostics& diagnostics);

}  // namespace rondo::sim
