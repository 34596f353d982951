#include "platform/senses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "transport/mailbox.h"

namespace rondo::platform {

using koord::semantics::FromFloat;
using sim::Point;
using sim::Port;
using sim::PortRole;
using transport::BootTime;
using transport::Seconds;

namespace {

constexpr size_t kMostRays = 100'000;

bool IsSensor(const koord::Model& model, const Port& port) { return !sim::IsActuator(model, port); }

}  // namespace

Senses::Senses(const koord::Model& model, const sim::Fleet& fleet, const std::vector<Port>& ports,
               size_t robot, const sim::Body& body, Heap& heap)
    : model_(model),
      fleet_(fleet),
      ports_(ports),
      robot_(robot),
      heap_(heap),
      tolerance_{body.Value("tolerance"), body.Value("waypoint_tolerance"), body.Value("dwell"),
                 body.flies()},
      of_port_(ports.size()) {
  way_.Begin({fleet.robots[robot].position}, tolerance_);
  for (size_t p = 0; p < ports.size(); ++p) {
    if (!IsSensor(model, ports[p])) continue;
    const auto topic = TopicOf(model, fleet, robot, ports[p]);
    if (!topic) continue;
    const auto same = std::ranges::find_if(heard_, [&](const Heard& h) {
      return h.topic.name == topic->name && h.topic.carries == topic->carries;
    });
    of_port_[p] = static_cast<size_t>(same - heard_.begin());
    if (same == heard_.end())
      heard_.push_back({*topic, std::nullopt, {}, {}});
    else
      same->topic.max_age = std::min(same->topic.max_age, topic->max_age);
  }
  // Who asks whether it is where it was told to go has to know where it is; so has a scan.
  const bool needs_place = std::ranges::any_of(ports, [&](const Port& port) {
    return port.role == PortRole::kScans ||
           (port.role == PortRole::kReached && !TopicOf(model, fleet, robot, port));
  });
  const bool has_place =
      std::ranges::any_of(heard_, [](const Heard& h) { return h.topic.carries == Carries::kOdometry; });
  if (!needs_place || has_place) return;
  Port psn{0, PortRole::kPosition, std::vector<std::optional<sim::BodyPort>>(fleet.robots.size())};
  Topic topic = *TopicOf(model, fleet, robot, psn);
  topic.port = "where it is";
  heard_.push_back({topic, std::nullopt, {}, {}});
}

base::Result<bool> Senses::Begin(dds::Participant& participant, size_t node) {
  for (size_t i = 0; i < heard_.size(); ++i) {
    const Topic& topic = heard_[i].topic;
    auto subscription =
        participant.Subscribe(node, topic.name, TypeOf(topic.carries), ros::kSensorData,
                              [this, i](std::string_view bytes, const dds::Received&) { Hear(i, bytes); });
    if (!subscription.ok()) return subscription.error();
    subscriptions_.push_back(std::move(subscription).value());
  }
  for (const bool fixed : {false, true}) {
    ros::Qos qos = ros::kTransforms;
    qos.transient_local = fixed;
    auto subscription =
        participant.Subscribe(node, fixed ? "/tf_static" : "/tf", ros::tf2_msgs::TFMessage::kMessage, qos,
                              [this](std::string_view bytes, const dds::Received&) {
                                ros::tf2_msgs::TFMessage message;
                                if (!ros::Parse(bytes, message)) return;
                                const std::lock_guard lock(mutex_);
                                frames_.Hear(message);
                              });
    if (!subscription.ok()) return subscription.error();
    subscriptions_.push_back(std::move(subscription).value());
  }
  return true;
}

void Senses::Hear(size_t number, std::string_view bytes) {
  const Time now = BootTime();
  const auto with = [&](auto message, const auto& take) {
    const bool good = ros::Parse(bytes, message);
    const std::lock_guard lock(mutex_);
    Heard& heard = heard_[number];
    heard.at = now;
    heard.wrong = good ? "" : "what it says cannot be read";
    if (good) take(heard, message);
  };
  const auto numbers = [](Heard& heard, std::array<double, 3> values) {
    heard.numbers = values;
    if (!Finite(values)) heard.wrong = "it says a number that is not finite";
  };
  switch (heard_[number].topic.carries) {
    case Carries::kOdometry:
      return with(ros::nav_msgs::Odometry(),
                  [&](Heard& heard, const auto& m) { HearOdometry(heard, m, now); });
    case Carries::kScan:
      return with(ros::sensor_msgs::LaserScan(),
                  [&](Heard& heard, const auto& m) { HearScan(heard, m, now); });
    case Carries::kBool:
      return with(ros::std_msgs::Bool(), [&](Heard& h, const auto& m) {
        numbers(h, {m.data ? 1.0 : 0.0, 0, 0});
      });
    case Carries::kNumber:
      return with(ros::std_msgs::Float64(), [&](Heard& h, const auto& m) { numbers(h, {m.data, 0, 0}); });
    case Carries::kPoint:
      return with(ros::geometry_msgs::Point(), [&](Heard& h, const auto& m) { numbers(h, PointOf(m)); });
    case Carries::kPose:
    case Carries::kPath:
    case Carries::kTwist:
    case Carries::kTwistStamped:
    case Carries::kAckermann:
      return;
  }
}

void Senses::HearOdometry(Heard& heard, const ros::nav_msgs::Odometry& m, Time now) {
  const auto transform = frames_.Lookup(fleet_.ros.frame, m.header.frame_id);
  if (!transform) {
    heard.wrong = fmt::format("it is told in frame `{}`, and nobody says on /tf where that is in `{}`",
                              m.header.frame_id, fleet_.ros.frame);
    return;
  }
  const ros::geometry_msgs::Pose pose = Applied(*transform, m.pose.pose);
  // The velocity is told in the frame of the robot (REP-105, nav_msgs/Odometry).
  const auto velocity = Rotated(pose.orientation, m.twist.twist.linear);
  const Place place{PointOf(pose.position), {velocity.x, velocity.y, velocity.z}, YawOf(pose.orientation)};
  if (!Finite(place.position) || !Finite(place.velocity) || !std::isfinite(place.yaw)) {
    heard.wrong = "it says a number that is not finite";
    return;
  }
  if (place_) {
    way_.Next(place.position);
    way_.Pass(place.position, Seconds(now - place_at_));
  }
  place_ = place;
  place_at_ = now;
}

// What a beam says (REP-117): something at a distance, something nearer than it can tell, nothing in range, nothing at all.
double Senses::DistanceOf(float range, const ros::sensor_msgs::LaserScan& m) {
  if (std::isnan(range)) return -1;
  if (range > m.range_max) return INFINITY;
  return std::isfinite(range) ? std::max(0.0, static_cast<double>(range)) : static_cast<double>(m.range_min);
}

void Senses::HearScan(Heard& heard, const ros::sensor_msgs::LaserScan& m, Time now) {
  const auto odometry =
      std::ranges::find_if(heard_, [](const Heard& h) { return h.topic.carries == Carries::kOdometry; });
  if (!place_ || Seconds(now - place_at_) > odometry->topic.max_age) {
    heard.wrong = "it cannot be placed: nobody has said lately where the robot is";
    return;
  }
  if (m.ranges.empty()) return;
  if (m.ranges.size() > kMostRays ||
      !std::isfinite(m.angle_min + m.angle_increment + m.range_max + m.range_min) || m.angle_increment == 0) {
    heard.wrong = "it says a number that is not finite, no angles, or too many";
    return;
  }
  Seen seen{now, place_->position, {}};
  for (const float range : m.ranges) seen.rays.distances.push_back(DistanceOf(range, m));
  seen.rays.first = place_->yaw + m.angle_min;
  seen.rays.step = m.angle_increment;
  seen.rays.range = m.range_max;
  if (m.angle_increment < 0) {  // clockwise
    std::ranges::reverse(seen.rays.distances);
    seen.rays.first += seen.rays.step * static_cast<double>(m.ranges.size() - 1);
    seen.rays.step = -seen.rays.step;
  }
  const auto round = static_cast<Time>(fleet_.delta * 1e9);
  std::erase_if(seen_, [&](const Seen& s) { return s.at <= now - round; });
  seen_.push_back(std::move(seen));
}

std::string Senses::Unusable(Time now) {
  const std::lock_guard lock(mutex_);
  for (const Heard& heard : heard_) {
    const Topic& topic = heard.topic;
    if (!heard.at) return fmt::format("`{}`: nothing has come on {} yet", topic.port, topic.name);
    if (Seconds(now - *heard.at) > topic.max_age)
      return fmt::format("`{}`: nothing has come on {} for {:.1f} s", topic.port, topic.name,
                         Seconds(now - *heard.at));
    if (!heard.wrong.empty()) return fmt::format("`{}`: {}: {}", topic.port, topic.name, heard.wrong);
  }
  return {};
}

bool Senses::Usable(size_t, uint64_t) { return Unusable(BootTime()).empty(); }

void Senses::Read(size_t robot, uint64_t, koord::node::Cell cell, std::span<Word> words) {
  if (robot != robot_) return;
  const auto port = std::ranges::find(ports_, cell.variable, &Port::variable);
  if (port == ports_.end()) return;
  const std::lock_guard lock(mutex_);
  const auto heard = of_port_[static_cast<size_t>(port - ports_.begin())];
  if (port->role == PortRole::kReached && !heard) {
    words[0] = static_cast<Word>(way_.reached());
    return;
  }
  if (!heard || !heard_[*heard].at) return;
  const std::array<double, 3>& numbers = heard_[*heard].numbers;
  switch (heard_[*heard].topic.carries) {
    case Carries::kOdometry:
      if (!place_) return;
      if (port->role == PortRole::kPosition) sim::WritePoint(place_->position, words.data());
      if (port->role == PortRole::kVelocity) sim::WritePoint(place_->velocity, words.data());
      if (port->role == PortRole::kHeading) words[0] = FromFloat(place_->yaw + 0.0);
      return;
    case Carries::kScan:
      words_.clear();
      for (const Seen& seen : seen_) {
        for (const double x : seen.from) words_.push_back(FromFloat(x + 0.0));
        words_.push_back(sim::EncodeRays(heap_, seen.rays));
      }
      words[0] = heap_.Intern(words_);
      seen_.clear();
      return;
    case Carries::kBool:
      words[0] = static_cast<Word>(numbers[0] != 0);
      return;
    case Carries::kNumber:
      words[0] = FromFloat(numbers[0] + 0.0);
      return;
    case Carries::kPoint:
      return sim::WritePoint(numbers, words.data());
    case Carries::kPose:
    case Carries::kPath:
    case Carries::kTwist:
    case Carries::kTwistStamped:
    case Carries::kAckermann:
      return;
  }
}

void Senses::GoesAlong(const std::vector<Point>& path) {
  const std::lock_guard lock(mutex_);
  if (path.empty()) return way_.Begin({place_ ? place_->position : fleet_.robots[robot_].position});
  way_.Copy(path);
}

std::optional<Senses::Place> Senses::place() {
  const std::lock_guard lock(mutex_);
  return place_;
}

}  // namespace rondo::platform
