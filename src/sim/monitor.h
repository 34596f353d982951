#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "koord/semantics/responses.h"
#include "sim/simulation.h"

/// Watches simulations.
namespace rondo::sim {

/// Checks a run against its specification while it happens: invariants, assumptions about ports and
/// controllers, summaries.
class Monitor {
 public:
  /// Receives each violation, every time that it is seen; `first`: it is the first time for that robot.
  using Report = std::function<void(const Violation&, bool first)>;
  Monitor(koord::semantics::Team& team, diag::Diagnostics& diagnostics, Report report);

  /// Checks the initial state, at t = 0: general assumptions, `assume initially`, what always holds of ports,
  /// and invariants.
  void Initially(std::span<koord::semantics::Word> state);
  /// Checks the invariants at the end of a program transition; `time` in seconds. Those that have to hold between rounds only
  /// wait for the end of the round.
  void Settled(double time, std::span<koord::semantics::Word> state, bool between_rounds = false);
  /// Takes in a state between rounds, the first one included: does everything follow as soon as it has to?
  void Between(double time, std::span<koord::semantics::Word> state);
  /// Checks a moment of the environment's turn that began with `settled`: controller assumptions and
  /// invariants.
  /// @param between_rounds  it is the last moment of the round.
  void During(double time, std::span<koord::semantics::Word> state,
              std::span<const koord::semantics::Word> settled, bool between_rounds = true);
  /// Notes that a robot did what its model excludes: `temperature` in [60, 82] does not hold.
  void Model(double time, const std::string& what, size_t robot, diag::Span span);
  /// Notes the first call since the last check that returned what a summary excludes, if there was one.
  void Summary(double time);

  const std::vector<Violation>& violations() const { return violations_; }

 private:
  void Formula(double time, const koord::semantics::FormulaCode& formula, const std::string& kind,
               diag::Kind what);
  void Violated(double time, const std::string& what, int robot, diag::Span span, diag::Kind kind);

  koord::semantics::Team& team_;
  diag::Diagnostics& diagnostics_;
  Report report_;
  koord::semantics::Responses responses_;
  std::vector<koord::semantics::Word> waits_;
  std::vector<Violation> violations_;
  std::set<std::string> now_;  // violated at the last check of the same kind: counted once
};

}  // namespace rondo::sim
