#include "platform/place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "platform/topics.h"

namespace rondo::platform {
namespace {

constexpr double kPi = std::numbers::pi;

// A drone 3 m north, 2 m east and 5 m above where it started, that flies east at 1 m/s with its nose to the east. Its
// attitude takes its nose (x forward) to the east: a turn by a quarter around down.
ros::px4_msgs::VehicleOdometry East() {
  ros::px4_msgs::VehicleOdometry m;
  m.pose_frame = 1;
  m.position = {3, 2, -5};
  const auto half = static_cast<float>(std::sqrt(0.5));
  m.q = {half, 0, 0, half};
  m.velocity_frame = 1;
  m.velocity = {0, 1, 0};
  return m;
}

TEST(Autopilot, NorthIsYAndUpIsZ) {
  const auto said = PlaceOf(East(), {{10, 20, 1}, 0.7});
  ASSERT_TRUE(std::holds_alternative<Place>(said));
  const Place& place = std::get<Place>(said);
  EXPECT_NEAR(place.position[0], 10 + 2, 1e-6);
  EXPECT_NEAR(place.position[1], 20 + 3, 1e-6);
  EXPECT_NEAR(place.position[2], 1 + 5, 1e-6);
  EXPECT_NEAR(place.velocity[0], 1, 1e-6);
  EXPECT_NEAR(place.velocity[1], 0, 1e-6);
  EXPECT_NEAR(place.yaw, 0, 1e-6);  // to the east (REP-103)
  ros::px4_msgs::VehicleOdometry north = East();
  north.q = {1, 0, 0, 0};
  EXPECT_NEAR(std::get<Place>(PlaceOf(north, {})).yaw, kPi / 2, 1e-6);
}

TEST(Autopilot, VelocitiesOfTheBodyAreTurned) {
  ros::px4_msgs::VehicleOdometry m = East();
  m.velocity_frame = 3;
  m.velocity = {2, 0.5, 1};  // forward, right, down: east, south, down
  const Place place = std::get<Place>(PlaceOf(m, {}));
  EXPECT_NEAR(place.velocity[0], 2, 1e-6);
  EXPECT_NEAR(place.velocity[1], -0.5, 1e-6);
  EXPECT_NEAR(place.velocity[2], -1, 1e-6);
}

TEST(Autopilot, SaysWhyItCannotBePlaced) {
  ros::px4_msgs::VehicleOdometry m = East();
  m.pose_frame = 2;
  EXPECT_TRUE(std::holds_alternative<std::string>(PlaceOf(m, {})));
  m = East();
  m.velocity_frame = 2;
  EXPECT_TRUE(std::holds_alternative<std::string>(PlaceOf(m, {})));
  m = East();
  m.position[1] = NAN;
  EXPECT_TRUE(std::holds_alternative<std::string>(PlaceOf(m, {})));
  m = East();
  m.q[0] = NAN;
  EXPECT_TRUE(std::holds_alternative<std::string>(PlaceOf(m, {})));
}

TEST(Odometry, AnOriginStandsForTransforms) {
  ros::nav_msgs::Odometry m;
  m.header.frame_id = "bot0/odom";
  m.pose.pose.position.x = 2;
  m.pose.pose.orientation.w = 1;
  m.twist.twist.linear.x = 1;
  EXPECT_TRUE(std::holds_alternative<std::string>(PlaceOf(m, {}, "map", std::nullopt)));
  const Place place = std::get<Place>(PlaceOf(m, {}, "map", sim::Origin{{5, 6, 0}, kPi / 2}));
  EXPECT_NEAR(place.position[0], 5, 1e-9);
  EXPECT_NEAR(place.position[1], 8, 1e-9);
  EXPECT_NEAR(place.velocity[1], 1, 1e-9);
  EXPECT_NEAR(place.yaw, kPi / 2, 1e-9);
}

}  // namespace
}  // namespace rondo::platform
