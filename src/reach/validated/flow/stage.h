#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "expr/substitute.h"
#include "reach/problem/formula.h"
#include "reach/problem/modes.h"
#include "reach/validated/flow/stepper.h"

namespace rondo::reach {

/// A claim while the discrete states have certain values.
struct StageClaim {
  size_t claim = 0;  ///< of the problem
  size_t mode = 0;   ///< of the stage
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  double from = 0, to = 0;
  bool instant = false;
  std::vector<bool> starts_below;  ///< by term: at most zero at the start, exactly, and does it never jump?
  std::vector<bool> implied;       ///< by term: at most zero in this mode, or an event would have ended it?
};

/// The condition of an event that can happen in a mode.
struct Guard {
  size_t mode = 0;  ///< of the stage
  size_t event = 0;
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  Mode after;

  /// A single comparison, `term <= 0` or `term < 0`?
  bool IsComparison() const { return formula.nodes[formula.root].kind == Formula::Kind::kAtom; }
};

/// A term that is asked for in a mode.
struct StageQuery {
  size_t query = 0;
  size_t output = 0;  ///< among the observed ones
};

/// A problem while its discrete states have the values of one of some modes.
///
/// Variables of all programs: the states; if it is scaled, one more, by which all rates are multiplied; the
/// inputs; and the discrete states whose values differ between the modes, as inputs.
struct Stage {
  std::vector<Mode> modes;
  Dynamics dynamics;
  Program observed;  ///< the terms of all claims and guards
  Program updates;
  std::vector<StageClaim> claims;
  std::vector<Guard> guards;
  std::vector<StageQuery> queries;
  std::vector<std::optional<Interval>> discrete;  ///< by state: its values, if it is discrete
  bool ambiguous = false;  ///< does anything that moves depend on discrete states that differ?
};

/// Everything about a problem that all parts of the initial set share. Safe for several threads.
class Stages {
 public:
  /// @error if the problem uses what cannot be analysed.
  ///
  /// @param asked  terms that are observed besides claims and conditions.
  static base::Result<std::unique_ptr<Stages>> Of(const Problem& problem, std::vector<TermId> asked = {});

  /// The stage for these modes, ascending. `scaled`: with a factor for all rates as a further state, whose
  /// own rate is zero.
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
  /// Is one term of a comparison the negation of the other?
  bool AreOpposite(TermId a, TermId b);

 private:
  base::Result<std::shared_ptr<const Stage>> Make(const std::vector<Mode>& modes, bool scaled);
  /// The variables of a stage's programs, how many of them are states, and discrete states that have one value.
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
