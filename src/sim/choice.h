#pragma once

#include <span>

#include "koord/semantics/program_transition.h"
#include "sim/fleet/fleet.h"

namespace rondo::sim {

/// Returns which of the effects of its enabled events a robot would like best in a round, as the policy of the fleet says; of
/// the values of its `any`, a random one. Their number: it skips. The same arguments give the same choice.
size_t Choose(const Fleet& fleet, uint64_t seed, uint64_t round, size_t robot,
              std::span<const koord::semantics::Effect> effects);

}  // namespace rondo::sim
