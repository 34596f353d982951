#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "reach/certify/step.h"
#include "reach/system/formula.h"
#include "reach/system/modes.h"
#include "reach/system/problem.h"

namespace rondo::reach::certify {

/// A claim in one mode, compiled.
struct ModeClaim {
  const Claim* claim = nullptr;
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  /// By term: certainly at most zero at the start, though rounding may not tell, and continuous?
  std::vector<bool> starts_below;
  /// By term: at most zero for as long as the mode lasts, since an event ends it otherwise?
  std::vector<bool> implied;
};

/// The condition of an event that leads out of a mode.
struct ModeGuard {
  size_t event = 0;
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  Mode after;

  /// A single comparison, `term <= 0` or `term < 0`?
  bool IsComparison() const { return formula.nodes[formula.root].kind == Formula::Kind::kAtom; }
};

/// A problem while its discrete states have certain values: they are numbers in all programs.
struct ModeSystem {
  Mode mode;
  Dynamics dynamics;
  Program control;   ///< what the states are after the controller has acted
  Program observed;  ///< the terms of all claims and guards
  std::vector<ModeClaim> claims;
  std::vector<ModeGuard> guards;
  std::vector<std::optional<Interval>> discrete;  ///< by state: its value, if it is discrete
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
  /// @error if something has no meaning in this mode.
  base::Result<std::shared_ptr<const ModeSystem>> For(const Mode& mode);

 private:
  base::Result<std::shared_ptr<const ModeSystem>> Make(const Mode& mode);
  void FindKnown(ModeSystem& system) const;

  const Problem* problem_ = nullptr;
  Modes modes_;
  Formula assumed_;
  Program assumed_terms_;
  std::vector<Rational> instants_;
  std::mutex mutex_;
  std::map<Mode, std::shared_ptr<const ModeSystem>> made_;
};

}  // namespace rondo::reach::certify
