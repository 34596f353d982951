#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diag/source.h"
#include "expr/value.h"
#include "verdict/basis.h"
#include "verdict/verdict.h"

/// What the prover of Koord programs has to say.
namespace rondo::koord {

/// One obligation and what became of it.
struct Cell {
  std::string column;            ///< `initially`, an event, `skip`, `init`, or a part of the specification
  std::optional<size_t> action;  ///< what is taken first, as `Problems` counts; none: initially
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
  std::string reason;             ///< why unknown
  std::vector<std::string> core;  ///< assumptions and invariants that the proof used
  double seconds = 0;
  bool timed_out = false;  ///< is it unknown for want of time?
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
  diag::Span span;  ///< of the invariant; nowhere for the last row
  std::vector<Cell> cells;
  verdict::Verdict verdict = verdict::Verdict::kUnknown;
  std::string because;
  std::optional<WitnessState> witness;  ///< of what failed; confirmed
};

struct Report {
  std::vector<Row> rows;
  verdict::Basis basis;                    ///< in order of the specification
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

}  // namespace rondo::koord
