#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/stop.h"
#include "solve/icp/prepare/literal.h"
#include "solve/icp/prepare/lower.h"
#include "solve/icp/prepare/proof.h"
#include "solve/icp/prepare/rotation.h"

/// Exact arithmetic before the search: what it can use is used up.
namespace rondo::solve::icp {

/// Holds what is known of one term: bounds, and values that it does not have.
struct Range {
  std::optional<Rational> lo, hi;
  bool lo_strict = false;
  bool hi_strict = false;
  std::vector<Rational> excluded;

  /// Adds `relation bound`. Does not look for contradictions.
  void Add(Relation relation, const Rational& bound);
  /// Reports whether no number is in the range.
  bool IsContradiction() const;
  /// Returns the only value, if there is one.
  std::optional<Rational> Only() const;
  /// Returns the comparisons of `term` that say the same.
  std::vector<Literal> Literals(TermId term) const;
};

/// Is a conjunction from which all that exact arithmetic can use has been used.
struct Prepared {
  bool contradiction = false;      ///< whether it has no solution, which exact arithmetic shows
  std::map<TermId, Range> ranges;  ///< by the term of the literals: bounds of variables are among them
  /// Formulas that must hold, too, and that are no comparisons.
  std::vector<TermId> disjunctions;
  /// Equations that hold for all values of the variables: for contraction only.
  std::vector<Lemma> lemmas;
  /// Variables that were eliminated: variable = term over the variables that are left.
  std::vector<std::pair<TermId, TermId>> definitions;
};

/// Returns what is equivalent to the conjunction of `conjuncts`, up to the definitions: every solution of the
/// result extends to one of the conjuncts by the definitions, and every solution of the conjuncts arises so.
/// Uses linear equations to eliminate variables, turns bounds of square roots into bounds of their arguments,
/// splits vanishing sums of squares, and merges all comparisons of one term; everything in exact arithmetic.
/// `proof`, if there is one, gets the steps that a checker cannot see by itself. Once `stop` asks for it, what could be
/// written more shortly is left as it is.
Prepared Prepare(expr::Arena& arena, const std::unordered_map<TermId, Variable>& variables,
                 std::vector<TermId> conjuncts, std::vector<std::pair<TermId, TermId>> definitions,
                 Proof* proof = nullptr, const base::StopToken& stop = {});

/// Rewrites the sums in `prepared` over rotated frames and adds their lemmas; see Rotations.
/// @param links  whether sums are tied to the coordinates in frames, too: fewer boxes, and each costs more.
/// Returns whether there are such ties. Sums are left as they are once `stop` asks for it.
bool AddRotations(expr::Arena& arena, Prepared& prepared, bool links, const base::StopToken& stop);

/// Returns everything in `prepared` as formulas, lemmas apart.
std::vector<TermId> Conjuncts(expr::Arena& arena, const Prepared& prepared);

}  // namespace rondo::solve::icp
