#pragma once

#include <map>
#include <string>

#include "dds/network.h"
#include "sim/fleet/tables.h"

/// What fleet files say about robots that are reached over ROS 2.
namespace rondo::sim {

/// Names what a port of the program is connected with.
enum class PortVia : uint8_t {
  kTopic,      ///< a topic with the value of the port itself
  kTwist,      ///< a topic with velocities (`cmd_vel`): the controller of the model is in the robot's node
  kAckermann,  ///< a topic with a speed and an angle of steering; the same
};

/// Says on which topic a port of the program is.
struct FleetPort {
  PortVia via = PortVia::kTopic;
  bool stamped = false;  ///< of kTwist: TwistStamped
  std::string topic;     ///< in the namespace of the robot, unless it begins with `/`
  double max_age = 0;    ///< seconds after which what was read last is stale; 0: five rounds
  diag::Span span;
};

/// Says how robots are reached over ROS 2.
struct FleetRos {
  dds::Network network;
  std::string frame = "map";               ///< in which the program's points are
  std::map<std::string, FleetPort> ports;  ///< by the name of the port; others are on their usual topics
};

/// Reads `[ros]` and `[ports]`. Whatever is wrong is reported.
FleetRos ReadRos(Tables& tables, const toml::table& root);

}  // namespace rondo::sim
