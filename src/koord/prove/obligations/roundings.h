#pragma once

#include <set>
#include <vector>

#include "koord/prove/execution/vocabulary.h"

/// Tells the solver what it has to know about `floor` and `sqrt`.
namespace rondo::koord {

/// States, of each term `floor(x)` or `sqrt(x)` that occurs in formulas, which number it is: the greatest integer that is
/// not above x; the number that is not negative and whose square is x, if x is not negative. Solvers take the two for
/// uninterpreted functions, so a model of formulas without bound variables in them is a true one.
/// Cost: linear in the formulas.
class Roundings {
 public:
  explicit Roundings(Vocabulary& vocabulary) : vocabulary_(vocabulary), arena_(vocabulary.arena()) {}
  /// Returns the axioms for the terms in `formulas` that earlier calls have not returned.
  std::vector<TermId> Axioms(const std::vector<TermId>& formulas);

 private:
  Vocabulary& vocabulary_;
  expr::Arena& arena_;
  std::set<TermId> said_;
};

/// Reports whether a quantifier in `formulas` rounds numbers that have no name. A model may take any function for those,
/// and nothing says that the true one would do.
bool RoundsAnyNumber(Vocabulary& vocabulary, const std::vector<TermId>& formulas);

}  // namespace rondo::koord
