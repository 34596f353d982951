#include "platform/messages.h"

#include <gtest/gtest.h>

#include "ros/ackermann_msgs.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/trajectory_msgs.h"

namespace rondo::platform {
namespace {

Topic Of(Carries carries, std::string joint = {}) {
  Topic topic;
  topic.carries = carries;
  topic.joint = std::move(joint);
  topic.within = 1.5;
  return topic;
}

const ros::std_msgs::Header kHeader = HeaderOf("map", 3'000'000'007);

TEST(Messages, SayWhatTheyWereMadeOf) {
  for (const Carries carries :
       {Carries::kNumber, Carries::kBool, Carries::kPoint, Carries::kJointState, Carries::kJointTrajectory}) {
    const Numbers said = carries == Carries::kPoint ? Numbers{1, 2, -3} : Numbers{1, 0, 0};
    const Topic topic = Of(carries, "elbow");
    EXPECT_EQ(NumbersIn(topic, MessageOf(topic, said, kHeader)), said) << static_cast<int>(carries);
    EXPECT_FALSE(NumbersIn(topic, "").has_value());
  }
  const std::vector<sim::Point> path{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(PathIn(Carries::kPath, MessageOf(Carries::kPath, path, kHeader)), path);
  EXPECT_EQ(PathIn(Carries::kPose, MessageOf(Carries::kPose, path, kHeader)), std::vector{path[0]});
  for (const Carries carries : {Carries::kTwist, Carries::kTwistStamped, Carries::kAckermann}) {
    const bool steers = carries == Carries::kAckermann;
    const sim::Twist twist = steers ? sim::Twist{0.5, 0, 0, 0.125} : sim::Twist{0.5, 0.25, -1, 0};
    const auto read = TwistIn(carries, MessageOf(carries, twist, kHeader));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(std::tie(read->forward, read->left, read->turn, read->steer),
              std::tie(twist.forward, twist.left, twist.turn, twist.steer));
  }
}

// By the message itself, as a driver reads it.
TEST(Messages, TrajectoriesHaveOnePointForAllJoints) {
  ros::trajectory_msgs::JointTrajectory m;
  ASSERT_TRUE(ros::Parse(MessageOf({{"shoulder", 0.5, 1.5}, {"elbow", -1, 0.25}}, kHeader), m));
  EXPECT_EQ(m.joint_names, (std::vector<std::string>{"shoulder", "elbow"}));
  ASSERT_EQ(m.points.size(), 1U);
  EXPECT_EQ(m.points[0].positions, (std::vector<double>{0.5, -1}));
  EXPECT_EQ(m.points[0].time_from_start.sec, 1);
  EXPECT_EQ(m.points[0].time_from_start.nanosec, 500'000'000U);
  EXPECT_EQ(m.header.stamp.sec, 3);
  EXPECT_EQ(m.header.stamp.nanosec, 7U);
}

TEST(Messages, JointsAreFoundByName) {
  ros::sensor_msgs::JointState m;
  m.name = {"shoulder", "elbow", "wrist"};
  m.position = {0.5, -1};  // of the wrist nothing is said
  const std::string bytes = ros::Serialised(m);
  EXPECT_EQ(NumbersIn(Of(Carries::kJointState, "elbow"), bytes), (Numbers{-1, 0, 0}));
  EXPECT_FALSE(NumbersIn(Of(Carries::kJointState, "wrist"), bytes).has_value());
  EXPECT_FALSE(NumbersIn(Of(Carries::kJointState, "hand"), bytes).has_value());
  EXPECT_FALSE(NumbersIn(Of(Carries::kJointTrajectory, "elbow"),
                         ros::Serialised(ros::trajectory_msgs::JointTrajectory()))
                   .has_value());
}

TEST(Messages, WhatIsNotFiniteIsNoOrder) {
  EXPECT_FALSE(PathIn(Carries::kPath, MessageOf(Carries::kPath, {{0, NAN, 0}}, kHeader)).has_value());
  EXPECT_FALSE(
      TwistIn(Carries::kTwist, MessageOf(Carries::kTwist, {INFINITY, 0, 0, 0}, kHeader)).has_value());
}

}  // namespace
}  // namespace rondo::platform
