#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "expr/substitute.h"
#include "reach/problem/formula.h"
#include "reach/problem/modes.h"
#include "reach/validated/flow/stepper.h"

/// A problem as the engine sees it, compiled for the discrete states that are possible.
namespace rondo::reach {

/// Is a claim while the discrete states have certain values, compiled.
struct StageClaim {
  size_t claim = 0;  ///< of the problem
  size_t mode = 0;   ///< of the stage
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  double from = 0, to = 0;
  bool instant = false;  ///< whether it is about one instant only
  /// By term: whether it is at most zero at the start, exactly, and never jumps.
  std::vector<bool> starts_below;
  /// By term: whether it is at most zero in this mode, since an event would have ended it otherwise.
  std::vector<bool> implied;
};

/// Is the condition of an event that can happen in a mode, compiled.
struct Guard {
  size_t mode = 0;  ///< of the stage
  size_t event = 0;
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  Mode after;

  /// Reports whether it is a single comparison, `term <= 0` or `term < 0`.
  bool IsComparison() const { return formula.nodes[formula.root].kind == Formula::Kind::kAtom; }
};

/// Is a term that is asked for in a mode.
struct StageQuery {
  size_t query = 0;   ///< its index among the terms that are asked for
  size_t output = 0;  ///< its index among the observed outputs
};

/// Is a problem while its discrete states have the values of one of some modes.
///
/// Variables of all programs: the states; if it is scaled, one more, by which all rates are multiplied; the
/// inputs; and the discrete states whose values differ between the modes, as inputs.
struct Stage {
  std::vector<Mode> modes;
  Dynamics dynamics;
  Program observed;  ///< the terms of all claims and guards
  Program updates;   ///< what the states are after the controller has acted
  std::vector<StageClaim> claims;
  std::vector<Guard> guards;
  std::vector<StageQuery> queries;
  std::vector<std::optional<Interval>> discrete;  ///< by state: its values, if it is discrete
  bool ambiguous = false;  ///< whether anything that moves depends on discrete states that differ
};

/// Holds everything about a problem that all parts of the initial set share. Safe for several threads.
class Stages {
 public:
  /// Compiles the problem, which must outlive the result. @error if the problem uses what cannot be analysed.
  ///
  /// @param asked  terms that are observed besides claims and conditions.
  static base::Result<std::unique_ptr<Stages>> Of(const Problem& problem, std::vector<TermId> asked = {});

  /// Returns the stage for these modes, ascending; made once. `scaled`: with a factor for all rates as a
  /// further state, whose own rate is zero.
  ///
  /// @error if something in the problem has no meaning in these modes.
  base::Result<std::shared_ptr<const Stage>> For(const std::vector<Mode>& modes, bool scaled = false);

  const Problem& problem() const { return *problem_; }
  const Modes& modes() const { return modes_; }
  const Formula& assumed() const { return assumed_; }
  const Program& assumed_terms() const { return assumed_terms_; }
  const std::vector<double>& instants() const { return instants_; }
  double horizon() const { return horizon_; }
  double period() const { return period_; }
  size_t samples() const { return samples_; }
  /// Reports whether one term of a comparison is the negation of the other.
  bool AreOpposite(TermId a, TermId b);

 private:
  base::Result<std::shared_ptr<const Stage>> Make(const std::vector<Mode>& modes, bool scaled);
  /// Holds the variables of a stage's programs, how many of them are states, and the discrete states that
  /// have one value.
  struct Names {
    std::vector<TermId> variables;
    size_t states = 0;
    expr::Substitution values;
  };
  Names NamesIn(Stage& stage, bool scaled) const;
  std::vector<TermId> RatesIn(const Names& names, bool scaled) const;
  base::Result<std::vector<TermId>> AddTerms(Stage& stage);
  base::Result<bool> AddUpdates(Stage& stage, const Names& names, bool scaled) const;
  bool IsAmbiguous(const Stage& stage) const;
  void FindCertainTerms(Stage& stage) const;
  base::Result<bool> AddClaims(Stage& stage, size_t mode, std::vector<TermId>& terms);
  base::Result<bool> AddGuards(Stage& stage, size_t mode, std::vector<TermId>& terms);

  const Problem* problem_ = nullptr;
  std::vector<TermId> asked_;
  Modes modes_;
  Formula assumed_;
  Program assumed_terms_;
  std::vector<double> instants_;  ///< when claims begin or end, and the horizon
  double horizon_ = 0, period_ = 0;
  size_t samples_ = 0;             ///< how often the controller acts
  std::vector<TermId> stand_ins_;  ///< for discrete states that are inputs
  TermId factor_;
  std::mutex mutex_;
  std::map<std::pair<std::vector<Mode>, bool>, std::shared_ptr<const Stage>> made_;
};

}  // namespace rondo::reach
