#include "platform/place.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "platform/topics.h"

namespace rondo::platform {

using sim::Point;

namespace {

constexpr const char* kNotFinite = "it says a number that is not finite";

std::variant<Place, std::string> Checked(const Place& place) {
  if (!Finite(place.position) || !Finite(place.velocity) || !std::isfinite(place.yaw)) return kNotFinite;
  return place;
}

ros::geometry_msgs::Transform TransformOf(const sim::Origin& origin) {
  ros::geometry_msgs::Transform t;
  t.translation = {origin.position[0], origin.position[1], origin.position[2]};
  t.rotation = Turned(origin.yaw);
  return t;
}

Point PointOf(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

Point Exchanged(const Point& v) { return {v[1], v[0], -v[2]}; }

std::variant<Place, std::string> PlaceOf(const std::string& frame, const ros::geometry_msgs::Pose& pose,
                                         const Frames& frames, const std::string& to,
                                         const std::optional<sim::Origin>& origin) {
  ros::nav_msgs::Odometry m;
  m.header.frame_id = frame;
  m.pose.pose = pose;
  return PlaceOf(m, frames, to, origin);
}

std::variant<Place, std::string> PlaceOf(const ros::nav_msgs::Odometry& m, const Frames& frames,
                                         const std::string& to, const std::optional<sim::Origin>& origin) {
  const auto transform = origin ? TransformOf(*origin) : frames.Lookup(to, m.header.frame_id);
  if (!transform)
    return fmt::format("it is told in frame `{}`, and nobody says on /tf where that is in `{}`",
                       m.header.frame_id, to);
  const ros::geometry_msgs::Pose pose = Applied(*transform, m.pose.pose);
  // The velocity is told in the frame of the robot (REP-105, nav_msgs/Odometry).
  const auto velocity = Rotated(pose.orientation, m.twist.twist.linear);
  return Checked(
      {platform::PointOf(pose.position), {velocity.x, velocity.y, velocity.z}, YawOf(pose.orientation)});
}

std::variant<Place, std::string> PlaceOf(const ros::px4_msgs::VehicleOdometry& m, const sim::Origin& origin) {
  constexpr int kNorthEastDown = 1, kBody = 3;
  if (m.pose_frame != kNorthEastDown) return "the autopilot does not know where north is";
  ros::geometry_msgs::Quaternion q;  // takes vectors of the body to north, east, down
  q.w = m.q[0];
  q.x = m.q[1];
  q.y = m.q[2];
  q.z = m.q[3];
  Point velocity = PointOf(m.velocity);
  if (m.velocity_frame == kBody) {
    const auto turned = Rotated(q, {velocity[0], velocity[1], velocity[2]});
    velocity = {turned.x, turned.y, turned.z};
  } else if (m.velocity_frame != kNorthEastDown) {
    return "it says its velocity in a frame that nobody knows";
  }
  Place place{Exchanged(PointOf(m.position)), Exchanged(velocity), std::numbers::pi / 2 - YawOf(q)};
  place.yaw = std::remainder(place.yaw, 2 * std::numbers::pi);
  for (size_t i = 0; i < 3; ++i) place.position[i] += origin.position[i];
  return Checked(place);
}

}  // namespace rondo::platform
