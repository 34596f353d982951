#pragma once

#include <memory>
#include <optional>
#include <string>

#include "dds/participant.h"
#include "platform/clock.h"
#include "platform/topics.h"

namespace rondo::platform {

/// What PX4 says of who steers, and when that was.
struct Autopilot {
  bool armed = false, offboard = false;
};

/// Flies a drone by an autopilot (PX4 1.14 and later, over its bridge to DDS): tells it where to fly, with the heartbeat that
/// it wants, asks it to listen, and to arm. What asks is the first order; nothing is sent before.
///
/// If it listened once and does not any more - a pilot has taken over, it lands, something has failed - nobody asks again.
class Offboard {
 public:
  /// @param clock, origin  outlive it.
  Offboard(const Clock& clock, const sim::Origin& origin, uint8_t system)
      : clock_(clock), origin_(origin), system_(system) {}

  /// Begins. @param setpoints  the topic of the setpoints: the others lie beside it. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node, const std::string& setpoints);

  /// Says where to fly: a point in the frame of the fleet. To be called at least ten times a second.
  /// @param pilot  what the autopilot says of itself; nothing: it says nothing.
  void Fly(const sim::Point& to, const std::optional<Autopilot>& pilot);

 private:
  void Command(uint32_t command, float first, float second);

  const Clock& clock_;
  const sim::Origin& origin_;
  const uint8_t system_;
  std::unique_ptr<dds::Publisher> modes_, setpoints_, commands_;
  std::optional<Time> began_, asked_;
  bool flew_ = false;  // it listened, armed, once
};

}  // namespace rondo::platform
