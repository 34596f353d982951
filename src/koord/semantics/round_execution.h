#pragma once

#include <span>
#include <vector>

#include "koord/semantics/team.h"

namespace rondo::koord::semantics {

/// One program transition with the choices made one by one: what simulators and robots do, where
/// `ProgramTransition` lists everything that could be done. The state after `Finish` is one of those that
/// `ProgramTransition::Enumerate` visits.
class RoundExecution {
 public:
  explicit RoundExecution(Team& team);

  /// The round starts in `state`, which `Finish` changes.
  void Begin(std::span<Word> state);
  /// The events that robot r may run: enabled, and urgent if any of those is. Valid until the next call.
  std::span<const uint32_t> Enabled(size_t robot);
  enum class Ran : uint8_t {
    kDone,
    kNoLock,  ///< another robot holds the lock: a skip
    kFailed,
  };
  /// Robot r runs the event. Robots that run later are later in the interleaving.
  Ran Run(size_t robot, uint32_t event);
  /// Makes the writes of the round.
  void Finish();

  Fault fault() const { return team_.machine().fault(); }
  diag::Span fault_span() const { return team_.machine().fault_span(); }
  struct Write {
    uint32_t at;
    Word value;
  };
  /// All writes of the round so far, in order.
  const std::vector<Write>& writes() const { return pending_; }

 private:
  Team& team_;
  std::span<Word> state_;
  std::vector<Word> memory_;
  std::vector<uint32_t> enabled_;
  std::vector<bool> locked_;  // by event
  std::vector<Write> pending_;
};

}  // namespace rondo::koord::semantics
