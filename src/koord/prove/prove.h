#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/stop.h"
#include "diag/diagnostic.h"
#include "expr/value.h"
#include "koord/check/model.h"
#include "solve/solver.h"

/// Inductive invariants of Koord programs, for any number of robots (docs/theory.md).
namespace rondo::koord {

struct ProveOptions {
  std::optional<int64_t> robots;              ///< fixes N_sys; otherwise the proof is for every N_sys >= 1
  unsigned jobs = 0;                          ///< threads; 0: one for each core
  std::chrono::milliseconds timeout{10'000};  ///< for each question to the solver
  const solve::Solver* solver = nullptr;
  const solve::Solver* cross_check = nullptr;  ///< decides every question a second time
  std::filesystem::path smt_out;               ///< where to write the obligations as SMT-LIB 2
  /// Called from any thread, one call at a time.
  std::function<void(size_t done, size_t total, const std::string& what)> progress;
  base::StopToken stop;
};

enum class Outcome : uint8_t { kProved, kFailed, kUnknown };

/// One obligation and what became of it.
struct Cell {
  std::string column;            ///< `initially`, an event, `skip`, `init`, or a part of the specification
  std::optional<size_t> action;  ///< what is taken first, as `Problems` counts; none: initially
  Outcome outcome = Outcome::kUnknown;
  std::string reason;             ///< why unknown
  std::vector<std::string> core;  ///< assumptions and invariants that the proof used
  double seconds = 0;
  bool timed_out = false;  ///< is it unknown for want of time?
};

enum class Verdict : uint8_t {
  kProved,
  kRefuted,       ///< a run from an initial state violates it
  kNotInductive,  ///< a round from a state that satisfies all invariants violates it
  kUnknown,
  kConditional,  ///< its proof uses an invariant that is not proved
};

/// A counterexample as values: a state and, unless it is an initial one, a round from it.
struct WitnessState {
  int64_t robots = 0;
  bool initial = false;
  bool moved = false;  ///< the environment moved
  struct Value {
    size_t variable;
    int64_t robot;  ///< -1: shared, or a parameter
    expr::Value start;
    std::optional<expr::Value> end;
  };
  std::vector<Value> values;
  std::vector<int64_t> stopped;                     ///< robots that had stopped at the start
  std::vector<std::pair<int64_t, size_t>> actions;  ///< robot, and its action; 0: it skips
};

/// An invariant, or (the last row) the definedness of every operation.
struct Row {
  std::string name;
  std::vector<Cell> cells;
  Verdict verdict = Verdict::kUnknown;
  std::string because;
  std::optional<WitnessState> witness;  ///< of what failed; confirmed
};

struct Report {
  std::vector<Row> rows;
  std::vector<std::string> assumed;        ///< used by some proof, in order of the specification
  std::vector<std::string> unused;         ///< stated, but no proof needed them
  std::vector<std::string> unconstrained;  ///< external functions that may return anything
  bool contradiction = false;              ///< the assumptions cannot all be true: nothing counts as proved
  bool disagreement = false;               ///< two solvers gave different answers
  bool interrupted = false;
  size_t obligations = 0;
  size_t cross_checked = 0;
  size_t cross_unknown = 0;
  std::vector<std::string> problems;  ///< failures to write files

  bool AllProved() const;
  bool AnyFailed() const;
};

/// Proves the invariants of a program that passed the checker. Failures, contradictions, unused assumptions
/// and what could not be decided are reported as diagnostics as well.
Report Prove(const Model& model, const ProveOptions& options, diag::Diagnostics& diagnostics);

}  // namespace rondo::koord
