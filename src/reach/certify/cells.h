#pragma once

#include "base/stop.h"
#include "reach/problem/paving.h"
#include "reach/problem/problem.h"

/// The checker of pavings.
namespace rondo::reach::certify {

/// Shows that the paving encloses the states at every instant of the controller, and that every claim of the
/// problem holds: each cell is followed for one period, and leads into cells of the paving again
/// (docs/theory.md, "Controllers that switch at instants"). Returns how many steps of the flow were shown.
///
/// @error says what could not be shown, or why this is no paving of the problem.
base::Result<size_t> CheckPaving(const Problem& problem, const Paving& paving, unsigned jobs,
                                 const base::StopToken& stop);

}  // namespace rondo::reach::certify
