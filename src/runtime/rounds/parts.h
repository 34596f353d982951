#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "runtime/codec/messages.h"

/// The parts of a round that can be replaced: distributed shared memory, locks and the barrier between rounds
/// (Koord, section 8.2). A round is the same function of the same frames, and is final only when a strict majority of the
/// fleet has its end (docs/adr/0022): shared memory and the barrier decide who sends what to whom, and what they say costs time
/// at most; locks decide in which order robots take their turns, and have to say the same on every robot.
namespace rondo::runtime::rounds {

/// Brings what each robot does in a round to all.
class SharedMemory {
 public:
  virtual ~SharedMemory() = default;
  /// Returns the member that collects the frames of all others and passes them on, all at once; nothing: each robot
  /// sends its frame to all. The same on every robot.
  virtual std::optional<uint32_t> Collector(uint64_t epoch, std::span<const codec::Member> members) const = 0;
  /// Reports whether a robot that waits for frames in vain asks others than the collector.
  virtual bool AsksOthers() const = 0;
};

/// Decides who gets a lock that several want.
class Locks {
 public:
  virtual ~Locks() = default;
  /// Returns which of the members takes its turn as number `turn` in a round; over all turns, each once. Who comes first
  /// gets the lock of an event, and is overwritten by those who come later. The same on every robot.
  virtual size_t Who(uint64_t round, size_t turn, size_t members) const = 0;
};

/// Finds out when a majority has the end of a round.
class Barrier {
 public:
  virtual ~Barrier() = default;
  /// Returns the member that counts who has it, and tells all; nothing: each robot counts for itself. The same on every
  /// robot.
  virtual std::optional<uint32_t> Counter(uint64_t epoch, std::span<const codec::Member> members) const = 0;
  /// Reports whether a robot that waits for its word in vain asks others.
  virtual bool AsksOthers() const = 0;
};

/// Names the ways that come with this library.
enum class Exchange : uint8_t {
  kAllToAll,   ///< two exchanges between all: frames, then who has the next store
  kSequencer,  ///< over one robot, another in each epoch; who misses something also asks the others
  kCentral,    ///< over the first member alone, as with a server (Koord, section 8.2)
};

/// Returns `all-to-all`, `sequencer` or `central`.
std::string_view Name(Exchange exchange);

/// Holds one of each part; they outlive whoever uses them. All robots of a fleet have the same.
struct Parts {
  const SharedMemory* memory;
  const Locks* locks;
  const Barrier* barrier;
};
Parts PartsOf(Exchange exchange);

}  // namespace rondo::runtime::rounds
