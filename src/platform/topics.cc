#include "platform/topics.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "lang/suggest.h"
#include "ros/ackermann_msgs.h"
#include "ros/action_msgs.h"
#include "ros/names.h"
#include "ros/nav_msgs.h"
#include "ros/px4_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/trajectory_msgs.h"

namespace rondo::platform {

using sim::BodyPort;
using sim::PortRole;
using sim::PortVia;

namespace {

std::string NameOf(const koord::Model& model, const sim::Port& port) {
  const koord::Variable& variable = model.variables[port.variable];
  return variable.name.substr(variable.module.size() + 1);
}

const sim::FleetPort* Said(const sim::Fleet& fleet, const std::string& name) {
  const auto said = fleet.ros.ports.find(name);
  return said == fleet.ros.ports.end() ? nullptr : &said->second;
}

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

// What the values of a type are to an adapter; nothing if it cannot have them.
std::optional<Carries> AdaptedAs(const koord::Model& model, const sim::Port& port) {
  const lang::TypeTable& types = model.types;
  const lang::TypeId type = model.variables[port.variable].type;
  if (types.Is(type, lang::TypeKind::kFloat)) return Carries::kNumber;
  if (types.Is(type, lang::TypeKind::kBool)) return Carries::kBool;
  if (types.Resolve(type) == types.pos()) return Carries::kPoint;
  return std::nullopt;
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

// What drivers usually ask for.
ros::Qos QosOf(Carries carries, bool actuator) {
  if (carries == Carries::kGoalStatus) return ros::kLatched;
  if (carries == Carries::kPx4Odometry || carries == Carries::kPx4Setpoint)
    return {.reliable = false, .depth = 1};
  // Drivers keep where to go for as long as they like.
  return actuator ? ros::Qos{.depth = 1} : ros::kSensorData;
}

// Looks at what a fleet file says of one port.
class PortCheck {
 public:
  PortCheck(const koord::Model& model, const sim::Fleet& fleet, diag::Diagnostics& diagnostics)
      : model_(model), fleet_(fleet), diagnostics_(diagnostics) {}

  void Run(const sim::Port& port) {
    const std::string name = NameOf(model_, port);
    const sim::FleetPort* said = Said(fleet_, name);
    if (said == nullptr) return;
    if (sim::IsActuator(model_, port) && said->max_age > 0) {
      diagnostics_.Report(diag::Kind::kFleetValue, said->span,
                          fmt::format("`{}` is an actuator: `max_age` is of sensors", name));
      return;
    }
    for (size_t r = 0; r < fleet_.robots.size(); ++r) {
      const auto [what, help] = Wrong(port, name, *said, r);
      if (what.empty()) continue;
      auto& report = diagnostics_.Report(diag::Kind::kFleetValue, said->span, what);
      if (!help.empty()) report.Help(help);
      return;
    }
  }

 private:
  using Text = std::pair<std::string, std::string>;

  Text Wrong(const sim::Port& port, const std::string& name, const sim::FleetPort& said, size_t r) const {
    const bool goes = port.role == PortRole::kTarget || port.role == PortRole::kPath;
    const bool actuator = sim::IsActuator(model_, port);
    const sim::FleetRobot& robot = fleet_.robots[r];
    const bool number = port.own[r] && port.own[r]->kind == BodyPort::Kind::kNumber;
    switch (said.via) {
      case PortVia::kTopic:
        return {};
      case PortVia::kNav2:
        if (goes || port.role == PortRole::kReached) return {};
        return {fmt::format("Nav2 knows nothing of `{}`", name),
                "it is told where to go, and says whether it is there: `target` and `reached`"};
      case PortVia::kTwist:
      case PortVia::kAckermann: {
        const char* help = "name a topic for it: `{ ros2 = \"goal_pose\" }`";
        if (!goes)
          return {fmt::format("`{}` does not say where to go, so it cannot be made of velocities", name),
                  help};
        const bool steers = said.via == PortVia::kAckermann;
        const auto place = std::ranges::find_if(fleet_.ros.ports, [](const auto& p) {
          return p.second.via == PortVia::kAdapter &&
                 (p.first == "psn" || p.first == "position" || p.first == "pos");
        });
        if (place != fleet_.ros.ports.end())
          return {fmt::format("a controller has to know the heading, and `{}` does not say it", place->first),
                  "let odometry say where the robot is: `{ ros2 = \"odom\" }`"};
        if (BodyOf(r)->Told() && (!steers || robot.model == "car")) return {};
        return {fmt::format("`{}` is a `{}`, which is not driven by {}", robot.name, robot.model,
                            steers ? "an angle of steering" : "velocities in the plane"),
                help};
      }
      case PortVia::kJointStates:
      case PortVia::kJointTrajectory: {
        const bool tells = said.via == PortVia::kJointTrajectory;
        if (number && tells == actuator) return {};
        return {
            fmt::format("`{}` is no {} of type `float`", name, tells ? "actuator" : "sensor"),
            "a joint is where a sensor of type `float` says (`joint_states`), and goes where an actuator says "
            "(`joint_trajectory`)"};
      }
      case PortVia::kPx4: {
        const bool flies = port.role == PortRole::kPosition || port.role == PortRole::kVelocity ||
                           port.role == PortRole::kHeading || port.role == PortRole::kTarget;
        if (!flies)
          return {fmt::format("an autopilot knows nothing of `{}`", name),
                  "it says `psn`, `velocity` and `heading`, and flies to a `target`"};
        if (!BodyOf(r)->flies())
          return {fmt::format("`{}` is a `{}`, which does not fly", robot.name, robot.model), {}};
        if (!robot.origin)
          return {fmt::format("nobody knows where the autopilot of `{}` counts from", robot.name),
                  "say it in its `[[robot]]`: `origin = \"start\"`, or a point: `origin = [x, y, z]`"};
        return {};
      }
      case PortVia::kAdapter:
        if (AdaptedAs(model_, port)) return {};
        return {fmt::format("`{}` is no `float`, `bool` or `pos`, which is what an adapter can have", name),
                {}};
    }
    return {};
  }

  std::unique_ptr<sim::Body> BodyOf(size_t r) const {
    auto body = fleet_.robots[r].make();
    body->Place(fleet_.robots[r].position, fleet_.robots[r].yaw);
    return body;
  }

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  diag::Diagnostics& diagnostics_;
};

// A topic of two robots would be read, or obeyed, by both; one that carries two things is heard by nobody; and where a robot is, one
// topic says.
void CheckShared(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
                 diag::Diagnostics& diagnostics) {
  struct Use {
    size_t robot;
    Topic topic;
  };
  std::map<std::string, Use> of;
  std::map<size_t, Topic> place;  // by robot
  const auto report = [&](size_t robot, std::string what) -> diag::Diagnostic& {
    return diagnostics.Report(diag::Kind::kFleetValue, fleet.robots[robot].span, std::move(what));
  };
  for (const sim::Port& port : ports) {
    for (size_t r = 0; r < fleet.robots.size(); ++r) {
      const auto topic = TopicOf(model, fleet, r, port);
      if (!topic || !topic->library.empty()) continue;
      const auto& [robot, other] = of.emplace(topic->name, Use{r, *topic}).first->second;
      if (robot != r) {
        report(r, fmt::format("`{}` and `{}` have one topic for `{}`: {}", fleet.robots[robot].name,
                              fleet.robots[r].name, topic->port, topic->name))
            .Help("give each robot a `namespace` of its own, and topics that do not begin with `/`");
        return;
      }
      if (TypeOf(other.carries).name != TypeOf(topic->carries).name) {
        report(r, fmt::format("`{}` and `{}` are on one topic, {}, and need messages of two types",
                              other.port, topic->port, topic->name))
            .Help("name another topic for one of them in `[ports]`");
        return;
      }
      if (topic->carries != Carries::kOdometry && topic->carries != Carries::kPx4Odometry) continue;
      const Topic& first = place.emplace(r, *topic).first->second;
      if (first.name != topic->name) {
        report(r, fmt::format("`{}` and `{}` say by two topics where `{}` is, and how it moves: {} and {}",
                              first.port, topic->port, fleet.robots[r].name, first.name, topic->name))
            .Help("name one topic for both in `[ports]`");
        return;
      }
    }
  }
  std::map<std::string, size_t> spaces;
  for (size_t r = 0; r < fleet.robots.size(); ++r) {
    const auto [it, fresh] = spaces.emplace(fleet.robots[r].node_namespace, r);
    if (fresh) continue;
    report(r, fmt::format("`{}` and `{}` have one namespace: `{}`", fleet.robots[it->second].name,
                          fleet.robots[r].name, it->first));
    return;
  }
}

}  // namespace

std::vector<sim::Port> PortsOf(const koord::Model& model, const sim::Fleet& fleet,
                               diag::Diagnostics& diagnostics) {
  std::set<std::string> adapted;
  for (const auto& [name, port] : fleet.ros.ports) {
    if (port.via == PortVia::kAdapter) adapted.insert(name);
  }
  const size_t before = diagnostics.errors();
  std::vector<sim::Port> ports = sim::FindPorts(model, fleet.robots, diagnostics, adapted);
  if (diagnostics.errors() != before) return ports;
  std::set<std::string> known;
  PortCheck check(model, fleet, diagnostics);
  for (const sim::Port& port : ports) {
    known.insert(NameOf(model, port));
    check.Run(port);
  }
  CheckShared(model, fleet, ports, diagnostics);
  for (const auto& [name, port] : fleet.ros.ports) {
    if (known.contains(name)) continue;
    const std::string near = lang::Suggest(name, {known.begin(), known.end()});
    auto& report = diagnostics.Report(diag::Kind::kFleetValue, port.span,
                                      fmt::format("the program has no port `{}`", name));
    report.Help(near.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                             : fmt::format("did you mean `{}`?", near));
  }
  return ports;
}

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
  topic.system = static_cast<uint8_t>(said->system > 0 ? said->system : robot + 1);
  topic.options = said->options;
  if (said->via == PortVia::kAdapter)
    topic.name = topic.library = said->topic;
  else
    topic.name = ros::FullName(fleet.robots[robot].node_namespace, Below(said->topic, topic.carries));
  return topic;
}

Topic OdometryOf(const sim::Fleet& fleet, size_t robot) {
  const auto flown = std::ranges::find_if(fleet.ros.ports,
                                          [](const auto& port) { return port.second.via == PortVia::kPx4; });
  Topic topic;
  topic.port = "where it is";
  topic.carries = flown == fleet.ros.ports.end() ? Carries::kOdometry : Carries::kPx4Odometry;
  topic.max_age = 5 * fleet.delta;
  topic.qos = QosOf(topic.carries, false);
  topic.name = ros::FullName(fleet.robots[robot].node_namespace,
                             flown == fleet.ros.ports.end() ? UsualName(topic.carries, "")
                                                            : Below(flown->second.topic, topic.carries));
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
