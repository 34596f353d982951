#include "platform/simulated_autopilot.h"

#include <cmath>
#include <numbers>

#include "platform/place.h"
#include "platform/topics.h"
#include "ros/px4_msgs.h"

namespace rondo::platform {

namespace {

constexpr uint32_t kSetMode = 176, kArm = 400;
constexpr ros::Qos kFrom{.reliable = false, .transient_local = true, .depth = 1};
constexpr ros::Qos kTo{.reliable = false, .depth = 1};
constexpr double kLost = 0.5;    // seconds without a heartbeat until it does not listen any more
constexpr double kSpoken = 1.0;  // seconds of heartbeats before it listens

}  // namespace

base::Result<bool> SimulatedAutopilot::Begin(dds::Participant& participant, size_t node,
                                             const std::string& odometry, const std::string& setpoints) {
  auto says = participant.Publish(node, odometry, ros::px4_msgs::VehicleOdometry::kMessage, kFrom);
  if (!says.ok()) return says.error();
  odometry_ = std::move(says).value();
  auto modes = participant.Publish(node, Beside(odometry, kControlMode),
                                   ros::px4_msgs::VehicleControlMode::kMessage, kFrom);
  if (!modes.ok()) return modes.error();
  modes_ = std::move(modes).value();
  const auto hear = [&](const std::string& topic, const ros::Message& type,
                        dds::Receive receive) -> base::Result<bool> {
    auto made = participant.Subscribe(node, topic, type, kTo, std::move(receive));
    if (!made.ok()) return made.error();
    subscriptions_.push_back(std::move(made).value());
    return true;
  };
  if (auto made = hear(setpoints, ros::px4_msgs::TrajectorySetpoint::kMessage,
                       [this](std::string_view bytes, const dds::Received&) {
                         ros::px4_msgs::TrajectorySetpoint m;
                         if (!ros::Parse(bytes, m)) return;
                         sim::Point to = Exchanged({m.position[0], m.position[1], m.position[2]});
                         for (size_t i = 0; i < 3; ++i) to[i] += origin_.position[i];
                         const std::lock_guard lock(mutex_);
                         if (Finite(to)) setpoint_ = to;
                       });
      !made.ok())
    return made;
  if (auto made = hear(Beside(setpoints, kOffboardMode), ros::px4_msgs::OffboardControlMode::kMessage,
                       [this](std::string_view bytes, const dds::Received&) {
                         ros::px4_msgs::OffboardControlMode m;
                         const std::lock_guard lock(mutex_);
                         if (ros::Parse(bytes, m) && m.position) heartbeat_ = true;
                       });
      !made.ok())
    return made;
  return hear(Beside(setpoints, kVehicleCommand), ros::px4_msgs::VehicleCommand::kMessage,
              [this](std::string_view bytes, const dds::Received&) {
                ros::px4_msgs::VehicleCommand m;
                if (!ros::Parse(bytes, m) || m.target_system != system_) return;
                const std::lock_guard lock(mutex_);
                commands_.push_back({m.command, m.param1, m.param2});
              });
}

void SimulatedAutopilot::Step(double dt) {
  std::optional<sim::Point> to;
  {
    const std::lock_guard lock(mutex_);
    silent_for_ = std::exchange(heartbeat_, false) ? 0 : silent_for_ + dt;
    spoken_for_ = silent_for_ < kLost ? spoken_for_ + dt : 0;
    for (const Command& c : std::exchange(commands_, {})) Obey(c.command, c.first, c.second);
    if (silent_for_ >= kLost && offboard_) {
      offboard_ = false;  // it holds
      to = body_.position();
    }
    if (armed_ && offboard_) to = setpoint_;
  }
  if (to && body_.path() != std::vector<sim::Point>{*to}) body_.Follow({*to});
}

void SimulatedAutopilot::Obey(uint32_t command, float first, float second) {
  if (command == kSetMode && first == 1 && second == 6 && spoken_for_ >= kSpoken) offboard_ = true;
  if (command == kArm) armed_ = first == 1;
}

void SimulatedAutopilot::Tell(int64_t stamp) {
  ros::px4_msgs::VehicleOdometry m;
  m.timestamp = m.timestamp_sample = static_cast<uint64_t>(stamp / 1000);
  m.pose_frame = 1;
  m.velocity_frame = 1;
  sim::Point p = body_.position();
  for (size_t i = 0; i < 3; ++i) p[i] -= origin_.position[i];
  p = Exchanged(p);
  const sim::Point v = Exchanged(body_.velocity());
  for (size_t i = 0; i < 3; ++i) {
    m.position[i] = static_cast<float>(p[i]);
    m.velocity[i] = static_cast<float>(v[i]);
  }
  const auto q = Turned(std::numbers::pi / 2 - body_.yaw());  // level
  m.q = {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
  (void)odometry_->Publish(m).ok();
  ros::px4_msgs::VehicleControlMode mode;
  mode.timestamp = m.timestamp;
  mode.flag_armed = armed_;
  mode.flag_control_offboard_enabled = offboard_;
  mode.flag_control_position_enabled = true;
  (void)modes_->Publish(mode).ok();
}

}  // namespace rondo::platform
