#pragma once

#include <span>
#include <vector>

#include "koord/semantics/team.h"

/// Executes rounds one choice at a time, for whoever makes the choices: a simulator, or a robot.
namespace rondo::koord::semantics {

/// Executes one program transition (rules SelectEvent, EventTrans, EndProgTrans) with the choices made one by
/// one, as simulators and robots do, where `ProgramTransition` lists everything that could be done. The state
/// after `Finish` is one of those that `ProgramTransition::Enumerate` visits.
class RoundExecution {
 public:
  explicit RoundExecution(Team& team);

  /// Begins a round in `state`. All events of the round read a copy of it; `state` itself stays as it is
  /// until `Finish` changes it, and must live as long.
  void Begin(std::span<Word> state);
  /// Returns the events that robot `robot` may run: those whose guard is true, and of these only the urgent
  /// ones if there are any. An event whose guard has no value counts as enabled, so that running it says what
  /// is wrong; a robot that has stopped has none. The span is valid until the next call.
  std::span<const uint32_t> Enabled(size_t robot);
  /// Tells what became of an event that was run.
  enum class Ran : uint8_t {
    kDone,
    kNoLock,  ///< another robot holds the lock of the event, so that this robot skips
    kFailed,  ///< an operation has no value; `fault` says which, and nothing was written
  };
  /// Runs an event of `Enabled` for the robot, on the values at the start of the round, and remembers what it
  /// writes. Where several robots write a variable, the one that ran last in the round wins.
  Ran Run(size_t robot, uint32_t event);
  /// Ends the program transition: puts the writes of the round into the state, in the order in which they
  /// were made.
  void Finish();

  /// Returns why the last event that failed has no value, and where in the program.
  Fault fault() const { return team_.machine().fault(); }
  diag::Span fault_span() const { return team_.machine().fault_span(); }
  /// States that the word at an address of the state gets a value.
  struct Write {
    uint32_t at;
    Word value;
  };
  /// Returns all writes of the round so far, in the order in which the robots ran.
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
