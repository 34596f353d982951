#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace rondo::deploy {

/// Names what a robot of a choreography does, as its log and the topic `events` have it.
enum class Did : uint8_t {
  kWaits,   ///< it cannot begin yet
  kStarts,  ///< all robots are there: its session begins
  kBegins,  ///< a motion
  kEnds,    ///< a motion
  kSent,    ///< a message was taken by whom it is for
  kTook,    ///< a message
  kBreaks,  ///< its body does not keep the contract of the motion, as far as its own sensors tell
  kLeaves,  ///< it takes no part any more
};
/// Returns `waits`, `starts`, `begins`, `ends`, `sent`, `took`, `breaks` or `leaves`.
std::string_view Name(Did did);

/// Is one thing that a robot did.
struct SessionEvent {
  Did did = Did::kWaits;
  int64_t time = 0;  ///< CLOCK_BOOTTIME, nanoseconds
  std::string robot;
  std::string what;            ///< a motion as it is called, a label, or in words
  std::string peer;            ///< kSent, kTook: the other robot
  std::vector<double> values;  ///< kSent, kTook
  double missed =
      0;  ///< kEnds, kBreaks: by how much the contract was missed, at most, as sensors tell (SI units)
  double late = 0;      ///< kEnds: seconds by which the motion took longer than it may
  std::string outcome;  ///< kLeaves: `runtime::sessions::Name(Outcome)`
};

nlohmann::json ToJson(const SessionEvent& event);
/// Returns nothing if it is none.
std::optional<SessionEvent> EventIn(const nlohmann::json& json);

}  // namespace rondo::deploy
