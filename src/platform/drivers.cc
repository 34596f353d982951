#include "platform/drivers.h"

#include <algorithm>
#include <cmath>

#include "platform/frames.h"
#include "ros/ackermann_msgs.h"
#include "ros/nav_msgs.h"
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
                 const std::vector<std::unique_ptr<Body>>& bodies)
    : model_(model), fleet_(fleet), ports_(ports), bodies_(bodies), driven_(bodies.size()) {}

base::Result<bool> Drivers::Begin(dds::Participant& participant) {
  for (size_t r = 0; r < bodies_.size(); ++r) {
    const size_t node = participant.AddNode({"/" + fleet_.robots[r].node_namespace, "driver"});
    const size_t first = voices_.size();
    // Odometry always: the usual tools show it, and `reached` may need it.
    const Port place{0, PortRole::kPosition, std::vector<std::optional<sim::BodyPort>>(bodies_.size())};
    std::vector<std::pair<const Port*, Topic>> said{{nullptr, *TopicOf(model_, fleet_, r, place)}};
    for (const Port& port : ports_) {
      if (sim::IsActuator(model_, port)) {
        const auto listens = Listen(participant, node, r, port);
        if (!listens.ok()) return listens.error();
      } else if (const auto topic = TopicOf(model_, fleet_, r, port)) {
        said.emplace_back(&port, *topic);
      }
    }
    for (const auto& [port, topic] : said) {
      const bool known = std::any_of(
          voices_.begin() + static_cast<ptrdiff_t>(first), voices_.end(),
          [&](const Voice& v) { return v.topic.name == topic.name && v.topic.carries == topic.carries; });
      if (known) continue;
      const ros::Qos qos = topic.carries == Carries::kScan ? ros::kSensorData : ros::kDefault;
      auto publisher = participant.Publish(node, topic.name, TypeOf(topic.carries), qos);
      if (!publisher.ok()) return publisher.error();
      voices_.push_back({r, port, topic, std::move(publisher).value()});
    }
    if (transforms_ == nullptr) {
      auto publisher = participant.Publish(node, "/tf", ros::tf2_msgs::TFMessage::kMessage, ros::kTransforms);
      if (!publisher.ok()) return publisher.error();
      transforms_ = std::move(publisher).value();
    }
  }
  return true;
}

base::Result<bool> Drivers::Listen(dds::Participant& participant, size_t node, size_t robot,
                                   const Port& port) {
  const Topic topic = *TopicOf(model_, fleet_, robot, port);
  if (Drives(topic.carries)) driven_[robot].emplace();
  auto subscription = participant.Subscribe(
      node, topic.name, TypeOf(topic.carries), {.depth = 1},
      [this, robot, &port, carries = topic.carries](std::string_view bytes, const dds::Received&) {
        Hear(robot, port, carries, bytes);
      });
  if (!subscription.ok()) return subscription.error();
  subscriptions_.push_back(std::move(subscription).value());
  return true;
}

void Drivers::Hear(size_t robot, const Port& port, Carries carries, std::string_view bytes) {
  Order order{robot, &port, {}, {}, {}};
  bool good = false;
  switch (carries) {
    case Carries::kPose: {
      ros::geometry_msgs::PoseStamped m;
      good = ros::Parse(bytes, m);
      order.path = {PointOf(m.pose.position)};
      break;
    }
    case Carries::kPath: {
      ros::nav_msgs::Path m;
      good = ros::Parse(bytes, m);
      for (const auto& pose : m.poses) order.path.push_back(PointOf(pose.pose.position));
      break;
    }
    case Carries::kBool: {
      ros::std_msgs::Bool m;
      good = ros::Parse(bytes, m);
      order.numbers[0] = m.data ? 1 : 0;
      break;
    }
    case Carries::kNumber: {
      ros::std_msgs::Float64 m;
      good = ros::Parse(bytes, m);
      order.numbers[0] = m.data;
      break;
    }
    case Carries::kPoint: {
      ros::geometry_msgs::Point m;
      good = ros::Parse(bytes, m);
      order.numbers = PointOf(m);
      break;
    }
    case Carries::kTwist: {
      ros::geometry_msgs::Twist m;
      good = ros::Parse(bytes, m);
      order.twist = {m.linear.x, m.linear.y, m.angular.z, 0};
      break;
    }
    case Carries::kTwistStamped: {
      ros::geometry_msgs::TwistStamped m;
      good = ros::Parse(bytes, m);
      order.twist = {m.twist.linear.x, m.twist.linear.y, m.twist.angular.z, 0};
      break;
    }
    case Carries::kAckermann: {
      ros::ackermann_msgs::AckermannDriveStamped m;
      good = ros::Parse(bytes, m);
      order.twist = {m.drive.speed, 0, 0, m.drive.steering_angle};
      break;
    }
    case Carries::kOdometry:
    case Carries::kScan:
      break;
  }
  if (order.twist) {
    order.numbers = {order.twist->forward, order.twist->left, order.twist->turn};
    good = good && std::isfinite(order.twist->steer);
  }
  if (!good || !Finite(order.numbers) || !std::ranges::all_of(order.path, Finite)) return;
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
    } else if (order.path != body.path()) {
      body.Follow(std::move(order.path));
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
      good = bodies_[r]->Step(dt, fleet_.integrator);
    }
    if (!good) return r;
  }
  return std::nullopt;
}

void Drivers::Tell(const std::vector<sim::Rays>& scans) {
  ros::tf2_msgs::TFMessage transforms;
  for (const Voice& voice : voices_) {
    switch (voice.topic.carries) {
      case Carries::kOdometry:
        Odometry(voice);
        break;
      case Carries::kScan:
        if (!scans.empty()) Scan(voice, scans[voice.robot]);
        break;
      case Carries::kBool:
      case Carries::kNumber:
      case Carries::kPoint:
        Other(voice);
        break;
      case Carries::kPose:
      case Carries::kPath:
      case Carries::kTwist:
      case Carries::kTwistStamped:
      case Carries::kAckermann:
        break;
    }
  }
  for (size_t r = 0; r < bodies_.size(); ++r) {
    auto& t = transforms.transforms.emplace_back();
    t.header = HeaderOf(fleet_.ros.frame);
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

void Drivers::Odometry(const Voice& voice) {
  const Body& body = *bodies_[voice.robot];
  ros::nav_msgs::Odometry m;
  m.header = HeaderOf(fleet_.ros.frame);
  m.child_frame_id = BaseOf(fleet_, voice.robot);
  const Point p = body.position(), v = body.velocity();
  const auto q = body.rotation();
  m.pose.pose.position.x = p[0];
  m.pose.pose.position.y = p[1];
  m.pose.pose.position.z = p[2];
  m.pose.pose.orientation.x = q[0];
  m.pose.pose.orientation.y = q[1];
  m.pose.pose.orientation.z = q[2];
  m.pose.pose.orientation.w = q[3];
  // In the frame of the body (nav_msgs/Odometry).
  ros::geometry_msgs::Quaternion back = m.pose.pose.orientation;
  back.w = -back.w;
  ros::geometry_msgs::Vector3 world;
  world.x = v[0];
  world.y = v[1];
  world.z = v[2];
  m.twist.twist.linear = Rotated(back, world);
  (void)voice.publisher->Publish(m).ok();
}

void Drivers::Scan(const Voice& voice, const sim::Rays& rays) {
  if (rays.distances.empty()) return;
  ros::sensor_msgs::LaserScan m;
  m.header = HeaderOf(BaseOf(fleet_, voice.robot));
  const double first = rays.first - bodies_[voice.robot]->yaw();
  m.angle_min = static_cast<float>(first);
  m.angle_increment = static_cast<float>(rays.step);
  m.angle_max = static_cast<float>(first + rays.step * static_cast<double>(rays.distances.size() - 1));
  m.scan_time = static_cast<float>(1 / fleet_.lidar.rate);
  m.range_max = static_cast<float>(rays.range);
  for (const double d : rays.distances) m.ranges.push_back(static_cast<float>(d));
  (void)voice.publisher->Publish(m).ok();
}

void Drivers::Other(const Voice& voice) {
  const Body& body = *bodies_[voice.robot];
  std::array<double, 3> values{};
  if (const auto& own = voice.port->own[voice.robot])
    body.ReadPort(*own, std::span(values).first(own->kind == sim::BodyPort::Kind::kPoint ? 3 : 1));
  else if (voice.port->role == PortRole::kReached)
    values[0] = body.reached() ? 1 : 0;
  if (voice.topic.carries == Carries::kBool) {
    ros::std_msgs::Bool m;
    m.data = values[0] != 0;
    (void)voice.publisher->Publish(m).ok();
  } else if (voice.topic.carries == Carries::kNumber) {
    ros::std_msgs::Float64 m;
    m.data = values[0];
    (void)voice.publisher->Publish(m).ok();
  } else {
    ros::geometry_msgs::Point m;
    m.x = values[0];
    m.y = values[1];
    m.z = values[2];
    (void)voice.publisher->Publish(m).ok();
  }
}

}  // namespace rondo::platform
