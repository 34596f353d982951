#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "choreo/obligations/obligations.h"
#include "choreo/prove/switches.h"
#include "expr/numeric.h"
#include "solve/solver.h"

/// Shares what proofs and refutations of one step need.
namespace rondo::choreo {

/// Asks a solver for a solution of a formula; the flag says whether with a certificate that there is none.
using AskSolver = std::function<solve::Answer(expr::TermId, bool certificate)>;

/// Holds one of the starts of a step that has to be kept, and what is asked about it. Thread-compatible.
class KeepingStart {
 public:
  /// Decides conditions of `during` that are about constants alone, by asking. All but `start` must outlive
  /// it.
  KeepingStart(expr::Arena& arena, const Keeping& keeping, expr::TermId clock, expr::TermId start,
               const AskSolver& ask);

  expr::Arena& arena() { return arena_; }
  const Keeping& keeping() const { return k_; }
  expr::TermId clock() const { return clock_; }
  expr::TermId start() const { return start_; }
  /// Returns what must hold at every moment, with those conditions decided.
  expr::TermId during() const { return during_; }
  Switches& switches() { return *switches_; }
  /// Returns what a state is when the step begins: a constant, if that is said, or the variable that stands
  /// for it.
  expr::TermId Begin(expr::TermId state) const { return begin_.at(state); }
  const expr::Substitution& begin() const { return begin_; }

  expr::TermId Number(const expr::Rational& r) { return arena_.Number(arena_.Real(), r); }
  /// Returns the formula at a moment of the clock.
  expr::TermId At(expr::TermId formula, const expr::Rational& seconds);
  /// Returns the formula at the moment when the step begins, at which what others do has not changed yet.
  expr::TermId AtStart(expr::TermId formula);
  /// Reports whether the formula depends on the variable.
  bool Has(expr::TermId formula, expr::TermId variable) const;
  /// Returns the conjuncts of a formula.
  std::vector<expr::TermId> Parts(expr::TermId formula) const;
  /// Returns 0 <= clock <= most (seconds); without `most`, 0 <= clock.
  expr::TermId Elapsed(const std::optional<expr::Rational>& most);

  /// Asks whether a formula has no solution. If so, keeps the certificate for the proof and returns true.
  bool Refutes(expr::TermId formula);
  /// Reports whether a formula has no solution, without a certificate: good for search and refutations, not
  /// for proofs.
  bool IsImpossible(expr::TermId formula) const;
  /// Returns a solution of a formula; nothing if none was found.
  std::optional<expr::Numeric::Point> Solution(expr::TermId formula) const;
  /// Forgets the certificates of an attempt that failed.
  void Forget() { certificates_.clear(); }
  /// Returns the certificates of what has been refuted since, and of the conditions that were decided at the
  /// beginning.
  std::vector<std::string> TakeCertificates();

 private:
  void Settle();
  void FindBegin();

  expr::Arena& arena_;
  const Keeping& k_;
  expr::TermId clock_, start_, during_;
  const AskSolver& ask_;
  expr::Substitution begin_;
  std::optional<Switches> switches_;
  std::vector<std::string> settled_, certificates_;
};

}  // namespace rondo::choreo
