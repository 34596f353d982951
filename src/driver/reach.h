#pragma once

#include <string>
#include <vector>

#include "base/stop.h"
#include "diag/diagnostic.h"
#include "driver/exploration.h"
#include "koord/prove/prove.h"

namespace rondo::driver {

/// What a bounded search found out about one invariant that is not inductive.
struct Reached {
  std::string invariant;
  std::string text;  ///< one line for people
  std::string run;   ///< the file of the run, if there is one
  bool found = false;
};

/// For each invariant that is not inductive: explores the team of its counterexample, for so many rounds,
/// with the values of its parameters and sensors where the program declares none. An invariant that a run
/// violates becomes refuted. What is found is a diagnostic as well.
std::vector<Reached> SearchWitnesses(const koord::Model& model, koord::Report& report, uint32_t rounds,
                                     const std::string& file, const std::string& spec,
                                     const ExplorationOptions& options, diag::Diagnostics& diagnostics);

}  // namespace rondo::driver
