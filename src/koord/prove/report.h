#pragma once

#include "koord/prove/obligations/problem.h"
#include "koord/prove/prove.h"
#include "koord/prove/witness.h"
#include "koord/prove/witness_replay.h"

/// Says what became of the proof of a Koord program, in words that lead to a repair.
namespace rondo::koord {

/// Turns what the solver said into verdicts and diagnostics that a robotics engineer can act on. All
/// arguments must outlive it; `witnesses` holds the counterexamples by number of the invariant.
class Reporter {
 public:
  Reporter(const Model& model, const ProveOptions& options, Problems& problems,
           diag::Diagnostics& diagnostics, Report& report, const std::map<size_t, Witness>& witnesses)
      : model_(model),
        options_(options),
        problems_(problems),
        diagnostics_(diagnostics),
        report_(report),
        witnesses_(witnesses) {}

  /// Reports that the assumptions named in `core` cannot all be true, and marks the report: then nothing
  /// counts as proved. `what` says which check found it.
  void Contradiction(const std::string& what, const std::vector<std::string>& core);
  /// Reports that no state that satisfies the invariants enables the event of this action; `core` names what
  /// excludes it.
  void NeverEnabled(size_t action, const std::vector<std::string>& core);
  /// Reports that promise `p` need not hold yet when the environment takes over, if a team of one or two
  /// robots shows that with every quantifier in place; else reports nothing. Asks the solver, for a second at
  /// most each time.
  void Unrealisable(size_t p);
  /// Warns of promises that exclude each other.
  void Excluding();
  /// Reports each invariant that could not be proved, with its witness or what is known instead.
  void Failures();
  /// Decides the verdicts of the rows that did not fail: proved, unless a proof rests on what is not proved.
  /// This is the greatest set of invariants that rest on each other only (docs/theory.md, "Dependence").
  void Verdicts();

 private:
  void FailedInvariant(size_t i);
  void Told(Row& row, const InvariantDef& def, const Witness& witness);
  void ToldCutOff(Row& row, const InvariantDef& def, const Witness& witness, const WitnessReplay& replay);
  void FailedDefinedness(Cell& cell, size_t place);
  void Undecided(Row& row, const Cell& cell, diag::Span span, const Witness* candidate);
  diag::Span SpanOf(const std::string& assumption) const;
  std::string Scope() const;

  const Model& model_;
  const ProveOptions& options_;
  Problems& problems_;
  diag::Diagnostics& diagnostics_;
  Report& report_;
  const std::map<size_t, Witness>& witnesses_;
};

}  // namespace rondo::koord
