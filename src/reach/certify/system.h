#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "reach/certify/step.h"
#include "reach/problem/formula.h"
#include "reach/problem/modes.h"
#include "reach/problem/problem.h"

namespace rondo::reach::certify {

/// A claim in one mode, compiled.
struct ModeClaim {
  const Claim* claim = nullptr;
  size_t mode = 0;  ///< of those of the system
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  /// By term: certainly at most zero at the start, though rounding may not tell, and continuous?
  std::vector<bool> starts_below;
  /// By term: at most zero for as long as the mode lasts, since an event ends it otherwise?
  std::vector<bool> implied;
};

/// The condition of an event that leads out of a mode.
struct ModeGuard {
  size_t mode = 0;  ///< of those of the system
  size_t event = 0;
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  Mode after;

  /// A single comparison, `term <= 0` or `term < 0`?
  bool IsComparison() const { return formula.nodes[formula.root].kind == Formula::Kind::kAtom; }
};

/// A problem while its discrete states have the values of one of some modes. Values that these agree on are
/// numbers in all programs; the others are inputs of the dynamics and the controller, which may change at any
/// time.
struct ModeSystem {
  std::vector<Mode> modes;
  Dynamics dynamics;
  Program control;   ///< what the states are after the controller has acted
  Program observed;  ///< the terms of all claims and guards
  std::vector<ModeClaim> claims;
  std::vector<ModeGuard> guards;
  std::vector<std::optional<Interval>> discrete;  ///< by state: its values, if it is discrete
};

/// What there is to check about a problem: the same for all parts of the initial set. Safe for several
/// threads.
class System {
 public:
  /// @error if the problem has what cannot be analysed.
  static base::Result<std::unique_ptr<System>> Of(const Problem& problem);

  const Problem& problem() const { return *problem_; }
  const Modes& modes() const { return modes_; }
  /// Does nothing in the box satisfy what is assumed?
  bool IsEmpty(const interval::Box& box) const;
  /// 0, samples, beginnings and ends of claims, the horizon; ascending.
  const std::vector<Rational>& instants() const { return instants_; }
  /// Does the controller act at this instant?
  bool IsSample(const Rational& instant) const;
  /// The problem while one of these modes lasts: ascending, none of them twice.
  ///
  /// @error if something has no meaning in one of them.
  base::Result<std::shared_ptr<const ModeSystem>> For(const std::vector<Mode>& modes);
  /// Is one term the negation of the other?
  bool AreOpposite(TermId a, TermId b);

 private:
  base::Result<std::shared_ptr<const ModeSystem>> Make(const std::vector<Mode>& modes);
  base::Result<bool> Observe(ModeSystem& system, size_t mode, std::vector<TermId>& terms);
  void FindKnown(ModeSystem& system) const;

  const Problem* problem_ = nullptr;
  Modes modes_;
  Formula assumed_;
  Program assumed_terms_;
  std::vector<Rational> instants_;
  std::mutex mutex_;
  std::map<std::vector<Mode>, std::shared_ptr<const ModeSystem>> made_;
  std::vector<TermId> stand_ins_;  ///< by discrete state, where it is an input
};

}  // namespace rondo::reach::certify
