#pragma once

#include <cstdint>
#include <string_view>

#include "runtime/rounds/parts.h"

/// What the round protocol has to know about a robot and its fleet.
namespace rondo::runtime::rounds {

/// Is a moment or a span of a robot's clock that never steps and runs through suspension (CLOCK_BOOTTIME), in
/// nanoseconds.
using Time = int64_t;

/// Says what happens to a fleet of which a robot is not heard any more.
enum class OnLoss : uint8_t {
  kHalt,   ///< every robot falls back, and the session is over
  kWait,   ///< every robot falls back, until all are heard again
  kEvict,  ///< a majority goes on without it
};

/// Returns `halt`, `wait` or `evict`.
constexpr std::string_view Name(OnLoss on_loss) {
  switch (on_loss) {
    case OnLoss::kHalt:
      return "halt";
    case OnLoss::kWait:
      return "wait";
    case OnLoss::kEvict:
      return "evict";
  }
  return "";
}

/// Holds what a core is made for.
struct Settings {
  uint32_t self = 0;
  uint32_t robots = 1;
  uint64_t incarnation = 1;  ///< greater than in any life before
  uint64_t agreement =
      0;  ///< sum of program, parameters, fleet, parts and version: what all must have in common
  uint64_t session = 0;
  OnLoss on_loss = OnLoss::kHalt;
  Parts parts = PartsOf(Exchange::kAllToAll);
  Time delta = 100'000'000;      ///< from the start of a round to that of the next, at least
  Time lease = 500'000'000;      ///< how long a robot acts after the sending of a frame that was answered
  Time stop_time = 100'000'000;  ///< from the end of a lease until the robot is at rest, or falls back
  uint32_t drift_ppm = 200;      ///< how far clocks run apart, at most, in millionths
  Time resend = 5'000'000;       ///< from a message to its repetition, at first
  /// Without any progress for so long, others are given up or a decision is tried again.
  Time patience = 500'000'000;

  /// Returns how many robots any two majorities need to have one in common.
  uint32_t majority() const { return robots / 2 + 1; }
};

}  // namespace rondo::runtime::rounds
