#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stop.h"
#include "diag/diagnostic.h"
#include "koord/prove/prove.h"
#include "runs/exploration.h"

/// Looks for runs that violate what the prover could not prove.
namespace rondo::runs {

/// Holds what a bounded search found out about one invariant.
struct Reached {
  std::string invariant;
  std::string text;  ///< one line for people
  std::string run;   ///< the file that the run was written to, if there is one
  bool found = false;
};

/// Says what was asked of the prover, and how far to search.
struct ReachRequest {
  std::optional<uint32_t> rounds;  ///< none: few, and only for what could not be decided
  std::optional<size_t> robots;    ///< if their number was fixed
  std::string file;
  std::string spec;
  ExplorationOptions exploration;
};

/// Searches for runs that violate what was not proved: for an invariant that is not inductive, if `rounds`
/// are given, the team of its counterexample, with the values of its parameters and sensors where the program
/// declares none; for one that could not be decided, teams of one to three robots. An invariant that a run
/// violates becomes refuted. What is found is a diagnostic as well. Without `rounds`, ends within a second
/// for each invariant.
std::vector<Reached> SearchWitnesses(const koord::Model& model, koord::Report& report,
                                     const ReachRequest& request, diag::Diagnostics& diagnostics);

}  // namespace rondo::runs
