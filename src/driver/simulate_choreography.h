#pragma once

#include <cstdint>
#include <string>

#include "runs/choreography_runs.h"
#include "verdict/verdict.h"

/// Carries out `rondo simulate` for choreographies.
namespace rondo::driver {

/// Says what `rondo simulate` is asked about a choreography.
struct SimulateChoreographyOptions {
  runs::ChoreographyFiles files;
  sim::motions::ChoreographyOptions run;  ///< of the first run; who stops it and is told of it is left open
  uint64_t runs = 1;                      ///< of the seeds from its seed on
  unsigned jobs = 0;
  std::string trace;  ///< a file for what happens; empty: none
  bool json = false;
};

/// Runs the choreography, prints what happened, and returns the exit status.
verdict::ExitStatus SimulateChoreography(const SimulateChoreographyOptions& options);

}  // namespace rondo::driver
