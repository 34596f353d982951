#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "choreo/obligations/obligations.h"
#include "choreo/prove/switches.h"
#include "expr/numeric.h"
#include "solve/solver.h"

namespace rondo::choreo {

/// Asks for a solution of a formula; whether with a certificate that there is none.
using AskSolver = std::function<solve::Answer(expr::TermId, bool certificate)>;

/// One of the starts of a step that has to be kept, and what is asked about it. Thread-compatible.
class KeepingStart {
 public:
  /// Decides conditions of `during` that are about constants alone. `keeping`, `ask` outlive it.
  KeepingStart(expr::Arena& arena, const Keeping& keeping, expr::TermId clock, expr::TermId start,
               const AskSolver& ask);

  expr::Arena& arena() { return arena_; }
  const Keeping& keeping() const { return k_; }
  expr::TermId clock() const { return clock_; }
  expr::TermId start() const { return start_; }
  expr::TermId during() const { return during_; }
  Switches& switches() { return *switches_; }
  /// What a state is when the step begins: a constant, if that is said, or the variable that stands for it.
  expr::TermId Begin(expr::TermId state) const { return begin_.at(state); }
  const expr::Substitution& begin() const { return begin_; }

  expr::TermId Number(const expr::Rational& r) { return arena_.Number(arena_.Real(), r); }
  expr::TermId At(expr::TermId formula, const expr::Rational& seconds);
  /// At the moment when the step begins, at which what others do has not changed yet.
  expr::TermId AtStart(expr::TermId formula);
  bool Has(expr::TermId formula, expr::TermId variable) const;
  std::vector<expr::TermId> Parts(expr::TermId formula) const;
  /// 0 <= clock <= most
  expr::TermId Elapsed(const std::optional<expr::Rational>& most);

  /// There is no solution; its certificate is kept for the proof.
  bool Refutes(expr::TermId formula);
  bool IsImpossible(expr::TermId formula) const;
  std::optional<expr::Numeric::Point> Solution(expr::TermId formula) const;
  /// Forgets the certificates of an attempt.
  void Forget() { certificates_.clear(); }
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
