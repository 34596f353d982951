#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "base/stop.h"
#include "reach/problem/numeric.h"
#include "reach/validated/flow/flow.h"
#include "verdict/verdict.h"

namespace rondo::reach {

/// One stretch of time of one part of the initial set, with boxes that enclose the states during it.
struct TubeSegment {
  double from = 0, to = 0;
  interval::Box during;
};

/// Which half of a side of the initial set.
struct Cut {
  size_t side = 0;  ///< a state, no copy
  bool upper = false;
};

/// One thing that was done to follow a part, in order.
struct StepRecord {
  enum class Kind : uint8_t {
    kStep,
    kCross,  ///< all of the set meets an event
    kSplit,  ///< into the halves of a symbol: first all about the lower one, then all about the upper one
    kOpen,   ///< a step during which several modes are possible, or one of several that are followed alone
  };
  Kind kind = Kind::kStep;
  double length = 0;  ///< seconds; of kCross: within which all of the set meets the event
  size_t degree = 0;  ///< of polynomials
  size_t event = 0;
  double together = 0;  ///< seconds that the set goes on after the event before it is brought to one instant
  /// Of kCross: when a start meets the event, in seconds; coefficients with their monomials' exponents.
  std::vector<std::pair<std::vector<uint8_t>, double>> time = {};
  size_t symbol = 0;
};

/// A part of the initial set for which every claim was shown, and how.
struct Leaf {
  interval::Box initial;
  std::vector<Cut> path;  ///< from the whole initial set to this part
  std::vector<TubeSegment> tube;
  interval::Box final;
  std::vector<StepRecord> steps;
};

struct Proved {
  std::vector<Leaf> leaves;
  std::vector<std::vector<Cut>> empty;  ///< parts in which nothing satisfies what is assumed
  size_t steps = 0;
};

/// A trajectory on which a claim fails; enclosed rigorously at that time if `certain`.
struct Refuted {
  Execution execution;
  Violation violation;
  bool certain = false;
};

/// Neither.
struct Undecided {
  std::string reason;  ///< for people
  verdict::Shortfall shortfall = verdict::Shortfall::kMethod;
  /// How near the claims came to failing, by samples: negative is inside.
  std::optional<Violation> closest;
  std::vector<Leaf> leaves;
};

using Outcome = std::variant<Proved, Refuted, Undecided>;

/// Returns the word for it: proved, refuted or unknown.
verdict::Verdict VerdictOf(const Outcome& outcome);

struct ProverOptions {
  FlowOptions flow;
  size_t most_leaves = 2000;
  size_t samples = 200;  ///< trajectories that look for a violation first
  uint64_t seed = 1;
  unsigned jobs = 0;
  bool keep_tube = true;
  /// Called now and then with the parts that are done and open.
  std::function<void(size_t, size_t)> progress;
};

/// What a term can be during an interval of time.
struct Query {
  TermId term;
  double from = 0, to = 0;
};

/// Encloses the values of terms over the states and inputs on every trajectory that a proof is about, each
/// during its interval: by polynomials, as sharply as claims are decided. The tube is followed again, from
/// the parts that it has.
///
/// @error if a term has no meaning, or no value somewhere.
base::Result<std::vector<Interval>> RangesOn(const Problem& problem, const Proved& proved,
                                             const std::vector<Query>& queries, const ProverOptions& options,
                                             const base::StopToken& stop);

/// Decides whether every claim of the problem holds on every trajectory. Proofs are rigorous; a refutation is
/// a trajectory.
///
/// @error if the problem uses what has no derivative (integers, uninterpreted functions).
base::Result<Outcome> Decide(const Problem& problem, const ProverOptions& options,
                             const base::StopToken& stop);

}  // namespace rondo::reach
