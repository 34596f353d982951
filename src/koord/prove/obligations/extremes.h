#pragma once

#include <map>
#include <vector>

#include "koord/prove/execution/vocabulary.h"
#include "solve/solver.h"

/// Tells the solver that a team is finite.
namespace rondo::koord {

/// States that one robot has the least and one the largest value of every number t(i), since a team is
/// finite: for each t that `formulas` compare between two robots of quantifiers (`t(j) <= t(i)`), `exists m:
/// forall k: t(k) <= t(m)` and the same from below. No other axiom says that a team is finite, and instances
/// alone do not need it: only invariants like `exists i in ID: forall j in ID: x[j] <= x[i]` do.
/// Cost: linear in the number of distinct subterms.
class Extremes {
 public:
  explicit Extremes(Vocabulary& vocabulary);
  /// Returns the axioms for what is compared in `formulas`; for one value always the same formulas.
  std::vector<solve::Assertion> Axioms(const std::vector<solve::Assertion>& formulas);

 private:
  const std::vector<solve::Assertion>& Of(TermId value);

  Vocabulary& vocabulary_;
  expr::Arena& arena_;
  TermId robot_;  // whose values are told apart
  std::map<TermId, std::vector<solve::Assertion>> axioms_;
};

}  // namespace rondo::koord
