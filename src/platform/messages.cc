#include "platform/messages.h"

#include <algorithm>

#include "ros/ackermann_msgs.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"
#include "ros/trajectory_msgs.h"

namespace rondo::platform {

using sim::Point;
using sim::Twist;

namespace {

template <class M>
std::optional<M> Parsed(std::string_view bytes) {
  M message;
  if (!ros::Parse(bytes, message)) return std::nullopt;
  return message;
}

std::optional<Numbers> Joint(const std::string& joint, const std::vector<std::string>& names,
                             const std::vector<double>& positions) {
  const auto at = static_cast<size_t>(std::ranges::find(names, joint) - names.begin());
  if (at >= std::min(names.size(), positions.size())) return std::nullopt;
  return Numbers{positions[at], 0, 0};
}

ros::geometry_msgs::Pose PoseAt(const Point& p) {
  ros::geometry_msgs::Pose pose;
  pose.position = PointOf(p);
  pose.orientation.w = 1;
  return pose;
}

ros::builtin_interfaces::Duration DurationOf(double seconds) {
  ros::builtin_interfaces::Duration duration;
  duration.sec = static_cast<int32_t>(seconds);
  duration.nanosec = static_cast<uint32_t>((seconds - duration.sec) * 1e9);
  return duration;
}

}  // namespace

std::optional<Numbers> NumbersIn(const Topic& topic, std::string_view bytes) {
  switch (topic.carries) {
    case Carries::kBool:
      if (const auto m = Parsed<ros::std_msgs::Bool>(bytes)) return Numbers{m->data ? 1.0 : 0.0, 0, 0};
      return std::nullopt;
    case Carries::kNumber:
      if (const auto m = Parsed<ros::std_msgs::Float64>(bytes)) return Numbers{m->data, 0, 0};
      return std::nullopt;
    case Carries::kPoint:
      if (const auto m = Parsed<ros::geometry_msgs::Point>(bytes)) return PointOf(*m);
      return std::nullopt;
    case Carries::kJointState:
      if (const auto m = Parsed<ros::sensor_msgs::JointState>(bytes))
        return Joint(topic.joint, m->name, m->position);
      return std::nullopt;
    case Carries::kJointTrajectory:
      if (const auto m = Parsed<ros::trajectory_msgs::JointTrajectory>(bytes); m && !m->points.empty())
        return Joint(topic.joint, m->joint_names, m->points.back().positions);
      return std::nullopt;
    default:
      return std::nullopt;
  }
}

std::string MessageOf(const Topic& topic, const Numbers& numbers, const ros::std_msgs::Header& header) {
  switch (topic.carries) {
    case Carries::kBool: {
      ros::std_msgs::Bool m;
      m.data = numbers[0] != 0;
      return ros::Serialised(m);
    }
    case Carries::kPoint:
      return ros::Serialised(PointOf(numbers));
    case Carries::kJointState: {
      ros::sensor_msgs::JointState m;
      m.header = header;
      m.name = {topic.joint};
      m.position = {numbers[0]};
      return ros::Serialised(m);
    }
    case Carries::kJointTrajectory:
      return MessageOf({{topic.joint, numbers[0], topic.within}}, header);
    default: {
      ros::std_msgs::Float64 m;
      m.data = numbers[0];
      return ros::Serialised(m);
    }
  }
}

std::string MessageOf(const std::vector<JointGoal>& goals, const ros::std_msgs::Header& header) {
  ros::trajectory_msgs::JointTrajectory m;
  m.header = header;
  auto& point = m.points.emplace_back();
  double within = 0;
  for (const JointGoal& goal : goals) {
    m.joint_names.push_back(goal.joint);
    point.positions.push_back(goal.position);
    within = std::max(within, goal.within);
  }
  point.time_from_start = DurationOf(within);
  return ros::Serialised(m);
}

std::optional<std::vector<Point>> PathIn(Carries carries, std::string_view bytes) {
  std::vector<Point> path;
  if (carries == Carries::kPose) {
    const auto m = Parsed<ros::geometry_msgs::PoseStamped>(bytes);
    if (!m) return std::nullopt;
    path = {PointOf(m->pose.position)};
  } else {
    const auto m = Parsed<ros::nav_msgs::Path>(bytes);
    if (!m) return std::nullopt;
    for (const auto& pose : m->poses) path.push_back(PointOf(pose.pose.position));
  }
  if (!std::ranges::all_of(path, Finite)) return std::nullopt;
  return path;
}

std::string MessageOf(Carries carries, const std::vector<Point>& path, const ros::std_msgs::Header& header) {
  if (carries == Carries::kPose) {
    ros::geometry_msgs::PoseStamped m;
    m.header = header;
    m.pose = PoseAt(path.front());
    return ros::Serialised(m);
  }
  ros::nav_msgs::Path m;
  m.header = header;
  for (const Point& p : path) {
    auto& pose = m.poses.emplace_back();
    pose.header = header;
    pose.pose = PoseAt(p);
  }
  return ros::Serialised(m);
}

std::optional<Twist> TwistIn(Carries carries, std::string_view bytes) {
  Twist twist;
  if (carries == Carries::kAckermann) {
    const auto m = Parsed<ros::ackermann_msgs::AckermannDriveStamped>(bytes);
    if (!m) return std::nullopt;
    twist = {m->drive.speed, 0, 0, m->drive.steering_angle};
  } else {
    std::optional<ros::geometry_msgs::Twist> m;
    if (carries == Carries::kTwist) {
      m = Parsed<ros::geometry_msgs::Twist>(bytes);
    } else if (const auto stamped = Parsed<ros::geometry_msgs::TwistStamped>(bytes)) {
      m = stamped->twist;
    }
    if (!m) return std::nullopt;
    twist = {m->linear.x, m->linear.y, m->angular.z, 0};
  }
  if (!std::isfinite(twist.forward + twist.left + twist.turn + twist.steer)) return std::nullopt;
  return twist;
}

std::string MessageOf(Carries carries, const Twist& twist, const ros::std_msgs::Header& header) {
  if (carries == Carries::kAckermann) {
    ros::ackermann_msgs::AckermannDriveStamped m;
    m.header = header;
    m.drive.speed = static_cast<float>(twist.forward);
    m.drive.steering_angle = static_cast<float>(twist.steer);
    return ros::Serialised(m);
  }
  ros::geometry_msgs::TwistStamped m;
  m.header = header;
  m.twist.linear.x = twist.forward;
  m.twist.linear.y = twist.left;
  m.twist.angular.z = twist.turn;
  return carries == Carries::kTwist ? ros::Serialised(m.twist) : ros::Serialised(m);
}

}  // namespace rondo::platform
