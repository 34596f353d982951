#pragma once

#include <optional>
#include <random>
#include <vector>

#include "reach/problem/numeric.h"
#include "reach/validated/flow/stage.h"
#include "reach/validated/prover.h"

/// The search for trajectories that break a claim.
namespace rondo::reach {

/// Looks for a trajectory that breaks a claim: from corners of the initial set and from points at random,
/// with inputs at their bounds.
class Search {
 public:
  Search(Stages& stages, const ProverOptions& options, Trajectories& trajectories,
         const base::StopToken& stop)
      : problem_(stages.problem()),
        stages_(stages),
        options_(options),
        trajectories_(trajectories),
        stop_(stop),
        random_(options.seed) {
    FindEquations();
  }

  /// Tries so many starts: corners among the first half of them, points at random else. Returns the first
  /// refutation; nothing if there is none, or if it was stopped.
  std::optional<Refuted> Run(size_t samples);
  /// Tries the trajectory from this start, if what is assumed certainly allows it. A violation counts if it
  /// could be enclosed (`certain`), or if it comes again when it is computed more finely.
  std::optional<Refuted> Try(std::vector<double> start);

  /// Returns the violation that was nearest to happening, over all trajectories that broke nothing; nothing
  /// if there was none.
  const std::optional<Violation>& closest() const { return closest_; }

 private:
  // A state that an assumption determines, given the others.
  struct Equation {
    size_t state;
    TermId value;  ///< in terms of the others
  };
  void FindEquations();
  void Solve(std::vector<double>& start) const;
  bool MayStart(const std::vector<double>& start);
  interval::Box StartBox(const std::vector<double>& start) const;
  bool Confirm(const Refuted& refuted);
  bool ConfirmWithEvents(const Refuted& refuted);
  /// Reports whether a violation that could not be enclosed comes again with finer steps. `margin`: misses up
  /// to this are passed over.
  bool Repeats(const Refuted& refuted, double margin);

  const Problem& problem_;
  Stages& stages_;
  const ProverOptions& options_;
  Trajectories& trajectories_;
  const base::StopToken& stop_;
  std::mt19937_64 random_;
  std::vector<Equation> equations_;
  std::optional<Violation> closest_;
};

}  // namespace rondo::reach
