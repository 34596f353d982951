#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/topics.h"
#include "ros/std_msgs.h"

namespace rondo::platform {

/// What messages of topics say, and messages that say it (`Carries`), in CDR. Whoever reads them gets nothing for bytes that
/// are no message of the topic.

/// Is what a topic of values says: kNumber, kBool (1 or 0), kPoint, and kJointState and kJointTrajectory for the joint of the topic.
using Numbers = std::array<double, 3>;
/// Returns nothing, too, if the joint is not in the message.
std::optional<Numbers> NumbersIn(const Topic& topic, std::string_view bytes);
std::string MessageOf(const Topic& topic, const Numbers& numbers, const ros::std_msgs::Header& header);

/// Is where one joint is to be.
struct JointGoal {
  std::string joint;
  double position = 0;  ///< radians, or metres
  double within = 0;    ///< seconds until it is to be there
};
/// Returns a kJointTrajectory for all of them, with one point, at the last of their times.
std::string MessageOf(const std::vector<JointGoal>& goals, const ros::std_msgs::Header& header);

/// Is which way to go: kPath; kPose has one point.
std::optional<std::vector<sim::Point>> PathIn(Carries carries, std::string_view bytes);
std::string MessageOf(Carries carries, const std::vector<sim::Point>& path,
                      const ros::std_msgs::Header& header);

/// Is how to move: kTwist, kTwistStamped, kAckermann.
std::optional<sim::Twist> TwistIn(Carries carries, std::string_view bytes);
std::string MessageOf(Carries carries, const sim::Twist& twist, const ros::std_msgs::Header& header);

}  // namespace rondo::platform
