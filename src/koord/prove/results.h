#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diag/source.h"
#include "expr/value.h"
#include "verdict/basis.h"
#include "verdict/verdict.h"

/// Holds what the prover of Koord programs found, as values that reports, replays and files read.
namespace rondo::koord {

/// Names the obligation about robots that are cut off.
inline constexpr const char* kCutOffColumn = "cut off";

/// Holds one obligation and what became of it.
struct Cell {
  std::string column;  ///< `initially`, an event, `skip`, `init`, `cut off`, or a part of the specification
  std::optional<size_t> action;  ///< the first action, as `Problems` counts; none: initially
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
  std::string reason;             ///< why it is unknown, if it is
  std::vector<std::string> core;  ///< assumptions and invariants that the proof used
  double seconds = 0;
  bool timed_out = false;  ///< it is unknown for want of time
};

/// Names what a counterexample shows: an initial state, a round, or a round in which robots are cut off.
enum class WitnessOf : uint8_t { kInitial, kRound, kCutOff };

/// Holds a counterexample as values: a state and, unless it is an initial one, a round from it.
struct WitnessState {
  int64_t robots = 0;
  WitnessOf of = WitnessOf::kRound;
  bool moved = false;  ///< the environment moved the sensors
  struct Value {
    size_t variable;
    int64_t robot;  ///< -1: shared, or a parameter
    expr::Value start;
    std::optional<expr::Value> end;
    std::optional<expr::Value> then;  ///< of kCutOff: when the actuators of this robot change
  };
  /// Tells what becomes of the actuators of a robot in a round in which robots are cut off.
  struct Actuators {
    int64_t robot;
    bool wait, change, fall_back;
  };
  std::vector<Actuators> actuators;
  std::vector<Value> values;
  std::vector<int64_t> stopped;                     ///< robots that had stopped at the start
  std::vector<int64_t> stopped_after;               ///< and at the end
  std::vector<std::pair<int64_t, size_t>> actions;  ///< each robot with its action; 0: it skips
};

/// Holds the obligations and the verdict of an invariant or, in the last row, of the definedness of every
/// operation.
struct Row {
  std::string name;
  diag::Span span;  ///< where the invariant stands; nowhere for the last row
  std::vector<Cell> cells;
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
  std::string because;
  std::optional<WitnessState> witness;  ///< the confirmed counterexample, if it failed
};

/// Holds everything that a proof of one program found.
struct Report {
  std::vector<Row> rows;
  verdict::Basis basis;                    ///< what the proofs rest on, in order of the specification
  std::vector<std::string> unconstrained;  ///< external functions that may return anything
  bool contradiction = false;              ///< the assumptions cannot all be true: nothing counts as proved
  bool disagreement = false;               ///< two solvers gave different answers
  bool interrupted = false;
  size_t obligations = 0;
  size_t cross_checked = 0;
  size_t cross_unknown = 0;
  std::vector<std::string> problems;  ///< messages about files that could not be written

  bool AllProved() const;
  bool AnyFailed() const;
};

}  // namespace rondo::koord
