#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace rondo::sim::motions {

/// Names what can go wrong in a run of a choreography.
enum class Wrong : uint8_t {
  kCollision,     ///< bodies touch each other, or an obstacle
  kFootprint,     ///< the space that motions ask for touches that of others, or an obstacle
  kPrecondition,  ///< a motion begins where it may not
  kAssumption,    ///< what a motion assumes of others does not hold
  kContract,      ///< a controller does not keep the contract of its motion
  kRegion,        ///< the space that a motion asks for is not in the region of its thread
  kFork,          ///< the space that a motion asks for is in the region of another thread
  kGuarantee,     ///< a thread does not keep what it guarantees
  kMessage,       ///< the guard of a message does not hold, or it does not carry what it promises
  kOrder,         ///< a message is not what the choreography says comes next
  kChoice,        ///< no alternative of a choice holds, or a value does not exist
  kWaiting,       ///< time passes for a robot that makes no motion
  kStuck,         ///< everybody waits for a message that nobody sends
  kNoTime,        ///< things happen without end, and no time passes
  kGaveUp,        ///< a robot (no simulated one) could not go on, or lost the others
};

/// Returns the name of the kind, as reports and JSON have it.
std::string_view Name(Wrong wrong);

/// Says what was wrong, when first, and how often it came about.
struct Incident {
  Wrong wrong = Wrong::kCollision;
  std::string what;
  double first = 0;  ///< seconds
  uint64_t count = 1;
};

/// Is told of something that is wrong, and what it is.
using Tell = std::function<void(Wrong, const std::string& what)>;

/// Names why a run ended.
enum class Curtain : uint8_t {
  kEnd,     ///< every robot is at its end
  kTime,    ///< the time was over
  kFailed,  ///< a robot could not go on, or nobody could
  kLost,    ///< no curve was found that keeps a contract, so that nobody can tell what would follow
  kInterrupted,
};
std::string_view Name(Curtain curtain);

/// Holds what happened in a run.
struct ChoreographyReport {
  Curtain ended = Curtain::kTime;
  double time = 0;  ///< seconds, virtual
  uint64_t messages = 0, motions = 0;
  std::vector<Incident> incidents;  ///< in the order of their first time
  std::string lost;                 ///< kLost: why
  double least_between_robots = std::numeric_limits<double>::infinity();  ///< metres
  double least_to_obstacles = std::numeric_limits<double>::infinity();
  std::vector<std::string> unchecked;  ///< pairs that contacts cannot be told of
};

}  // namespace rondo::sim::motions
