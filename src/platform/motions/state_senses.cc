#include "platform/motions/state_senses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "platform/topics.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"
#include "transport/mailbox.h"

namespace rondo::platform {

namespace {

// The same heading, so many full turns on that it is next to another one.
double NextTo(double heading, double other) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return heading + kTurn * std::round((other - heading) / kTurn);
}

}  // namespace

StateSenses::StateSenses(std::vector<BodyTopics> bodies, const std::vector<Signal>& signals, double max_age)
    : bodies_(std::move(bodies)), max_age_(max_age) {
  for (const BodyTopics& body : bodies_) {
    auto& values = values_.emplace_back();
    if (body.base) {
      values.push_back({body.base->x, 0, sources_.size(), false});
      values.push_back({body.base->y, 0, sources_.size(), false});
      if (body.base->yaw) values.push_back({*body.base->yaw, body.base->heading, sources_.size(), true});
      sources_.push_back({body.Full("odom")});
    }
    for (const Joint& joint : body.joints) values.push_back({joint.place, 0, sources_.size(), false});
    if (!body.joints.empty()) sources_.push_back({body.Full("joint_states")});
  }
  auto& heard = values_.emplace_back();
  for (const Signal& signal : signals) {
    heard.push_back({signal.place, 0, sources_.size(), false});
    sources_.push_back({signal.topic});
  }
}

base::Result<bool> StateSenses::Listen(dds::Participant& participant, size_t node, size_t source,
                                       const ros::Message& type, const ros::Qos& qos, const Write& write) {
  auto made = participant.Subscribe(node, sources_[source].topic, type, qos,
                                    [this, source, write](std::string_view bytes, const dds::Received&) {
                                      const std::lock_guard lock(mutex_);
                                      if (write(bytes)) sources_[source].heard = transport::BootTime();
                                    });
  if (!made.ok()) return made.error();
  subscriptions_.push_back(std::move(made).value());
  return true;
}

base::Result<bool> StateSenses::Begin(dds::Participant& participant, size_t node) {
  size_t source = 0;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    const BodyTopics& body = bodies_[b];
    std::vector<Value>& values = values_[b];
    if (body.base) {
      const auto read = [&values](std::string_view bytes) {
        ros::nav_msgs::Odometry m;
        if (!ros::Parse(bytes, m)) return false;
        const auto& pose = m.pose.pose;
        const std::array<double, 3> place{pose.position.x, pose.position.y, YawOf(pose.orientation)};
        if (!std::isfinite(place[0] + place[1] + place[2])) return false;
        for (size_t i = 0; i < place.size() && i < values.size() && values[i].source == values[0].source; ++i)
          values[i].value = values[i].turns ? NextTo(place[i], values[i].value) : place[i];
        return true;
      };
      auto made =
          Listen(participant, node, source++, ros::nav_msgs::Odometry::kMessage, ros::kSensorData, read);
      if (!made.ok()) return made;
    }
    if (body.joints.empty()) continue;
    const size_t first = values.size() - body.joints.size();
    const auto read = [&values, &body, first](std::string_view bytes) {
      ros::sensor_msgs::JointState m;
      if (!ros::Parse(bytes, m) || m.name.size() > m.position.size()) return false;
      std::vector<double> positions;
      for (const Joint& joint : body.joints) {
        const auto it = std::ranges::find(m.name, joint.name);
        if (it == m.name.end()) return false;
        positions.push_back(m.position[static_cast<size_t>(it - m.name.begin())]);
        if (!std::isfinite(positions.back())) return false;
      }
      for (size_t i = 0; i < positions.size(); ++i) values[first + i].value = positions[i];
      return true;
    };
    auto made =
        Listen(participant, node, source++, ros::sensor_msgs::JointState::kMessage, ros::kSensorData, read);
    if (!made.ok()) return made;
  }
  for (Value& value : values_.back()) {
    const auto read = [&value](std::string_view bytes) {
      ros::std_msgs::Float64 m;
      if (!ros::Parse(bytes, m) || !std::isfinite(m.data)) return false;
      value.value = m.data;
      return true;
    };
    auto made = Listen(participant, node, source++, ros::std_msgs::Float64::kMessage, ros::kDefault, read);
    if (!made.ok()) return made;
  }
  return true;
}

std::string StateSenses::Unusable() const {
  const std::lock_guard lock(mutex_);
  const int64_t now = transport::BootTime();
  const size_t signals = sources_.size() - values_.back().size();
  for (size_t s = 0; s < sources_.size(); ++s) {
    const Source& source = sources_[s];
    if (source.heard == 0) return fmt::format("nothing was heard on `{}`", source.topic);
    const double age = transport::Seconds(now - source.heard);
    // Signals hold until they change.
    if (s < signals && age > max_age_) return fmt::format("`{}` is {:.1f} s old", source.topic, age);
  }
  return {};
}

void StateSenses::Read(size_t body, std::vector<double>& scene) const {
  const std::lock_guard lock(mutex_);
  for (const Value& value : values_[body]) scene[value.place] = value.value;
}

int64_t StateSenses::Heard(size_t body) const {
  const std::lock_guard lock(mutex_);
  int64_t oldest = transport::BootTime();
  for (const Value& value : values_[body]) oldest = std::min(oldest, sources_[value.source].heard);
  return oldest;
}

void StateSenses::ReadSignals(std::vector<double>& scene) const {
  const std::lock_guard lock(mutex_);
  for (const Value& value : values_.back()) scene[value.place] = value.value;
}

}  // namespace rondo::platform
