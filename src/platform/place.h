#pragma once

#include <string>
#include <variant>

#include "platform/frames.h"
#include "ros/nav_msgs.h"
#include "ros/px4_msgs.h"
#include "sim/fleet/fleet.h"

namespace rondo::platform {

/// Is where a robot is in the frame of the fleet, and how fast: metres, m/s, radians.
struct Place {
  sim::Point position{}, velocity{};
  double yaw = 0;
};

/// Returns where odometry says that a robot is; or, for people, why it does not say that. What it measures lies where
/// `origin` says, or, if there is none, where `frames` say that its frame is in the frame `to`.
std::variant<Place, std::string> PlaceOf(const ros::nav_msgs::Odometry& m, const Frames& frames,
                                         const std::string& to, const std::optional<sim::Origin>& origin);

/// Returns the same for a pose that is told in a frame; nothing is known of the velocity, which is zero.
std::variant<Place, std::string> PlaceOf(const std::string& frame, const ros::geometry_msgs::Pose& pose,
                                         const Frames& frames, const std::string& to,
                                         const std::optional<sim::Origin>& origin);

/// Returns the same for what an autopilot says: it counts north, east and down from `origin`, and turns clockwise from north,
/// while the frame of the fleet has x to the east, y to the north, z up, and turns counter-clockwise from the east (REP-103).
std::variant<Place, std::string> PlaceOf(const ros::px4_msgs::VehicleOdometry& m, const sim::Origin& origin);

/// Convert a vector from north, east, down to east, north, up, or back: the same exchange both ways.
sim::Point Exchanged(const sim::Point& v);

}  // namespace rondo::platform
