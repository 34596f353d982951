#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/stop.h"
#include "history/record.h"

/// Judges what robots logged against the semantics, without knowing the protocol that made it.
namespace rondo::history {

/// Names what must not happen.
enum class Wrong : uint8_t {
  kDiverged,    ///< two robots have different states for one place
  kNoRound,     ///< a state does not follow from the one before it by any round of the program
  kLost,        ///< a state that was final is none of those that the robots went on from
  kTooEarly,    ///< a robot acted on a state that no majority had
  kTooLate,     ///< a robot acted longer than its last answered word allows
  kTwoTeams,    ///< a robot acted, or might have, while others already acted without it
  kTwice,       ///< one life said two different things in one round
  kStarved,     ///< a robot wanted a lock in as many rounds as there are robots, and never got it
  kWithdrawn,   ///< a robot went back behind a state on which it had acted
  kNoFallback,  ///< a robot fell back, and its actuators are not what the program says
  kUnreadable,  ///< the record itself makes no sense
};
/// Returns the name as files have it (`diverged`, `no-round`, ...), and what it means in a sentence.
std::string_view Name(Wrong wrong);
std::string_view Meaning(Wrong wrong);

/// Says what is wrong, where, in words.
struct Finding {
  Wrong wrong = Wrong::kDiverged;
  size_t entry = 0;  ///< the line at which it shows
  std::string text;
};

/// Judges records of one program.
class Judge {
 public:
  /// @param team  compiled for as many robots as the records have; only the judge uses it meanwhile.
  /// @param about  is told of which round the functions of the program are asked next, if somebody has to know.
  using About = std::function<void(uint64_t epoch, uint64_t round)>;
  explicit Judge(koord::semantics::Team& team, About about = {}) : team_(team), about_(std::move(about)) {}

  /// Returns everything that is wrong with a record, in the order of its lines; nothing if the robots kept
  /// what docs/runtime.md promises. Cost: one look at each entry, and one explanation for each state.
  std::vector<Finding> Check(const Record& record, const base::StopToken& stop = {});
  /// Returns how many rounds the last check explained.
  size_t rounds() const { return rounds_; }

 private:
  koord::semantics::Team& team_;
  About about_;
  size_t rounds_ = 0;
};

}  // namespace rondo::history
