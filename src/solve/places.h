#pragma once

#include <map>
#include <set>
#include <vector>

#include "expr/arena.h"

/// Where terms stand: what complete instantiation goes by (Ge & de Moura, CAV 2009).
namespace rondo::solve {

/// Says where a term can stand as an argument of something uninterpreted: an argument of a function, an index
/// of an array, of a list, an operand of a field or an equality.
struct Place {
  expr::Op op;
  uint32_t what;      ///< the symbol of a function or array; the sort for the rest
  uint32_t position;  ///< which argument, from 0
  friend auto operator<=>(const Place&, const Place&) = default;
};

/// Knows the closed terms that stand at each place of the formulas added so far, in order of first sight.
class PlaceIndex {
 public:
  explicit PlaceIndex(const expr::Arena& arena) : arena_(arena) {}
  /// Adds the terms of a formula. Cost: linear in the number of its subterms that are new.
  void Add(expr::TermId formula);
  /// Returns the closed terms that stand at a place.
  const std::vector<expr::TermId>& At(const Place& place) const;
  /// Returns the closed applications of a function.
  const std::vector<expr::TermId>& Applications(expr::SymbolId function) const;

 private:
  const expr::Arena& arena_;
  std::unordered_set<expr::TermId> seen_;
  std::map<Place, std::vector<expr::TermId>> terms_;
  std::map<expr::SymbolId, std::vector<expr::TermId>> applications_;
  std::map<Place, std::unordered_set<expr::TermId>> known_;
};

/// Is a place of a variable: the variable itself stands there, or the variable plus `offset`.
struct VariablePlace {
  Place place;
  expr::Rational offset;
};

/// Returns the closed terms that each of `variables`, of a sort of numbers, is compared with by equality in
/// `body`.
std::map<expr::TermId, std::vector<expr::TermId>> EqualTerms(const expr::Arena& arena, expr::TermId body,
                                                             const std::vector<expr::TermId>& variables);

/// Returns the places of each of `variables` in `body`.
std::map<expr::TermId, std::vector<VariablePlace>> PlacesOf(const expr::Arena& arena, expr::TermId body,
                                                            const std::vector<expr::TermId>& variables);

}  // namespace rondo::solve
