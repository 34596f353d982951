#pragma once

#include <map>
#include <optional>
#include <string>

#include "dds/network.h"
#include "sim/fleet/tables.h"

/// What fleet files say about robots that are reached over ROS 2.
namespace rondo::sim {

/// Names what a port of the program is connected with.
enum class PortVia : uint8_t {
  kTopic,            ///< `ros2`: a topic with the value of the port itself
  kNav2,             ///< `nav2`: where to go, as Nav2 takes it; `reached`: the status of its action
  kTwist,            ///< `cmd_vel`: velocities; the controller of the model is in the robot's node
  kAckermann,        ///< `ackermann`: a speed and an angle of steering; the same
  kPose,             ///< `pose`: where the robot is, by a pose
  kTransform,        ///< `tf`: where the robot is, by transforms
  kJointStates,      ///< `joint_states`: the position of one joint
  kJointTrajectory,  ///< `joint_trajectory`: where one joint is to be; ports with one topic are sent together
  kPx4,              ///< `px4`: topics of an autopilot, and in front of them this
  kAdapter,          ///< `adapter`: a library of the user
};

/// Says on which topic a port of the program is.
struct FleetPort {
  PortVia via = PortVia::kTopic;
  bool stamped = false;          ///< of kTwist: TwistStamped
  bool with_covariance = false;  ///< of kPose: PoseWithCovarianceStamped
  std::string
      topic;  ///< in the namespace of the robot, unless it begins with `/`; of kAdapter the file of the library; of kTransform a frame
  std::string joint;  ///< of kJointStates and kJointTrajectory
  double within = 0;  ///< of kJointTrajectory: seconds until it is to be there; 0: one round
  int system =
      0;  ///< of kPx4: the number of the autopilot (MAV_SYS_ID); 0: counted from 1 in the order of robots
  std::string options;  ///< of kAdapter: what it is told
  double max_age = 0;   ///< seconds after which what was read last is stale; 0: five rounds
  std::optional<bool> reliable, transient_local;  ///< else as usual for what it carries
  std::optional<uint32_t> depth;
  diag::Span span;
};

/// Says how robots are reached over ROS 2.
struct FleetRos {
  dds::Network network;
  std::string frame = "map";  ///< in which the program's points are
  bool use_sim_time = false;  ///< time is what `/clock` says
  std::string keys;  ///< the folder of the keys, as the fleet file says it; empty: there is no security
  std::map<std::string, FleetPort> ports;  ///< by the name of the port; others are on their usual topics
};

/// Reads `[ros]` and `[ports]`. Whatever is wrong is reported.
FleetRos ReadRos(Tables& tables, const toml::table& root);

}  // namespace rondo::sim
