#include "koord/semantics/round_execution.h"

#include <algorithm>

namespace rondo::koord::semantics {

RoundExecution::RoundExecution(Team& team) : team_(team), locked_(team.events().size()) {}

void RoundExecution::Begin(std::span<Word> state) {
  state_ = state;
  memory_.assign(state.begin(), state.end());
  pending_.clear();
  std::fill(locked_.begin(), locked_.end(), false);
}

// Rule SelectEvent. A guard without a value counts as enabled: running the event says what is wrong.
std::span<const uint32_t> RoundExecution::Enabled(size_t robot) {
  enabled_.clear();
  const Layout& layout = team_.layout();
  if (memory_[layout.block(robot) + layout.stopped()] != 0) return enabled_;
  Machine& machine = team_.machine();
  machine.SetMemory(memory_.data());
  bool urgent = false;
  for (uint32_t e = 0; e < team_.events().size(); ++e) {
    const EventCode& event = team_.events()[e];
    if (event.guard != 0 && machine.Run(event.guard, robot, false) && machine.result()[0] == 0) continue;
    enabled_.push_back(e);
    urgent = urgent || event.urgent;
  }
  if (urgent) std::erase_if(enabled_, [&](uint32_t e) { return !team_.events()[e].urgent; });
  return enabled_;
}

RoundExecution::Ran RoundExecution::Run(size_t robot, uint32_t e) {
  Machine& machine = team_.machine();
  machine.SetMemory(memory_.data());
  const EventCode& event = team_.events()[e];
  if (event.guard != 0 && !machine.Run(event.guard, robot, false)) return Ran::kFailed;
  machine.SetLockTaken(locked_[e]);
  const bool done = machine.Run(event.body, robot, false);
  machine.SetLockTaken(false);
  if (!done) {
    machine.Undo();
    return machine.fault() == Fault::kNoLock ? Ran::kNoLock : Ran::kFailed;
  }
  if (machine.locked()) locked_[e] = true;
  for (const Machine::Write& w : machine.writes()) pending_.push_back({w.at, memory_[w.at]});
  if (machine.stopped()) pending_.push_back({team_.layout().block(robot) + team_.layout().stopped(), 1});
  machine.Undo();
  return Ran::kDone;
}

void RoundExecution::Finish() {
  for (const Write& w : pending_) state_[w.at] = w.value;
}

}  // namespace rondo::koord::semantics
