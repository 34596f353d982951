#pragma once

#include <limits>
#include <unordered_map>

#include "expr/arena.h"

/// Terms in double precision, for what need not be rigorous.
namespace rondo::expr {

/// Evaluates real terms in double precision, for search, pictures and tests: nothing here is rigorous.
/// Variables without a value are 0; where a function has no value, the result is NaN. Each distinct subterm
/// is computed once.
class Numeric {
 public:
  using Point = std::unordered_map<TermId, double>;

  Numeric(const Arena& arena, const Point& point) : arena_(arena), known_(point) {}
  /// Returns the value of a term of sort Int or Real.
  double operator()(TermId term);
  /// Returns how far the formula is from being true: 0 if it is. Of a comparison, by how much it fails; of a
  /// conjunction the largest, of a disjunction the smallest.
  double Violation(TermId formula) { return Miss(formula, true); }
  /// Reports whether this is how far a formula is from being true where all that is missing is that a strict comparison is equal.
  static bool OnEdge(double violation) { return violation == std::numeric_limits<double>::denorm_min(); }

 private:
  double One(TermId term);
  double Miss(TermId formula, bool positive);

  const Arena& arena_;
  Point known_;
};

}  // namespace rondo::expr
