#pragma once

#include <optional>
#include <random>
#include <vector>

#include "reach/problem/numeric.h"
#include "reach/validated/flow/stage.h"
#include "reach/validated/prover.h"

namespace rondo::reach {

/// Looks for a trajectory that breaks a claim: corners, middles of faces, points at random.
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

  /// Of so many starts.
  std::optional<Refuted> Run(size_t samples);
  /// From here, if it is a start.
  std::optional<Refuted> Try(std::vector<double> start);

  /// How near any trajectory came that broke nothing.
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
  /// `margin`: misses that were passed over.
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
