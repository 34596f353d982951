#include "platform/motions/state_orders.h"

#include <cmath>

#include "platform/messages.h"
#include "ros/trajectory_msgs.h"
#include "transport/mailbox.h"

namespace rondo::platform {

namespace {

constexpr int64_t kPeriod = 20'000'000;  // nanoseconds
constexpr double kGain = 4;              // of what is missing, per second

}  // namespace

base::Result<bool> StateOrders::Begin(dds::Participant& participant, size_t node) {
  const auto publish = [&](const char* topic, const ros::Message& type,
                           std::unique_ptr<dds::Publisher>& publisher) -> base::Result<bool> {
    auto made = participant.Publish(node, body_.Full(topic), type, ros::kDefault);
    if (!made.ok()) return made.error();
    publisher = std::move(made).value();
    return true;
  };
  if (body_.base) {
    if (auto made = publish("cmd_vel", TypeOf(Carries::kTwist), drives_); !made.ok()) return made;
  }
  if (body_.joints.empty()) return true;
  return publish("joint_trajectory", TypeOf(Carries::kJointTrajectory), joints_);
}

void StateOrders::Follow(int64_t now, const std::vector<double>& wanted, const std::vector<double>& expected,
                         const std::vector<double>& sensed) {
  if (!last_.empty() && now - told_ < kPeriod) return;
  const double dt = last_.empty() ? 0 : transport::Seconds(now - told_);
  if (body_.base) {
    // What was wanted long ago says nothing of a speed.
    constexpr double kLong = 0.2;
    const auto speed = [&](size_t place) {
      const double moves = dt > 0 && dt < kLong ? (wanted[place] - last_[place]) / dt : 0;
      return moves + kGain * (expected[place] - sensed[place]);
    };
    const double vx = speed(body_.base->x), vy = speed(body_.base->y);
    const double yaw = body_.base->yaw ? sensed[*body_.base->yaw] : 0;
    Drive(std::cos(yaw) * vx + std::sin(yaw) * vy, std::cos(yaw) * vy - std::sin(yaw) * vx,
          body_.base->yaw ? speed(*body_.base->yaw) : 0);
  }
  Reach(wanted, transport::Seconds(kPeriod));
  told_ = now;
  last_ = wanted;
}

void StateOrders::Stay(const std::vector<double>& sensed) {
  if (body_.base) Drive(0, 0, 0);
  Reach(sensed, transport::Seconds(kPeriod));
}

void StateOrders::Drive(double forward, double left, double turn) {
  (void)drives_->Write(MessageOf(Carries::kTwist, sim::Twist{forward, left, turn, 0}, {})).ok();
}

void StateOrders::Reach(const std::vector<double>& wanted, double within) {
  if (body_.joints.empty()) return;
  std::vector<JointGoal> goals;
  for (const Joint& joint : body_.joints) goals.push_back({joint.name, wanted[joint.place], within});
  // A time of zero means: as it arrives.
  (void)joints_->Write(MessageOf(goals, {})).ok();
}

}  // namespace rondo::platform
