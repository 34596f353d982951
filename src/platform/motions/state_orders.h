#pragma once

#include <memory>
#include <vector>

#include "dds/participant.h"
#include "platform/motions/body_topics.h"

namespace rondo::platform {

/// Tells a robot where to be, from moment to moment: its base how fast to move, its joints where to be next. Not thread-safe.
class StateOrders {
 public:
  explicit StateOrders(BodyTopics body) : body_(std::move(body)) {}

  /// Begins. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node);

  /// Is how long, in seconds, it takes until a robot is where it is told to be: one period of orders, and what is on the way.
  static constexpr double kAhead = 0.025;

  /// Says that the robot is to be where the scene `wanted` has it in `kAhead` seconds. Now it should be where `expected` has it,
  /// and is where `sensed` has it. To be called again and again, with the time (CLOCK_BOOTTIME, nanoseconds): speaks every 20 ms.
  /// The base is told the speed at which `wanted` moves, and a part of what is missing; the drivers of bases stop them when they
  /// hear nothing for half a second.
  void Follow(int64_t now, const std::vector<double>& wanted, const std::vector<double>& expected,
              const std::vector<double>& sensed);
  /// Tells the robot to stay where it is.
  void Stay(const std::vector<double>& sensed);

 private:
  void Drive(double forward, double left, double turn);
  void Reach(const std::vector<double>& wanted, double within);

  const BodyTopics body_;
  std::unique_ptr<dds::Publisher> drives_, joints_;
  int64_t told_ = 0;
  std::vector<double> last_;  // where it was wanted then
};

}  // namespace rondo::platform
