#pragma once

#include "base/stop.h"
#include "reach/problem/invariant.h"

/// The checker of invariants of modes.
namespace rondo::reach::certify {

/// Holds what was shown of an invariant.
struct Invariance {
  std::vector<size_t> claims;  ///< those that follow from it, by their index in the problem, ascending
  size_t boxes = 0;            ///< that were looked at
};

/// Shows that the invariant holds at every time of every trajectory, whatever anybody claims: at the start, along
/// the flow, through every sequence of events at one instant, and that there is always an end to these
/// (docs/theory.md, "Invariants of modes"). By interval arithmetic on boxes and derivatives of compiled terms.
///
/// @error says what could not be shown.
base::Result<Invariance> CheckInvariant(const Problem& problem, const Invariant& invariant,
                                        const base::StopToken& stop);

}  // namespace rondo::reach::certify
