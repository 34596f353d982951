#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "reach/problem/program.h"
#include "verdict/truth.h"

/// Formulas about reals in the form that tubes are compared with: comparisons with zero.
namespace rondo::reach {

/// Is a formula about reals as comparisons of terms with zero, below conjunctions and disjunctions.
struct Formula {
  enum class Kind : uint8_t { kAtom, kAnd, kOr };
  struct Node {
    Kind kind;
    size_t atom = 0;            ///< of kAtom: index into `terms`
    bool strict = false;        ///< of kAtom: term < 0, else term <= 0
    std::vector<size_t> parts;  ///< of kAnd, kOr: indices into `nodes`
  };
  std::vector<TermId> terms;
  std::vector<Node> nodes;
  size_t root = 0;

  /// Tells what is known of the formula where the terms lie in these intervals.
  verdict::Truth Check(const std::function<Interval(size_t)>& range) const;
  /// Reports whether the formula holds, where the terms lie in these intervals, if and only if its
  /// comparisons of this term do.
  bool ComesDownTo(size_t term, const std::function<Interval(size_t)>& range) const;
  /// Returns the term that it comes down to there, among those that may be zero or less; nothing if there is
  /// none.
  std::optional<size_t> Deciding(const std::function<Interval(size_t)>& range) const;
  /// Returns by how much the formula fails, at most, where the terms have these values: 0 or less if it
  /// holds. A strict comparison of what is exactly equal fails by 1: modes are exact.
  double Miss(const std::function<double(size_t)>& value) const;
};

/// Returns the formula in this form. Negations are pushed inwards; an atomic formula, negated or not, is
/// false where a term has no value; equalities are two comparisons; |a| <= b and the like are taken apart.
///
/// @error names what is no comparison of reals.
base::Result<Formula> Normalise(expr::Arena& arena, TermId formula);

}  // namespace rondo::reach
