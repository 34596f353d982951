#pragma once

#include <vector>

#include "diag/diagnostic.h"
#include "koord/check/model.h"

/// Connects the ports of programs with simulated bodies.
namespace rondo::sim {

/// Names what a port of a program means to a simulated body. Points are in the world frame, in metres; angles
/// in radians.
enum class PortRole : uint8_t {
  kPosition,  ///< a sensor, a point: where the body is (`psn`, `position`)
  kVelocity,  ///< a sensor, a point: its velocity in m/s (`velocity`)
  kHeading,   ///< a sensor, a float: its heading (`heading`, `yaw`)
  kReached,   ///< a sensor, a bool: it has arrived at the end of its path and stayed there for its dwell time
  kScans,     ///< a sensor, a list of pairs of a position and a scan: those of the last round
  kTarget,    ///< an actuator, a point: where to go
  kPath,      ///< an actuator, a list of points: which way to go
};
/// Holds a port of the program and what it means.
struct Port {
  size_t variable;
  PortRole role;
};

/// Returns the ports of the program, by name and type. Reports each one that no body has.
std::vector<Port> FindPorts(const koord::Model& model, diag::Diagnostics& diagnostics);

}  // namespace rondo::sim
