#pragma once

#include <optional>

#include "reach/problem/numeric.h"
#include "reach/validated/prover.h"

/// Proofs for controllers that switch at sampling instants.
namespace rondo::reach {

/// Reports whether the problem has a controller that chooses between laws, other than by `min`, `max` or `abs`.
bool ChoosesLaws(const Problem& problem);

/// Tries to prove a problem without events whose controller chooses between laws (`select`) at its instants, where a tube would
/// have to follow every order of choices: the states at these instants are enclosed by cells of a grid, each of
/// which is followed for one period, until no new cell is reached. Claims must be about all times, or about the
/// horizon. Nothing if that is not possible, or no grid that was tried is fine enough.
///
/// Cost: up to 20,000 cells, one period of validated integration each, for each of a few grids.
std::optional<Proved> ProveByCells(const Problem& problem, Trajectories& trajectories,
                                   const ProverOptions& options, const base::StopToken& stop);

}  // namespace rondo::reach
