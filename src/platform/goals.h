#pragma once

#include <array>
#include <optional>
#include <set>

#include "ros/action_msgs.h"

namespace rondo::platform {

/// Follows what becomes of the goals of one robot, as the status of Nav2's action tells it. Goals have no name in an order: what
/// an order began is told by that nobody knew it before, and by that it was accepted later, if clocks differ by half a second at
/// most. So a robot has to be the only one who sends goals; one that was accepted in the last half second before an order, and told
/// behind it, is taken for its own. Not thread-safe.
class Goals {
 public:
  /// Says that the robot is told to go somewhere else at this time, in nanoseconds since 1970.
  void Begin(int64_t stamp);
  /// Takes in what a message says.
  void Hear(const ros::action_msgs::GoalStatusArray& message);
  /// Reports whether the robot is where it was told to go last; nothing before it was told anything.
  std::optional<bool> reached() const { return reached_; }

 private:
  using Id = std::array<uint8_t, 16>;
  static constexpr size_t kMost = 10'000;  // that are remembered

  int64_t since_ = 0;
  std::set<Id> known_;     // of the orders before, and of others
  std::optional<Id> own_;  // of this one
  std::optional<bool> reached_;
};

}  // namespace rondo::platform
