#include "platform/topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "ros/ackermann_msgs.h"
#include "ros/action_msgs.h"
#include "ros/names.h"
#include "ros/nav_msgs.h"
#include "ros/px4_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/tf2_msgs.h"
#include "ros/trajectory_msgs.h"

namespace rondo::platform {

using sim::BodyPort;
using sim::PortRole;
using sim::PortVia;

std::string NameOf(const koord::Model& model, const sim::Port& port) {
  const koord::Variable& variable = model.variables[port.variable];
  return variable.name.substr(variable.module.size() + 1);
}

const sim::FleetPort* Said(const sim::Fleet& fleet, const std::string& name) {
  const auto said = fleet.ros.ports.find(name);
  return said == fleet.ros.ports.end() ? nullptr : &said->second;
}

std::optional<Carries> AdaptedAs(const koord::Model& model, const sim::Port& port) {
  const lang::TypeTable& types = model.types;
  const lang::TypeId type = model.variables[port.variable].type;
  if (types.Is(type, lang::TypeKind::kFloat)) return Carries::kNumber;
  if (types.Is(type, lang::TypeKind::kBool)) return Carries::kBool;
  if (types.Resolve(type) == types.pos()) return Carries::kPoint;
  return std::nullopt;
}

namespace {

Carries CarriedBy(BodyPort::Kind kind) {
  switch (kind) {
    case BodyPort::Kind::kNumber:
      return Carries::kNumber;
    case BodyPort::Kind::kPoint:
      return Carries::kPoint;
    case BodyPort::Kind::kBool:
      return Carries::kBool;
  }
  return Carries::kNumber;
}

Carries UsuallyCarried(const sim::Port& port, size_t robot) {
  if (const auto& own = port.own[robot]) return CarriedBy(own->kind);
  switch (port.role) {
    case PortRole::kPosition:
    case PortRole::kVelocity:
    case PortRole::kHeading:
      return Carries::kOdometry;
    case PortRole::kReached:
      return Carries::kBool;
    case PortRole::kScans:
      return Carries::kScan;
    case PortRole::kTarget:
      return Carries::kPose;
    case PortRole::kPath:
      return Carries::kPath;
    case PortRole::kOwn:
      break;
  }
  return Carries::kNumber;
}

Carries CarriedBy(const koord::Model& model, const sim::Port& port, size_t robot,
                  const sim::FleetPort* said) {
  const Carries usual = UsuallyCarried(port, robot);
  switch (said == nullptr ? PortVia::kTopic : said->via) {
    case PortVia::kTopic:
      return usual;
    case PortVia::kNav2:
      return port.role == PortRole::kReached ? Carries::kGoalStatus : usual;
    case PortVia::kTwist:
      return said->stamped ? Carries::kTwistStamped : Carries::kTwist;
    case PortVia::kAckermann:
      return Carries::kAckermann;
    case PortVia::kPose:
      return said->with_covariance ? Carries::kCovariance : Carries::kPoseSeen;
    case PortVia::kTransform:
      return Carries::kTransform;
    case PortVia::kJointStates:
      return Carries::kJointState;
    case PortVia::kJointTrajectory:
      return Carries::kJointTrajectory;
    case PortVia::kPx4:
      return sim::IsActuator(model, port) ? Carries::kPx4Setpoint : Carries::kPx4Odometry;
    case PortVia::kAdapter:
      return AdaptedAs(model, port).value_or(usual);
  }
  return usual;
}

std::string UsualName(Carries carries, const std::string& port) {
  switch (carries) {
    case Carries::kOdometry:
      return "odom";
    case Carries::kScan:
      return "scan";
    case Carries::kPose:
      return "goal_pose";
    case Carries::kPath:
      return "path";
    default:
      return port;
  }
}

// Topics of an autopilot lie below a name.
std::string Below(const std::string& topic, Carries carries) {
  if (carries == Carries::kPx4Odometry) return topic + "/out/vehicle_odometry";
  if (carries == Carries::kPx4Setpoint) return topic + "/in/trajectory_setpoint";
  return topic;
}

// The number of an autopilot.
uint8_t SystemOf(const sim::FleetPort& port, size_t robot) {
  return static_cast<uint8_t>(port.system > 0 ? port.system : robot + 1);
}

// The first port that an autopilot has; nullptr: there is none.
const sim::FleetPort* Flown(const sim::Fleet& fleet) {
  const auto flown = std::ranges::find_if(fleet.ros.ports,
                                          [](const auto& port) { return port.second.via == PortVia::kPx4; });
  return flown == fleet.ros.ports.end() ? nullptr : &flown->second;
}

// What drivers usually ask for.
ros::Qos QosOf(Carries carries, bool actuator) {
  if (carries == Carries::kGoalStatus) return ros::kLatched;
  if (carries == Carries::kPx4Odometry || carries == Carries::kPx4Setpoint)
    return {.reliable = false, .depth = 1};
  // Drivers keep where to go for as long as they like.
  return actuator ? ros::Qos{.depth = 1} : ros::kSensorData;
}

}  // namespace

std::optional<Topic> TopicOf(const koord::Model& model, const sim::Fleet& fleet, size_t robot,
                             const sim::Port& port) {
  Topic topic;
  topic.port = NameOf(model, port);
  const sim::FleetPort* said = Said(fleet, topic.port);
  if (port.role == PortRole::kReached && !port.own[robot] && said == nullptr) return std::nullopt;
  topic.carries = CarriedBy(model, port, robot, said);
  topic.max_age = 5 * fleet.delta;
  topic.qos = QosOf(topic.carries, sim::IsActuator(model, port));
  if (said == nullptr) {
    topic.name = ros::FullName(fleet.robots[robot].node_namespace, UsualName(topic.carries, topic.port));
    return topic;
  }
  if (said->max_age > 0) topic.max_age = said->max_age;
  topic.qos.reliable = said->reliable.value_or(topic.qos.reliable);
  topic.qos.transient_local = said->transient_local.value_or(topic.qos.transient_local);
  topic.qos.depth = said->depth.value_or(topic.qos.depth);
  topic.joint = said->joint;
  topic.within = said->within > 0 ? said->within : fleet.delta;
  topic.system = SystemOf(*said, robot);
  topic.options = said->options;
  if (said->via == PortVia::kAdapter) {
    topic.name = topic.library = said->topic;
  } else if (said->via == PortVia::kTransform) {
    topic.name = "/tf";
    topic.frame = ros::FullName(fleet.robots[robot].node_namespace, said->topic);
  } else {
    topic.name = ros::FullName(fleet.robots[robot].node_namespace, Below(said->topic, topic.carries));
  }
  return topic;
}

Topic OdometryOf(const sim::Fleet& fleet, size_t robot) {
  const sim::FleetPort* flown = Flown(fleet);
  Topic topic;
  topic.port = "where it is";
  topic.carries = flown == nullptr ? Carries::kOdometry : Carries::kPx4Odometry;
  topic.max_age = 5 * fleet.delta;
  topic.qos = QosOf(topic.carries, false);
  topic.name =
      ros::FullName(fleet.robots[robot].node_namespace,
                    flown == nullptr ? UsualName(topic.carries, "") : Below(flown->topic, topic.carries));
  return topic;
}

Topic SetpointsOf(const sim::Fleet& fleet, size_t robot) {
  const sim::FleetPort& flown = *Flown(fleet);
  Topic topic;
  topic.port = "where to fly";
  topic.carries = Carries::kPx4Setpoint;
  topic.qos = QosOf(topic.carries, true);
  topic.system = SystemOf(flown, robot);
  topic.name = ros::FullName(fleet.robots[robot].node_namespace, Below(flown.topic, topic.carries));
  return topic;
}

std::string Beside(const std::string& topic, const char* name) {
  return topic.substr(0, topic.rfind('/') + 1) + name;
}

std::vector<std::string> TopicsBeside(const Topic& topic) {
  if (topic.carries == Carries::kPx4Odometry) return {Beside(topic.name, kControlMode)};
  if (topic.carries == Carries::kPx4Setpoint)
    return {Beside(topic.name, kOffboardMode), Beside(topic.name, kVehicleCommand)};
  return {};
}

const ros::Message& TypeOf(Carries carries) {
  switch (carries) {
    case Carries::kOdometry:
      return ros::nav_msgs::Odometry::kMessage;
    case Carries::kScan:
      return ros::sensor_msgs::LaserScan::kMessage;
    case Carries::kPose:
      return ros::geometry_msgs::PoseStamped::kMessage;
    case Carries::kPath:
      return ros::nav_msgs::Path::kMessage;
    case Carries::kBool:
      return ros::std_msgs::Bool::kMessage;
    case Carries::kNumber:
      return ros::std_msgs::Float64::kMessage;
    case Carries::kPoint:
      return ros::geometry_msgs::Point::kMessage;
    case Carries::kTwist:
      return ros::geometry_msgs::Twist::kMessage;
    case Carries::kTwistStamped:
      return ros::geometry_msgs::TwistStamped::kMessage;
    case Carries::kAckermann:
      return ros::ackermann_msgs::AckermannDriveStamped::kMessage;
    case Carries::kGoalStatus:
      return ros::action_msgs::GoalStatusArray::kMessage;
    case Carries::kPoseSeen:
      return ros::geometry_msgs::PoseStamped::kMessage;
    case Carries::kCovariance:
      return ros::geometry_msgs::PoseWithCovarianceStamped::kMessage;
    case Carries::kTransform:
      return ros::tf2_msgs::TFMessage::kMessage;
    case Carries::kJointState:
      return ros::sensor_msgs::JointState::kMessage;
    case Carries::kJointTrajectory:
      return ros::trajectory_msgs::JointTrajectory::kMessage;
    case Carries::kPx4Odometry:
      return ros::px4_msgs::VehicleOdometry::kMessage;
    case Carries::kPx4Setpoint:
      return ros::px4_msgs::TrajectorySetpoint::kMessage;
  }
  return ros::std_msgs::Empty::kMessage;
}

int64_t WallTime() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

ros::builtin_interfaces::Time StampOf(int64_t nanoseconds) {
  ros::builtin_interfaces::Time stamp;
  stamp.sec = static_cast<int32_t>(nanoseconds / 1'000'000'000);
  stamp.nanosec = static_cast<uint32_t>(nanoseconds % 1'000'000'000);
  return stamp;
}

ros::std_msgs::Header HeaderOf(const std::string& frame, int64_t stamp) {
  ros::std_msgs::Header header;
  header.stamp = StampOf(stamp);
  header.frame_id = frame;
  return header;
}

ros::geometry_msgs::Quaternion Turned(double yaw) {
  ros::geometry_msgs::Quaternion q;
  q.z = std::sin(yaw / 2);
  q.w = std::cos(yaw / 2);
  return q;
}

double YawOf(const ros::geometry_msgs::Quaternion& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

}  // namespace rondo::platform
