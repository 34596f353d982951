#pragma once

#include "base/stop.h"
#include "reach/problem/invariant.h"
#include "reach/problem/numeric.h"

/// The search for inductive invariants of modes: proofs for all times at once, where a tube would have to
/// follow every order in which events can happen.
namespace rondo::reach::invariants {

/// Is an invariant, and what follows from it.
struct Found {
  Invariant invariant;
  std::vector<size_t> claims;  ///< the claims that it implies, by their index in the problem, ascending
  interval::Box states;        ///< encloses all states at all times
};

/// Looks for an invariant of a problem with events and without a controller at instants.
///
/// Candidates are comparisons in claims and conditions, bounds of the initial box, and bounds around sampled
/// trajectories. What is not kept, given the others, is dropped until all of what is left is (Houdini).
/// Guarantee: what is returned holds at every time of every trajectory (docs/theory.md, "Invariants of
/// modes"). Nothing if no claim follows.
///
/// @source Flanagan & Leino, Houdini (FME 2001); Nagumo (1942) for the condition on boundaries.
std::optional<Found> Find(const Problem& problem, Trajectories& trajectories, uint64_t seed,
                          const base::StopToken& stop);

}  // namespace rondo::reach::invariants
