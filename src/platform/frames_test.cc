#include "platform/frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "platform/topics.h"

namespace rondo::platform {
namespace {

using ros::geometry_msgs::Pose;
using ros::geometry_msgs::TransformStamped;

TransformStamped Placed(const std::string& child, const std::string& parent, double x, double y, double yaw) {
  TransformStamped t;
  t.header.frame_id = parent;
  t.child_frame_id = child;
  t.transform.translation.x = x;
  t.transform.translation.y = y;
  t.transform.rotation = Turned(yaw);
  return t;
}

Frames Heard(std::vector<TransformStamped> transforms) {
  Frames frames;
  ros::tf2_msgs::TFMessage message;
  message.transforms = std::move(transforms);
  frames.Hear(message);
  return frames;
}

Pose At(double x, double y, double yaw) {
  Pose pose;
  pose.position.x = x;
  pose.position.y = y;
  pose.orientation = Turned(yaw);
  return pose;
}

constexpr double kQuarter = std::numbers::pi / 2;

TEST(Frames, AFrameLiesInItselfAsItIs) {
  const auto transform = Frames().Lookup("map", "/map");
  ASSERT_TRUE(transform);
  const Pose pose = Applied(*transform, At(1, 2, 0.3));
  EXPECT_DOUBLE_EQ(pose.position.x, 1);
  EXPECT_DOUBLE_EQ(pose.position.y, 2);
  EXPECT_NEAR(YawOf(pose.orientation), 0.3, 1e-12);
}

// By hand: odom lies at (10, 0) in map, turned by a quarter; what is one metre ahead there is one metre to the left here.
TEST(Frames, PosesAreTurnedAndMoved) {
  const Frames frames = Heard({Placed("odom", "map", 10, 0, kQuarter)});
  const auto transform = frames.Lookup("map", "odom");
  ASSERT_TRUE(transform);
  const Pose pose = Applied(*transform, At(1, 0, 0));
  EXPECT_NEAR(pose.position.x, 10, 1e-12);
  EXPECT_NEAR(pose.position.y, 1, 1e-12);
  EXPECT_NEAR(YawOf(pose.orientation), kQuarter, 1e-12);
}

TEST(Frames, ChainsLeadUpAndDown) {
  const Frames frames = Heard({Placed("odom", "map", 10, 0, kQuarter), Placed("base", "odom", 2, 0, 0),
                               Placed("camera", "map", 0, 5, 0)});
  const auto down = frames.Lookup("map", "base");
  ASSERT_TRUE(down);
  EXPECT_NEAR(Applied(*down, At(0, 0, 0)).position.y, 2, 1e-12);
  const auto across = frames.Lookup("camera", "base");
  ASSERT_TRUE(across);
  const Pose pose = Applied(*across, At(0, 0, 0));
  EXPECT_NEAR(pose.position.x, 10, 1e-12);
  EXPECT_NEAR(pose.position.y, -3, 1e-12);
  EXPECT_FALSE(frames.Lookup("map", "nowhere"));
}

TEST(Frames, CirclesAndNonsenseAreNoPlaces) {
  EXPECT_FALSE(Heard({Placed("a", "b", 0, 0, 0), Placed("b", "a", 0, 0, 0)}).Lookup("map", "a"));
  TransformStamped none = Placed("odom", "map", 0, 0, 0);
  none.transform.rotation.w = 0;
  EXPECT_FALSE(Heard({none}).Lookup("map", "odom"));
  EXPECT_FALSE(Heard({Placed("odom", "map", NAN, 0, 0)}).Lookup("map", "odom"));
}

}  // namespace
}  // namespace rondo::platform
