#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "koord/check/model.h"
#include "sim/fleet/fleet.h"
#include "sim/functions/encoding.h"

/// Connects the ports of programs with simulated bodies.
namespace rondo::sim {

/// Names what a port of a program means to every body. Points are in the world frame, in metres; angles in
/// radians.
enum class PortRole : uint8_t {
  kPosition,  ///< a sensor, a point: where the body is (`psn`, `position`)
  kVelocity,  ///< a sensor, a point: its velocity in m/s (`velocity`)
  kHeading,   ///< a sensor, a float: its heading (`heading`, `yaw`)
  kReached,   ///< a sensor, a bool: it has arrived at the end of its path and stayed there for its dwell time
  kScans,     ///< a sensor, a list of pairs of a position and a scan: those of the last round
  kTarget,    ///< an actuator, a point: where to go
  kPath,      ///< an actuator, a list of points: which way to go
  kOwn,       ///< only what the models of the robots say
};
/// Holds a port of the program and what it means.
struct Port {
  size_t variable;
  PortRole role;
  /// By robot: the port that its model declares, which comes first.
  std::vector<std::optional<BodyPort>> own;
};

/// Returns the ports of the program, by name and type. Reports each one that a robot lacks.
/// @param elsewhere  names of ports that are not those of bodies: no body needs them.
std::vector<Port> FindPorts(const koord::Model& model, const std::vector<FleetRobot>& robots,
                            diag::Diagnostics& diagnostics, const std::set<std::string>& elsewhere = {});

/// Reports whether the program sets that port.
bool IsActuator(const koord::Model& model, const Port& port);

/// Puts what a sensor reads of a body into the words at `at`; scans, which bodies do not have, stay as they are.
void ReadSensor(const Port& port, size_t robot, const Body& body, Word* at);
/// Puts what a port has while a body is at rest into the words at `at`: no scans; actuators that hold it where it is.
void ReadAtRest(const koord::Model& model, const Port& port, size_t robot, const Body& body, Heap& heap,
                Word* at);
/// Commands a body as the words of an actuator say. A path is a new command each time that it is written; a target is
/// one if it is another.
void Obey(const Port& port, size_t robot, const Heap& heap, const Word* at, Body& body);

}  // namespace rondo::sim
