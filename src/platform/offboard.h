#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dds/participant.h"
#include "platform/clock.h"
#include "platform/topics.h"

namespace rondo::platform {

/// What PX4 says of who steers, and when that was, by the clock of the robot.
struct Autopilot {
  bool armed = false, offboard = false;
  Time at = 0;
  /// It is flown by somebody else.
  bool taken() const { return armed && !offboard; }
};

/// Flies a drone by an autopilot (PX4 1.14 and later, over its bridge to DDS): tells it where to fly, with the heartbeat that
/// it wants, asks it to listen, and to arm. What asks is the first order; nothing is sent before.
///
/// Whoever flies it goes on: if it is armed and does not listen, nobody asks. If it was armed once and does not fly for us any more - a
/// pilot has taken over, it lands, something has failed - nobody asks again, and not more than ten times at all.
class Offboard {
 public:
  /// @param clock, origin  outlive it.
  Offboard(const Clock& clock, const sim::Origin& origin, uint8_t system)
      : clock_(clock), origin_(origin), system_(system) {}

  /// Begins. @param setpoints  the topic of the setpoints: the others lie beside it. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node, const std::string& setpoints);

  /// Says where to fly: a point in the frame of the fleet. To be called at least ten times a second.
  /// @param pilot  what the autopilot says of itself; nothing: it says nothing, or not lately.
  /// @param may_ask  an order is in force.
  void Fly(const sim::Point& to, const std::optional<Autopilot>& pilot, bool may_ask);
  /// Reports whether it was asked ten times, and does not do it.
  bool refused() const { return asked_ >= kMost; }

 private:
  void Command(uint32_t command, float first, float second);

  const Clock& clock_;
  const sim::Origin& origin_;
  const uint8_t system_;
  std::unique_ptr<dds::Publisher> modes_, setpoints_, commands_;
  static constexpr int kMost = 10;
  std::optional<Time> began_, asked_at_;
  int asked_ = 0;
  bool flew_ = false;  // it was armed, once
};

}  // namespace rondo::platform
