#pragma once

#include <span>

#include "koord/semantics/team.h"

/// Runs fallbacks.
namespace rondo::koord::semantics {

/// Lets a robot fall back in `state`: its actuators get what the fallbacks say of what its sensors read there. Where an
/// operation has no value, the actuators of that module hold. Returns whether all had values.
bool FallBack(Team& team, std::span<Word> state, size_t robot);

}  // namespace rondo::koord::semantics
