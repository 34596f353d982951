#include "platform/topics.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "lang/suggest.h"
#include "ros/ackermann_msgs.h"
#include "ros/names.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"

namespace rondo::platform {

using sim::BodyPort;
using sim::PortRole;

namespace {

Carries CarriedBy(const sim::Port& port, size_t robot) {
  if (const auto& own = port.own[robot]) {
    switch (own->kind) {
      case BodyPort::Kind::kNumber:
        return Carries::kNumber;
      case BodyPort::Kind::kPoint:
        return Carries::kPoint;
      case BodyPort::Kind::kBool:
        return Carries::kBool;
    }
  }
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
    case Carries::kBool:
    case Carries::kNumber:
    case Carries::kPoint:
    case Carries::kTwist:
    case Carries::kTwistStamped:
    case Carries::kAckermann:
      break;
  }
  return port;
}

}  // namespace

std::optional<Topic> TopicOf(const koord::Model& model, const sim::Fleet& fleet, size_t robot,
                             const sim::Port& port) {
  const koord::Variable& variable = model.variables[port.variable];
  Topic topic;
  topic.port = variable.name.substr(variable.module.size() + 1);
  topic.carries = CarriedBy(port, robot);
  const auto said = fleet.ros.ports.find(topic.port);
  const bool named = said != fleet.ros.ports.end();
  if (named && said->second.via == sim::PortVia::kTwist)
    topic.carries = said->second.stamped ? Carries::kTwistStamped : Carries::kTwist;
  if (named && said->second.via == sim::PortVia::kAckermann) topic.carries = Carries::kAckermann;
  if (port.role == PortRole::kReached && !port.own[robot] && !named) return std::nullopt;
  topic.name = ros::FullName(fleet.robots[robot].node_namespace,
                             named ? said->second.topic : UsualName(topic.carries, topic.port));
  topic.max_age = named && said->second.max_age > 0 ? said->second.max_age : 5 * fleet.delta;
  return topic;
}

void CheckPorts(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
                diag::Diagnostics& diagnostics) {
  std::set<std::string> known;
  for (const sim::Port& port : ports) {
    for (size_t r = 0; r < fleet.robots.size(); ++r) {
      const koord::Variable& variable = model.variables[port.variable];
      const std::string name = variable.name.substr(variable.module.size() + 1);
      known.insert(name);
      const auto said = fleet.ros.ports.find(name);
      if (said == fleet.ros.ports.end() || said->second.via == sim::PortVia::kTopic) continue;
      const bool goes = port.role == PortRole::kTarget || port.role == PortRole::kPath;
      const auto body = fleet.robots[r].make();
      body->Place(fleet.robots[r].position, fleet.robots[r].yaw);
      const bool steers = said->second.via == sim::PortVia::kAckermann;
      if (goes && body->Told() && (!steers || fleet.robots[r].model == "car")) continue;
      auto& report = diagnostics.Report(
          diag::Kind::kFleetValue, said->second.span,
          !goes ? fmt::format("`{}` does not say where to go, so it cannot be made of velocities", name)
                : fmt::format("`{}` is a `{}`, which is not driven by {}", fleet.robots[r].name,
                              fleet.robots[r].model,
                              steers ? "an angle of steering" : "velocities in the plane"));
      report.Help("name a topic for it: `{ ros2 = \"goal_pose\" }`");
      break;
    }
  }
  // A topic of two robots would be read, or obeyed, by both.
  std::map<std::string, size_t> of;
  for (const sim::Port& port : ports) {
    for (size_t r = 0; r < fleet.robots.size(); ++r) {
      const auto topic = TopicOf(model, fleet, r, port);
      if (!topic) continue;
      const auto [it, fresh] = of.emplace(topic->name, r);
      if (it->second == r) continue;
      diagnostics
          .Report(diag::Kind::kFleetValue, fleet.robots[r].span,
                  fmt::format("`{}` and `{}` have one topic for `{}`: {}", fleet.robots[it->second].name,
                              fleet.robots[r].name, topic->port, topic->name))
          .Help("give each robot a `namespace` of its own, and topics that do not begin with `/`");
      return;
    }
  }
  for (const auto& [name, port] : fleet.ros.ports) {
    if (known.contains(name)) continue;
    const std::string near = lang::Suggest(name, {known.begin(), known.end()});
    auto& report = diagnostics.Report(diag::Kind::kFleetValue, port.span,
                                      fmt::format("the program has no port `{}`", name));
    report.Help(near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                             : fmt::format("did you mean `{}`?", near));
  }
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

ros::std_msgs::Header HeaderOf(const std::string& frame) {
  ros::std_msgs::Header header;
  header.stamp = StampOf(WallTime());
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
