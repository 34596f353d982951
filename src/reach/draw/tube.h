#pragma once

#include <string>
#include <vector>

#include "base/stop.h"
#include "reach/validated/prover.h"

/// Pictures of tubes, trajectories and bounds.
namespace rondo::reach {

/// Says what the picture shows besides the tube.
struct TubePicture {
  std::vector<std::string> names;  ///< of the states, in their order
  size_t samples = 16;             ///< trajectories: corners first, then starts at random
  uint64_t seed = 1;               ///< of the random starts: equal seeds give equal pictures
};

/// Returns an SVG picture of what became of a problem: each state over time (seconds), and the plane of the
/// first two that are called x and y. Blue: what is enclosed (of a proof, or of the parts that were proved);
/// lines: simulated trajectories; green: the starts; red and dashed: bounds that claims put on one state;
/// red: a trajectory that breaks a claim, with a mark where it does. Constants, the clock and copies are left
/// out.
///
/// @error if the problem cannot be simulated.
base::Result<std::string> DrawTube(const Problem& problem, const Outcome& outcome, const TubePicture& picture,
                                   const base::StopToken& stop);

}  // namespace rondo::reach
