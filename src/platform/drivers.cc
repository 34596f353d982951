#include "platform/drivers.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "platform/frames.h"
#include "ros/action_msgs.h"
#include "ros/names.h"
#include "ros/nav_msgs.h"
#include "ros/rosgraph_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/tf2_msgs.h"

namespace rondo::platform {

using sim::Body;
using sim::Point;
using sim::Port;
using sim::PortRole;

namespace {

std::string BaseOf(const sim::Fleet& fleet, size_t robot) {
  return fleet.robots[robot].node_namespace + "/base_link";
}

}  // namespace

Drivers::Drivers(const koord::Model& model, const sim::Fleet& fleet, const std::vector<Port>& ports,
                 const std::vector<std::unique_ptr<Body>>& bodies, bool simulated_time)
    : model_(model),
      fleet_(fleet),
      ports_(ports),
      bodies_(bodies),
      simulated_time_(simulated_time),
      autopilots_(bodies.size()),
      goals_(bodies.size()),
      driven_(bodies.size()) {}

base::Result<bool> Drivers::Begin(dds::Participant& participant) {
  for (size_t r = 0; r < bodies_.size(); ++r) {
    if (auto begun = Begin(participant, r); !begun.ok()) return begun;
  }
  return true;
}

base::Result<bool> Drivers::Begin(dds::Participant& participant, size_t r) {
  const size_t node = participant.AddNode({"/" + fleet_.robots[r].node_namespace, "driver"});
  const auto publish = [&](const char* topic, const ros::Message& type, const ros::Qos& qos,
                           std::unique_ptr<dds::Publisher>& publisher) -> base::Result<bool> {
    if (publisher != nullptr) return true;
    auto made = participant.Publish(node, topic, type, qos);
    if (!made.ok()) return made.error();
    publisher = std::move(made).value();
    return true;
  };
  if (auto made = publish("/tf", ros::tf2_msgs::TFMessage::kMessage, ros::kTransforms, transforms_);
      !made.ok())
    return made;
  if (simulated_time_) {
    if (auto made = publish("/clock", ros::rosgraph_msgs::Clock::kMessage, {.depth = 1}, clock_); !made.ok())
      return made;
  }
  // Odometry always: the usual tools show it, and `reached` may need it.
  const Topic odometry = OdometryOf(fleet_, r);
  if (odometry.carries == Carries::kOdometry) {
    if (auto made = Speak(participant, node, r, nullptr, odometry); !made.ok()) return made;
  }
  std::optional<Topic> setpoints;
  for (const Port& port : ports_) {
    const auto topic = TopicOf(model_, fleet_, r, port);
    if (!topic || !topic->library.empty()) continue;
    if (topic->carries == Carries::kPx4Setpoint) setpoints = topic;
    // The autopilot speaks for itself; where frames are is told of all.
    if (topic->carries == Carries::kPx4Setpoint || topic->carries == Carries::kPx4Odometry ||
        topic->carries == Carries::kTransform)
      continue;
    const auto made = sim::IsActuator(model_, port) ? Listen(participant, node, r, port)
                                                    : Speak(participant, node, r, &port, *topic);
    if (!made.ok()) return made.error();
  }
  if (odometry.carries != Carries::kPx4Odometry) return true;
  autopilots_[r] =
      std::make_unique<SimulatedAutopilot>(*bodies_[r], *fleet_.robots[r].origin, setpoints->system);
  return autopilots_[r]->Begin(participant, node, odometry.name, setpoints->name);
}

base::Result<bool> Drivers::Speak(dds::Participant& participant, size_t node, size_t robot, const Port* port,
                                  const Topic& topic) {
  const bool known = std::ranges::any_of(voices_, [&](const Voice& v) {
    return v.topic.name == topic.name && v.topic.carries == topic.carries && v.topic.joint == topic.joint;
  });
  if (known) return true;
  // What a robot wants to hear reliably, or from before, is said so.
  ros::Qos qos = topic.carries == Carries::kScan ? ros::kSensorData : ros::kDefault;
  qos.reliable = qos.reliable || topic.qos.reliable;
  qos.transient_local = topic.qos.transient_local;
  auto publisher = participant.Publish(node, topic.name, TypeOf(topic.carries), qos);
  if (!publisher.ok()) return publisher.error();
  voices_.push_back({robot, port, topic, std::move(publisher).value()});
  return true;
}

base::Result<bool> Drivers::Listen(dds::Participant& participant, size_t node, size_t robot,
                                   const Port& port) {
  const Topic topic = *TopicOf(model_, fleet_, robot, port);
  if (Drives(topic.carries)) driven_[robot].emplace();
  auto subscription =
      participant.Subscribe(node, topic.name, TypeOf(topic.carries), topic.qos,
                            [this, robot, &port, topic](std::string_view bytes, const dds::Received&) {
                              Hear(robot, port, topic, bytes);
                            });
  if (!subscription.ok()) return subscription.error();
  subscriptions_.push_back(std::move(subscription).value());
  return true;
}

void Drivers::Hear(size_t robot, const Port& port, const Topic& topic, std::string_view bytes) {
  Order order{robot, &port, {}, {}, {}};
  if (Drives(topic.carries)) {
    order.twist = TwistIn(topic.carries, bytes);
    if (!order.twist) return;
  } else if (topic.carries == Carries::kPose || topic.carries == Carries::kPath) {
    auto path = PathIn(topic.carries, bytes);
    if (!path) return;
    order.path = std::move(*path);
  } else {
    const auto numbers = NumbersIn(topic, bytes);
    if (!numbers || !Finite(*numbers)) return;
    order.numbers = *numbers;
  }
  const std::lock_guard lock(mutex_);
  orders_.push_back(std::move(order));
}

void Drivers::Obey() {
  std::vector<Order> orders;
  {
    const std::lock_guard lock(mutex_);
    orders.swap(orders_);
  }
  for (Order& order : orders) {
    Body& body = *bodies_[order.robot];
    if (order.twist) {
      driven_[order.robot] = Driven{*order.twist, 0};
    } else if (const auto& own = order.port->own[order.robot]) {
      body.WritePort(*own, std::span(order.numbers).first(own->kind == sim::BodyPort::Kind::kPoint ? 3 : 1));
    } else {
      // Each order is a goal of its own, and what it replaces is over (action_msgs/GoalStatus: executing).
      goals_[order.robot] = {goals_[order.robot].number + 1, stamp_, 2};
      if (order.path != body.path()) body.Follow(std::move(order.path));
    }
  }
}

std::optional<size_t> Drivers::Step(double dt) {
  constexpr double kForgotten = 0.5;  // seconds
  for (size_t r = 0; r < bodies_.size(); ++r) {
    bool good = true;
    if (auto& driven = driven_[r]) {
      if (driven->age > kForgotten) driven->twist = {};
      driven->age += dt;
      good = bodies_[r]->Drive(driven->twist, dt, fleet_.integrator);
    } else {
      if (autopilots_[r] != nullptr) autopilots_[r]->Step(dt);
      good = bodies_[r]->Step(dt, fleet_.integrator);
    }
    if (!good) return r;
  }
  return std::nullopt;
}

void Drivers::TellTime(double t) {
  if (!simulated_time_) {
    stamp_ = WallTime();
    return;
  }
  // Nobody takes a clock at zero for one that goes.
  stamp_ = 1'000'000'000 + static_cast<int64_t>(std::llround(t * 1e9));
  ros::rosgraph_msgs::Clock m;
  m.clock = StampOf(stamp_);
  (void)clock_->Publish(m).ok();
}

void Drivers::Tell(const std::vector<sim::Rays>& scans) {
  ros::tf2_msgs::TFMessage transforms;
  for (const Voice& voice : voices_) {
    switch (voice.topic.carries) {
      case Carries::kOdometry:
      case Carries::kPoseSeen:
      case Carries::kCovariance:
        Pose(voice);
        break;
      case Carries::kScan:
        if (!scans.empty()) Scan(voice, scans[voice.robot]);
        break;
      case Carries::kGoalStatus:
        Status(voice);
        break;
      default:
        Other(voice);
    }
  }
  for (const auto& autopilot : autopilots_) {
    if (autopilot != nullptr) autopilot->Tell(stamp_);
  }
  for (size_t r = 0; r < bodies_.size(); ++r) {
    auto& t = transforms.transforms.emplace_back();
    t.header = Header(fleet_.ros.frame);
    t.child_frame_id = BaseOf(fleet_, r);
    const Point p = bodies_[r]->position();
    const auto q = bodies_[r]->rotation();
    t.transform.translation.x = p[0];
    t.transform.translation.y = p[1];
    t.transform.translation.z = p[2];
    t.transform.rotation.x = q[0];
    t.transform.rotation.y = q[1];
    t.transform.rotation.z = q[2];
    t.transform.rotation.w = q[3];
  }
  (void)transforms_->Publish(transforms).ok();
}

namespace {

// A pose in the frame of the fleet, as it is seen from an origin.
ros::geometry_msgs::Pose Seen(const ros::geometry_msgs::Pose& pose, const sim::Origin& origin) {
  ros::geometry_msgs::Transform to;
  to.rotation = Turned(-origin.yaw);
  const auto back = Rotated(to.rotation, {origin.position[0], origin.position[1], origin.position[2]});
  to.translation = {-back.x, -back.y, -back.z};
  return Applied(to, pose);
}

}  // namespace

void Drivers::Pose(const Voice& voice) {
  const Body& body = *bodies_[voice.robot];
  const auto& origin = fleet_.robots[voice.robot].origin;
  const auto q = body.rotation();
  ros::nav_msgs::Odometry m;
  m.header = Header(fleet_.ros.frame);
  m.child_frame_id = BaseOf(fleet_, voice.robot);
  m.pose.pose.position = PointOf(body.position());
  m.pose.pose.orientation = {q[0], q[1], q[2], q[3]};
  // In the frame of the body (nav_msgs/Odometry).
  ros::geometry_msgs::Quaternion back = m.pose.pose.orientation;
  back.w = -back.w;
  const Point v = body.velocity();
  m.twist.twist.linear = Rotated(back, {v[0], v[1], v[2]});
  // As it counts from where it began.
  if (origin) {
    m.header.frame_id = fleet_.robots[voice.robot].node_namespace + "/odom";
    m.pose.pose = Seen(m.pose.pose, *origin);
  }
  if (voice.topic.carries == Carries::kOdometry) return (void)voice.publisher->Publish(m).ok();
  ros::geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header = m.header;
  pose.pose = m.pose;
  if (voice.topic.carries == Carries::kCovariance) return (void)voice.publisher->Publish(pose).ok();
  ros::geometry_msgs::PoseStamped bare;
  bare.header = m.header;
  bare.pose = m.pose.pose;
  (void)voice.publisher->Publish(bare).ok();
}

void Drivers::Scan(const Voice& voice, const sim::Rays& rays) {
  if (rays.distances.empty()) return;
  ros::sensor_msgs::LaserScan m;
  m.header = Header(BaseOf(fleet_, voice.robot));
  const double first = rays.first - bodies_[voice.robot]->yaw();
  m.angle_min = static_cast<float>(first);
  m.angle_increment = static_cast<float>(rays.step);
  m.angle_max = static_cast<float>(first + rays.step * static_cast<double>(rays.distances.size() - 1));
  m.scan_time = static_cast<float>(1 / fleet_.lidar.rate);
  m.range_max = static_cast<float>(rays.range);
  for (const double d : rays.distances) m.ranges.push_back(static_cast<float>(d));
  (void)voice.publisher->Publish(m).ok();
}

void Drivers::Status(const Voice& voice) {
  constexpr int8_t kSucceeded = 4;
  Goal& goal = goals_[voice.robot];
  if (goal.number == 0) return;
  if (bodies_[voice.robot]->reached()) goal.status = kSucceeded;
  ros::action_msgs::GoalStatusArray m;
  auto& status = m.status_list.emplace_back();
  std::memcpy(status.goal_info.goal_id.uuid.data(), &goal.number, sizeof goal.number);
  status.goal_info.stamp = StampOf(goal.accepted);
  status.status = goal.status;
  (void)voice.publisher->Publish(m).ok();
}

void Drivers::Other(const Voice& voice) {
  const Body& body = *bodies_[voice.robot];
  Numbers values{};
  if (const auto& own = voice.port->own[voice.robot])
    body.ReadPort(*own, std::span(values).first(own->kind == sim::BodyPort::Kind::kPoint ? 3 : 1));
  else if (voice.port->role == PortRole::kReached)
    values[0] = body.reached() ? 1 : 0;
  (void)voice.publisher->Write(MessageOf(voice.topic, values, Header(""))).ok();
}

}  // namespace rondo::platform
