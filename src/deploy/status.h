#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ros/diagnostic_msgs.h"

namespace rondo::deploy {

/// Is what a robot says of itself on `/diagnostics`, once a second, for people and for `rondo doctor`.
struct RobotStatus {
  std::string robot, program;
  std::string phase;      ///< of the protocol; `waiting` before it begins
  std::string agreement;  ///< digits: all robots of a fleet have the same
  uint64_t epoch = 0, round = 0;
  bool active = false;         ///< it acts
  double median = 0, p99 = 0;  ///< milliseconds until a round is final, lately
  uint64_t fallbacks = 0, blind = 0, late = 0, refused = 0, foreign = 0,
           strange = 0;              ///< datagrams: of them of other files, of other sessions
  std::string sensors;               ///< why its sensors are not usable; empty: they are
  std::vector<std::string> unheard;  ///< robots that it misses
};

/// Returns the status as a message: `ok`, or a warning or an error with the reason in words.
/// @param stamp  nanoseconds since 1970.
ros::diagnostic_msgs::DiagnosticArray MessageOf(const RobotStatus& status, int64_t stamp);
/// Returns the statuses of robots in a message; others are left out.
std::vector<RobotStatus> StatusesOf(const ros::diagnostic_msgs::DiagnosticArray& message);

}  // namespace rondo::deploy
