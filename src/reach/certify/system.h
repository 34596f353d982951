#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "reach/certify/step.h"
#include "reach/problem/formula.h"
#include "reach/problem/modes.h"
#include "reach/problem/problem.h"

/// A problem as the checker sees it, compiled once for all parts of the initial set.
namespace rondo::reach::certify {

/// Is a claim in one mode, compiled.
struct ModeClaim {
  const Claim* claim = nullptr;
  size_t mode = 0;  ///< its index among the modes of the system
  Formula formula;
  size_t first = 0;  ///< where its terms begin among the observed outputs
  /// By term: whether it is continuous and certainly at most zero at the start, though rounding may not tell.
  std::vector<bool> starts_below;
  /// By term: whether it is at most zero for as long as the mode lasts, since an event ends the mode
  /// otherwise.
  std::vector<bool> implied;
};

/// Is the condition of an event that leads out of a mode, compiled.
struct ModeGuard {
  size_t mode = 0;  ///< its index among the modes of the system
  size_t event = 0;
  Formula formula;
  size_t first = 0;  ///< where its terms begin among the observed outputs
  Mode after;        ///< the discrete states once the event has happened

  /// Reports whether it is a single comparison, `term <= 0` or `term < 0`.
  bool IsComparison() const { return formula.nodes[formula.root].kind == Formula::Kind::kAtom; }
};

/// Is a problem while its discrete states have the values of one of some modes. Values that these agree on
/// are numbers in all programs; the others are inputs of the dynamics and the controller, which may change at
/// any time.
struct ModeSystem {
  std::vector<Mode> modes;
  Dynamics dynamics;
  Program control;   ///< what the states are after the controller has acted
  Program observed;  ///< the terms of all claims and guards, one after the other
  std::vector<ModeClaim> claims;
  std::vector<ModeGuard> guards;
  std::vector<std::optional<Interval>> discrete;  ///< by state: its values, if it is discrete
};

/// Holds what there is to check about a problem: the same for all parts of the initial set. Safe for several
/// threads.
class System {
 public:
  /// Compiles the problem, which must outlive the result. @error if the problem has what cannot be analysed.
  static base::Result<std::unique_ptr<System>> Of(const Problem& problem);

  const Problem& problem() const { return *problem_; }
  const Modes& modes() const { return modes_; }
  /// Reports whether certainly nothing in the box satisfies what is assumed.
  bool IsEmpty(const interval::Box& box) const;
  /// Returns the instants at which something must be looked at, ascending, in seconds: 0, samples, beginnings
  /// and ends of claims, the horizon.
  const std::vector<Rational>& instants() const { return instants_; }
  /// Reports whether the controller acts at this instant.
  bool IsSample(const Rational& instant) const;
  /// Returns the problem while one of these modes lasts: ascending, none of them twice. Made once.
  ///
  /// @error if something has no meaning in one of them.
  base::Result<std::shared_ptr<const ModeSystem>> For(const std::vector<Mode>& modes);
  /// Reports whether one term is the negation of the other.
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
