#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "koord/semantics/team.h"
#include "sim/simulation.h"

namespace rondo::sim {

/// Checks a run against its specification while it happens: invariants, assumptions about ports and
/// controllers, summaries.
class Monitor {
 public:
  using Report = std::function<void(const Violation&, bool first)>;
  Monitor(koord::semantics::Team& team, diag::Diagnostics& diagnostics, Report report);

  /// The initial state: `assume initially`, and everything that always holds.
  void Initially(std::span<koord::semantics::Word> state);
  /// The end of a program transition.
  void Settled(double time, std::span<koord::semantics::Word> state);
  /// A moment of the environment's turn that began with `settled`.
  void During(double time, std::span<koord::semantics::Word> state,
              std::span<const koord::semantics::Word> settled);
  /// A call returned what a summary excludes.
  void Summary(double time);

  const std::vector<Violation>& violations() const { return violations_; }

 private:
  void Formula(double time, const koord::semantics::FormulaCode& formula, const std::string& kind,
               diag::Kind what);
  void Violated(double time, const std::string& what, int robot, diag::Span span, diag::Kind kind);

  koord::semantics::Team& team_;
  diag::Diagnostics& diagnostics_;
  Report report_;
  std::vector<Violation> violations_;
  std::set<std::string> now_;  // violated at the last check of the same kind: counted once
};

}  // namespace rondo::sim
