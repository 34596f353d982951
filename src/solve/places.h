#pragma once

#include <map>
#include <set>
#include <vector>

#include "expr/arena.h"

namespace rondo::solve {

/// Where a term can stand as an argument of something uninterpreted: an argument of a function, an index of
/// an array, of a list, an operand of a field or an equality.
struct Place {
  expr::Op op;
  uint32_t what;  ///< the symbol of a function or array; the sort for the rest
  uint32_t position;
  friend auto operator<=>(const Place&, const Place&) = default;
};

/// The closed terms that stand at each place of the formulas added so far, in order of first sight.
class PlaceIndex {
 public:
  explicit PlaceIndex(const expr::Arena& arena) : arena_(arena) {}
  void Add(expr::TermId formula);
  const std::vector<expr::TermId>& At(const Place& place) const;
  /// The closed applications of a function.
  const std::vector<expr::TermId>& Applications(expr::SymbolId function) const;

 private:
  const expr::Arena& arena_;
  std::unordered_set<expr::TermId> seen_;
  std::map<Place, std::vector<expr::TermId>> terms_;
  std::map<expr::SymbolId, std::vector<expr::TermId>> applications_;
  std::map<Place, std::unordered_set<expr::TermId>> known_;
};

/// A place of a variable: the variable itself stands there, or the variable plus `offset`.
struct VariablePlace {
  Place place;
  expr::Rational offset;
};

/// The closed terms that each of `variables`, of a sort of numbers, is compared with by equality in `body`.
std::map<expr::TermId, std::vector<expr::TermId>> EqualTerms(const expr::Arena& arena, expr::TermId body,
                                                             const std::vector<expr::TermId>& variables);

/// The places of each of `variables` in `body`.
std::map<expr::TermId, std::vector<VariablePlace>> PlacesOf(const expr::Arena& arena, expr::TermId body,
                                                            const std::vector<expr::TermId>& variables);

}  // namespace rondo::solve
