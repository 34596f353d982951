#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "koord/semantics/team.h"

/// What robots did, as their logs tell it. Nothing here knows how they agreed on it.
namespace rondo::history {

using koord::semantics::Word;

/// Is the state of a team in a form that means the same to every heap: lists and texts are in place, each
/// behind its length.
using Image = std::vector<Word>;

/// Returns the image of a state, and the state of an image; the latter is empty if this is none.
Image ImageOf(const koord::semantics::Team& team, std::span<const Word> state);
std::vector<Word> StateOf(koord::semantics::Team& team, std::span<const Word> image);

/// Names what a robot logs.
enum class Kind : uint8_t {
  kStarted,      ///< a life begins
  kCrashed,      ///< and ends
  kContributed,  ///< it said what it does in a round
  kStored,       ///< it has the state at the start of a round
  kCommitted,    ///< it knows that this state is final
  kActed,        ///< its actuators and streams got what the state says
  kFellBack,     ///< it acts no more; its actuators are as its fallback says
  kAdopted,      ///< it learned who takes part from now on
};

/// Returns the name as files have it: `started`, `contributed`, ...
std::string_view Name(Kind kind);

constexpr size_t kNothing = SIZE_MAX;

/// Holds one line of a log.
struct Entry {
  Kind kind = Kind::kStarted;
  int64_t time = 0;   ///< nanoseconds of the observer's clock
  int64_t until = 0;  ///< kActed: when the permission ends, on the clock by which the robot runs
  uint32_t robot = 0;
  uint64_t incarnation = 0;
  uint64_t epoch = 0, round = 0;
  /// kStored, kFellBack: which image; kContributed: which text; kAdopted: which list of members. kFellBack without fallbacks
  /// in the program: `kNothing`.
  size_t what = 0;
  int64_t stamp =
      0;  ///< what the clock on the robot's wall said, which may step; for people, not for the judge
  /// kContributed: events that it leaves out because a function is not finished.
  std::vector<uint32_t> waits = {};
  bool skips = false;  ///< kContributed: it chose to do nothing, though it could
  /// What the clock said by which the robot runs, if that is not the observer's: leases count on it.
  std::optional<int64_t> clock = {};
  int64_t Clock() const { return clock.value_or(time); }
};

/// Names one life of a robot.
struct Life {
  uint32_t robot = 0;
  uint64_t incarnation = 0;
  friend auto operator<=>(const Life&, const Life&) = default;
};

/// Holds the logs of all robots of one session, in order of time.
struct Record {
  size_t robots = 1;
  int64_t lease = 0;      ///< nanoseconds
  int64_t stop_time = 0;  ///< nanoseconds
  std::vector<Entry> entries;
  std::vector<Image> images;
  std::vector<std::vector<uint8_t>> texts;
  std::vector<std::vector<Life>> members;
};

}  // namespace rondo::history
