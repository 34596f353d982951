#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "base/stop.h"
#include "reach/problem/invariant.h"
#include "reach/problem/numeric.h"
#include "reach/problem/paving.h"
#include "reach/validated/flow/flow.h"
#include "verdict/verdict.h"

/// The engine of reachability: proofs by tubes, refutations by trajectories.
namespace rondo::reach {

/// Is one stretch of time of one part of the initial set, with a box that encloses the states during it.
struct TubeSegment {
  double from = 0, to = 0;  ///< seconds
  interval::Box during;
};

/// Says which half of a side of the initial set was taken.
struct Cut {
  size_t side = 0;     ///< the index of a state that is no copy of another
  bool upper = false;  ///< the upper half, not the lower one
};

/// Records one thing that was done to follow a part, in order.
struct StepRecord {
  /// Says what was done.
  enum class Kind : uint8_t {
    kStep,   ///< some time along the flow, in one mode
    kCross,  ///< all of the set meets an event
    kSplit,  ///< into the halves of a symbol: first all about the lower one, then all about the upper one
    kOpen,   ///< a step during which several modes are possible, or one of several that are followed alone
  };
  Kind kind = Kind::kStep;
  double length = 0;    ///< seconds; of kCross: within which all of the set meets the event
  size_t degree = 0;    ///< of polynomials
  size_t event = 0;     ///< of kCross: which event, by its index in the problem
  double together = 0;  ///< seconds that the set goes on after the event before it is brought to one instant
  /// Of kCross: when a start meets the event, in seconds; coefficients with their monomials' exponents.
  std::vector<std::pair<std::vector<uint8_t>, double>> time = {};
  size_t symbol = 0;  ///< of kSplit: which symbol is halved
};

/// Is a part of the initial set for which every claim was shown, and how.
struct Leaf {
  interval::Box initial;
  std::vector<Cut> path;          ///< from the whole initial set to this part
  std::vector<TubeSegment> tube;  ///< by time; empty unless `ProverOptions::keep_tube`
  interval::Box final;            ///< encloses the states at the horizon
  std::vector<StepRecord> steps;
};

/// Says that every claim holds: by cells, or those that the invariant implies by it and the others part by part
/// (leaves and empty parts together are all of the initial set).
struct Proved {
  std::optional<Invariant> invariant;  ///< kept at all times
  std::optional<Paving> paving;        ///< holds the states at the instants of the controller
  /// If no tube was needed: one, without steps, with a box around all states.
  std::vector<Leaf> leaves;
  std::vector<std::vector<Cut>> empty;  ///< parts in which nothing satisfies what is assumed
  size_t steps = 0;                     ///< of the flow, over all leaves

  /// Reports whether every claim follows from the invariant or the paving.
  bool IsWithoutTube() const {
    return (invariant || paving) && leaves.size() == 1 && leaves[0].steps.empty();
  }
};

/// Is a trajectory on which a claim fails; enclosed rigorously at that time if `certain`.
struct Refuted {
  Execution execution;
  Violation violation;
  bool certain = false;
};

/// Says that the claims were neither proved nor refuted.
struct Undecided {
  std::string reason;  ///< for people
  verdict::Shortfall shortfall = verdict::Shortfall::kMethod;
  /// How near the claims came to failing, by samples: negative is inside.
  std::optional<Violation> closest;
  std::vector<Leaf> leaves;  ///< the parts for which they were proved nevertheless
};

/// Is what became of a problem.
using Outcome = std::variant<Proved, Refuted, Undecided>;

/// Returns the word for it: proved, refuted or unknown.
verdict::Verdict VerdictOf(const Outcome& outcome);

/// Says how much effort goes into a problem.
struct ProverOptions {
  FlowOptions flow;
  size_t most_leaves = 2000;  ///< parts; with more, the problem stays undecided
  size_t samples = 200;       ///< trajectories that look for a violation first
  uint64_t seed = 1;          ///< of the trajectories that look for a violation
  unsigned jobs = 0;          ///< threads; 0: as many as the machine has cores
  bool wide = false;          ///< whether sets are followed however wide errors make them
  bool keep_tube = true;      ///< whether leaves keep their boxes, for pictures
  /// Called now and then with the number of parts that are done and of those that are open.
  std::function<void(size_t, size_t)> progress;
};

/// Asks what a term can be during an interval of time, in seconds.
struct Query {
  TermId term;
  double from = 0, to = 0;  ///< seconds
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
/// a trajectory, and rigorous only if it is `certain`.
///
/// @error if the problem uses what has no derivative (integers, uninterpreted functions).
base::Result<Outcome> Decide(const Problem& problem, const ProverOptions& options,
                             const base::StopToken& stop);

}  // namespace rondo::reach
