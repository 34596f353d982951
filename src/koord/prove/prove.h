#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.h"
#include "diag/diagnostic.h"
#include "koord/check/model.h"
#include "koord/prove/results.h"
#include "solve/solver.h"

/// Proves inductive invariants of Koord programs, for any number of robots (docs/theory.md, "Obligations").
namespace rondo::koord {

/// Says how a proof is looked for.
struct ProveOptions {
  std::optional<int64_t> robots;               ///< fixes N_sys; otherwise the proof is for every N_sys >= 1
  unsigned jobs = 0;                           ///< threads; 0: one for each core
  std::chrono::milliseconds timeout{10'000};   ///< for each question to the solver
  const solve::Solver* solver = nullptr;       ///< answers the questions; must be given
  const solve::Solver* cross_check = nullptr;  ///< decides every question a second time
  bool quick = false;  ///< looks for proofs of the last invariant only, with little effort; no diagnostics
  std::filesystem::path smt_out;  ///< where to write the obligations as SMT-LIB 2
  /// Receives how many questions are answered, how many there are, and what was asked last. Called from any
  /// thread, one call at a time.
  std::function<void(size_t done, size_t total, const std::string& what)> progress;
  base::StopToken stop;
};

/// Proves the invariants of a program that passed the checker. Failures, contradictions, unused assumptions
/// and what could not be decided are reported as diagnostics as well.
Report Prove(const Model& model, const ProveOptions& options, diag::Diagnostics& diagnostics);

}  // namespace rondo::koord
