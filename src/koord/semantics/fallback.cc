#include "koord/semantics/fallback.h"

namespace rondo::koord::semantics {

bool FallBack(Team& team, std::span<Word> state, size_t robot) {
  if (team.native() != nullptr) return team.native()->FallBack(state, robot);
  Machine& machine = team.machine();
  machine.SetMemory(state.data());
  bool all = true;
  for (const EventCode& code : team.fallbacks()) {
    if (machine.Run(code.body, robot, false)) continue;
    machine.Undo();
    all = false;
  }
  return all;
}

}  // namespace rondo::koord::semantics
