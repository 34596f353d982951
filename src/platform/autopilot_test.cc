#include <gtest/gtest.h>

#include <atomic>

#include "dds/domain_test.h"
#include "platform/offboard.h"
#include "platform/simulated_autopilot.h"
#include "ros/px4_msgs.h"

namespace rondo::platform {
namespace {

using dds::Eventually;
using dds::Participant;

constexpr const char *kOdometry = "/drone/fmu/out/vehicle_odometry",
                     *kSetpoints = "/drone/fmu/in/trajectory_setpoint";
const sim::Origin kOrigin{{10, 20, 0}, 0};

std::unique_ptr<Participant> Opened() { return Participant::Open(dds::TestNetwork()).value(); }

// Hears one topic.
template <class M>
struct Ear {
  std::mutex mutex;
  std::vector<M> heard;
  std::unique_ptr<dds::Subscription> subscription;
  Ear(Participant& participant, size_t node, const std::string& topic) {
    subscription = participant
                       .Subscribe(node, topic, M::kMessage, {.reliable = false},
                                  [this](std::string_view bytes, const dds::Received&) {
                                    M m;
                                    const std::lock_guard lock(mutex);
                                    if (ros::Parse(bytes, m)) heard.push_back(m);
                                  })
                       .value();
  }
  std::vector<M> Take() {
    const std::lock_guard lock(mutex);
    return std::exchange(heard, {});
  }
};

class Offboards : public testing::Test {
 protected:
  Offboards()
      : participant_(Opened()),
        node_(participant_->AddNode({"/drone", "test"})),
        setpoints_(*participant_, node_, kSetpoints),
        commands_(*participant_, node_, Beside(kSetpoints, kVehicleCommand)),
        offboard_(clock_, kOrigin, 7) {
    EXPECT_TRUE(offboard_.Begin(*participant_, node_, kSetpoints).ok());
    EXPECT_TRUE(Eventually(
        [&] { return setpoints_.subscription->matched() > 0 && commands_.subscription->matched() > 0; }));
  }
  // For so many seconds.
  void Fly(double seconds, const std::optional<Autopilot>& pilot) {
    for (int i = 0; i < 50 * seconds; ++i) {
      offboard_.Fly({12, 23, 5}, pilot, true);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  std::vector<uint32_t> Commands() {
    std::vector<uint32_t> all;
    for (const auto& c : commands_.Take()) {
      EXPECT_EQ(c.target_system, 7);
      all.push_back(c.command);
    }
    return all;
  }

  std::unique_ptr<Participant> participant_;
  size_t node_;
  const Clock clock_{false};
  Ear<ros::px4_msgs::TrajectorySetpoint> setpoints_;
  Ear<ros::px4_msgs::VehicleCommand> commands_;
  Offboard offboard_;
};

TEST_F(Offboards, SetpointsAreNorthEastDownFromTheOrigin) {
  Fly(0.1, std::nullopt);
  EXPECT_TRUE(Eventually([&] {
    const std::lock_guard lock(setpoints_.mutex);
    return !setpoints_.heard.empty();
  }));
  const auto heard = setpoints_.Take();
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard[0].position, (std::array<float, 3>{3, 2, -5}));
  EXPECT_TRUE(std::isnan(heard[0].velocity[0]) && std::isnan(heard[0].yaw));
}

TEST_F(Offboards, AsksAfterASecondAndNotAgainWhenAPilotTakesOver) {
  Fly(0.8, Autopilot{false, false, 0});
  EXPECT_TRUE(Commands().empty());
  Fly(0.8, Autopilot{false, false, 0});
  EXPECT_TRUE(Eventually([&] {
    const std::lock_guard lock(commands_.mutex);
    return !commands_.heard.empty();
  }));
  EXPECT_EQ(Commands(), std::vector<uint32_t>{176});  // MAV_CMD_DO_SET_MODE
  Fly(1.2, Autopilot{false, true, 0});
  EXPECT_EQ(Commands(), std::vector<uint32_t>{400});  // MAV_CMD_COMPONENT_ARM_DISARM
  EXPECT_FALSE(offboard_.refused());
  Fly(0.1, Autopilot{true, true, 0});
  Fly(1.5, Autopilot{true, false, 0});
  Fly(1.2, Autopilot{false, true, 0});
  EXPECT_TRUE(Commands().empty());
}

TEST_F(Offboards, NeverTakesADroneFromWhoFliesIt) {
  Fly(2.5, Autopilot{true, false, 0});
  Fly(0.5, Autopilot{false, false, 0});  // it has landed: by hand
  EXPECT_TRUE(Commands().empty());
}

TEST_F(Offboards, AsksOnlyWhileAnOrderIsInForce) {
  for (int i = 0; i < 125; ++i) {
    offboard_.Fly({12, 23, 5}, Autopilot{false, false, 0}, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(Commands().empty());
}

// The double that simulations fly: it has to be as strict as what it stands for.
TEST(SimulatedAutopilots, ListenOnlyToWhoSpeaksAndArms) {
  const auto participant = Opened();
  const size_t node = participant->AddNode({"/drone", "driver"});
  const auto body = sim::MakeBody("quadrotor");
  body->Place({10, 20, 1}, 0);
  SimulatedAutopilot autopilot(*body, kOrigin, 7);
  ASSERT_TRUE(autopilot.Begin(*participant, node, kOdometry, kSetpoints).ok());
  Ear<ros::px4_msgs::VehicleOdometry> odometry(*participant, node, kOdometry);
  Ear<ros::px4_msgs::VehicleControlMode> modes(*participant, node, Beside(kOdometry, kControlMode));
  const Clock clock(false);
  Offboard offboard(clock, kOrigin, 7);
  ASSERT_TRUE(offboard.Begin(*participant, node, kSetpoints).ok());
  ASSERT_TRUE(Eventually([&] { return modes.subscription->matched() > 0; }));
  std::optional<Autopilot> pilot;
  const auto pass = [&](double seconds, bool speaks) {
    for (int i = 0; i < 50 * seconds; ++i) {
      if (speaks) offboard.Fly({12, 23, 5}, pilot, true);
      autopilot.Step(0.02);
      autopilot.Tell(1'000'000);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      for (const auto& m : modes.Take()) pilot = Autopilot{m.flag_armed, m.flag_control_offboard_enabled, 0};
    }
  };
  pass(0.5, true);
  EXPECT_EQ(body->path(), (std::vector<sim::Point>{{10, 20, 1}}));  // not yet
  pass(3.5, true);
  ASSERT_TRUE(pilot && pilot->armed && pilot->offboard);
  EXPECT_EQ(body->path(), (std::vector<sim::Point>{{12, 23, 5}}));
  const auto said = odometry.Take();
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said[0].position, (std::array<float, 3>{0, 0, -1}));
  pass(1, false);
  EXPECT_FALSE(pilot->offboard);  // it holds
  EXPECT_EQ(body->path(), (std::vector<sim::Point>{body->position()}));
}

}  // namespace
}  // namespace rondo::platform
