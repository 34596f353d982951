#pragma once

#include "base/stop.h"
#include "reach/problem/invariant.h"
#include "reach/problem/numeric.h"

/// What may be an invariant.
namespace rondo::reach::invariants {

/// Returns comparisons that may always hold in this mode: those of claims and conditions, both ways, and bounds
/// of each state that is not discrete: those at the start, and around what was visited.
///
/// @param visited  the states that sampled trajectories had in the mode; empty if there were none
std::vector<Conjunct> CandidatesFor(const Problem& problem, const Modes& modes, const Mode& mode,
                                    const interval::Box& visited);

/// Returns, by mode, a box around the states that some trajectories from random starts had in it.
std::vector<interval::Box> Visited(const Problem& problem, const Modes& modes, const std::vector<Mode>& all,
                                   Trajectories& trajectories, uint64_t seed, const base::StopToken& stop);

}  // namespace rondo::reach::invariants
