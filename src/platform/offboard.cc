#include "platform/offboard.h"

#include <cmath>

#include "platform/place.h"
#include "ros/px4_msgs.h"
#include "transport/mailbox.h"

namespace rondo::platform {

using transport::Seconds;

namespace {

constexpr ros::Qos kToAutopilot{.reliable = false, .depth = 1};
// MAV_CMD of MAVLink, and what PX4 means by its second parameter.
constexpr uint32_t kSetMode = 176, kArm = 400;
constexpr float kCustomMode = 1, kOffboard = 6;
// An autopilot listens only to who has spoken for a second (at more than 2 Hz).
constexpr double kBefore = 1.2, kAgain = 1;  // seconds

}  // namespace

base::Result<bool> Offboard::Begin(dds::Participant& participant, size_t node, const std::string& setpoints) {
  const auto publish = [&](const std::string& topic, const ros::Message& type,
                           std::unique_ptr<dds::Publisher>& publisher) -> base::Result<bool> {
    auto made = participant.Publish(node, topic, type, kToAutopilot);
    if (!made.ok()) return made.error();
    publisher = std::move(made).value();
    return true;
  };
  if (auto made = publish(setpoints, ros::px4_msgs::TrajectorySetpoint::kMessage, setpoints_); !made.ok())
    return made;
  if (auto made =
          publish(Beside(setpoints, kOffboardMode), ros::px4_msgs::OffboardControlMode::kMessage, modes_);
      !made.ok())
    return made;
  return publish(Beside(setpoints, kVehicleCommand), ros::px4_msgs::VehicleCommand::kMessage, commands_);
}

void Offboard::Fly(const sim::Point& to, const std::optional<Autopilot>& pilot, bool may_ask) {
  const Time now = clock_.Now();
  const auto micros = static_cast<uint64_t>(clock_.Stamp() / 1000);
  ros::px4_msgs::OffboardControlMode mode;
  mode.timestamp = micros;
  mode.position = true;
  (void)modes_->Publish(mode).ok();
  ros::px4_msgs::TrajectorySetpoint m;
  m.timestamp = micros;
  sim::Point from = to;
  for (size_t i = 0; i < 3; ++i) from[i] -= origin_.position[i];
  const sim::Point down = Exchanged(from);
  for (size_t i = 0; i < 3; ++i) {
    m.position[i] = static_cast<float>(down[i]);
    m.velocity[i] = m.acceleration[i] = m.jerk[i] = NAN;  // as it likes
  }
  m.yaw = m.yawspeed = NAN;
  (void)setpoints_->Publish(m).ok();
  if (!began_) began_ = now;
  if (!pilot) return;
  if (pilot->armed) flew_ = true;
  if (pilot->armed && pilot->offboard) asked_ = 0;
  if (flew_ || !may_ask || refused() || Seconds(now - *began_) < kBefore) return;
  if (asked_at_ && Seconds(now - *asked_at_) < kAgain) return;
  asked_at_ = now;
  ++asked_;
  if (!pilot->offboard)
    Command(kSetMode, kCustomMode, kOffboard);
  else
    Command(kArm, 1, 0);
}

void Offboard::Command(uint32_t command, float first, float second) {
  ros::px4_msgs::VehicleCommand m;
  m.timestamp = static_cast<uint64_t>(clock_.Stamp() / 1000);
  m.param1 = first;
  m.param2 = second;
  m.command = command;
  m.target_system = system_;
  m.target_component = m.source_system = 1;
  m.source_component = 1;
  m.from_external = true;
  (void)commands_->Publish(m).ok();
}

}  // namespace rondo::platform
