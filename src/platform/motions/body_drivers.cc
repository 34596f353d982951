#include "platform/motions/body_drivers.h"

#include <algorithm>
#include <cmath>

#include "platform/messages.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/trajectory_msgs.h"

namespace rondo::platform {

BodyDrivers::BodyDrivers(const robot::World& world, const expr::Arena& arena, sim::motions::SceneState& scene)
    : scene_(scene), environment_(EnvironmentOf(world, arena, scene)) {
  for (size_t r = 0; r < world.bodies.size(); ++r) {
    One& one = ones_.emplace_back();
    one.topics = TopicsOf(world, r, arena, scene);
    one.ways.resize(one.topics.joints.size());
  }
}

base::Result<bool> BodyDrivers::Begin(dds::Participant& participant) {
  for (size_t r = 0; r < ones_.size(); ++r) {
    if (auto begun = Begin(participant, r); !begun.ok()) return begun;
  }
  if (environment_.empty()) return true;
  return Speak(participant, participant.AddNode({"/environment", "driver"}), environment_);
}

base::Result<bool> BodyDrivers::Speak(dds::Participant& participant, size_t node,
                                      const std::vector<Signal>& signals) {
  for (const Signal& signal : signals) {
    auto made = participant.Publish(node, signal.topic, TypeOf(Carries::kNumber), ros::kDefault);
    if (!made.ok()) return made.error();
    voices_.push_back({signal.place, std::move(made).value()});
  }
  return true;
}

base::Result<bool> BodyDrivers::Begin(dds::Participant& participant, size_t robot) {
  One& one = ones_[robot];
  const size_t node = participant.AddNode({"/" + one.topics.node_namespace, "driver"});
  const auto speak = [&](const char* topic, Carries carries, auto& publisher) -> base::Result<bool> {
    auto made = participant.Publish(node, one.topics.Full(topic), TypeOf(carries), ros::kDefault);
    if (!made.ok()) return made.error();
    publisher = std::move(made).value();
    return true;
  };
  const auto listen = [&](const char* topic, Carries carries,
                          const dds::Receive& receive) -> base::Result<bool> {
    auto made = participant.Subscribe(node, one.topics.Full(topic), TypeOf(carries), ros::kDefault, receive);
    if (!made.ok()) return made.error();
    subscriptions_.push_back(std::move(made).value());
    return true;
  };
  if (one.topics.base) {
    if (auto made = speak("odom", Carries::kOdometry, one.odometry); !made.ok()) return made;
    const auto hear = [this, &one](std::string_view bytes, const dds::Received&) {
      const auto twist = TwistIn(Carries::kTwist, bytes);
      if (!twist) return;
      const std::lock_guard lock(mutex_);
      one.driven = {twist->forward, twist->left, twist->turn, 0};
    };
    if (auto made = listen("cmd_vel", Carries::kTwist, hear); !made.ok()) return made;
  }
  if (!one.topics.joints.empty()) {
    if (auto made = speak("joint_states", Carries::kJointState, one.joints); !made.ok()) return made;
    const auto hear = [this, &one](std::string_view bytes, const dds::Received&) { Hear(one, bytes); };
    if (auto made = listen("joint_trajectory", Carries::kJointTrajectory, hear); !made.ok()) return made;
  }
  return Speak(participant, node, one.topics.signals);
}

void BodyDrivers::Hear(One& one, std::string_view trajectory) {
  constexpr size_t kMostPoints = 100'000;
  ros::trajectory_msgs::JointTrajectory m;
  if (!ros::Parse(trajectory, m) || m.points.size() > kMostPoints) return;
  std::vector<std::vector<Point>> ways(one.ways.size());
  for (const auto& point : m.points) {
    if (point.positions.size() != m.joint_names.size()) return;
    const double within = point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec;
    for (size_t j = 0; j < ways.size(); ++j) {
      const auto it = std::ranges::find(m.joint_names, one.topics.joints[j].name);
      if (it == m.joint_names.end()) continue;
      const double position = point.positions[static_cast<size_t>(it - m.joint_names.begin())];
      if (!std::isfinite(position) || (!ways[j].empty() && within < ways[j].back().within)) return;
      ways[j].push_back({within, position});
    }
  }
  const std::lock_guard lock(mutex_);
  for (size_t j = 0; j < ways.size(); ++j) {
    if (!ways[j].empty()) one.ways[j] = std::move(ways[j]);
  }
}

void BodyDrivers::Step(double dt) {
  constexpr double kDeaf = 0.5;  // seconds
  const std::lock_guard lock(mutex_);
  std::vector<double>& scene = scene_.values();
  for (One& one : ones_) {
    if (one.topics.base) {
      one.driven.age += dt;
      const bool goes = one.driven.age < kDeaf;
      const Base& base = *one.topics.base;
      // In the middle of the step, for turns.
      const double turn = goes && base.yaw ? one.driven.turn : 0;
      const double yaw = base.yaw ? scene[*base.yaw] + turn * dt / 2 : 0;
      const double forward = goes ? one.driven.forward : 0, left = goes ? one.driven.left : 0;
      scene[base.x] += dt * (std::cos(yaw) * forward - std::sin(yaw) * left);
      scene[base.y] += dt * (std::sin(yaw) * forward + std::cos(yaw) * left);
      if (base.yaw) scene[*base.yaw] += dt * turn;
    }
    for (size_t j = 0; j < one.ways.size(); ++j) {
      std::vector<Point>& way = one.ways[j];
      double& position = scene[one.topics.joints[j].place];
      double rest = dt;
      while (!way.empty()) {
        Point& next = way.front();
        if (next.within > rest) {
          position += (next.position - position) * rest / next.within;
          break;
        }
        position = next.position;
        rest -= next.within;
        const double passed = next.within;
        way.erase(way.begin());
        for (Point& later : way) later.within -= passed;
      }
      for (Point& later : way) later.within -= rest;
    }
  }
}

void BodyDrivers::Tell() {
  const std::lock_guard lock(mutex_);
  const int64_t stamp = WallTime();
  const std::vector<double>& scene = scene_.values();
  for (One& one : ones_) {
    if (one.odometry != nullptr) {
      ros::nav_msgs::Odometry m;
      m.header = HeaderOf(one.topics.node_namespace + "/odom", stamp);
      m.child_frame_id = one.topics.node_namespace + "/base";
      m.pose.pose.position = {scene[one.topics.base->x], scene[one.topics.base->y], 0};
      m.pose.pose.orientation = Turned(one.topics.base->yaw ? scene[*one.topics.base->yaw] : 0);
      m.twist.twist.linear.x = one.driven.forward;
      m.twist.twist.linear.y = one.driven.left;
      m.twist.twist.angular.z = one.driven.turn;
      (void)one.odometry->Publish(m).ok();
    }
    if (one.joints != nullptr) {
      ros::sensor_msgs::JointState m;
      m.header = HeaderOf("", stamp);
      for (const Joint& joint : one.topics.joints) {
        m.name.push_back(joint.name);
        m.position.push_back(scene[joint.place]);
      }
      (void)one.joints->Publish(m).ok();
    }
  }
  for (const Voice& voice : voices_) {
    ros::std_msgs::Float64 m;
    m.data = scene[voice.place];
    (void)voice.publisher->Publish(m).ok();
  }
}

}  // namespace rondo::platform
