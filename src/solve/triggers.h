#pragma once

#include <map>
#include <vector>

#include "expr/arena.h"
#include "solve/places.h"

/// Triggers: patterns by which quantifiers over several variables are instantiated (E-matching).
namespace rondo::solve {

/// Returns the smallest sets of applications f(..x..y..) in `body`, with only variables and closed terms as
/// arguments, in which all of `variables` occur: what E-matching instantiates by. All sets of the least size
/// up to 3; none if there is none.
std::vector<std::vector<expr::TermId>> FindTriggers(const expr::Arena& arena, expr::TermId body,
                                                    const std::vector<expr::TermId>& variables);

/// Returns every way, up to `limit` of them, to make each pattern of a trigger equal to a closed application
/// seen by `index`: values of `variables`, in their order.
std::vector<std::vector<expr::TermId>> MatchTrigger(const expr::Arena& arena, const PlaceIndex& index,
                                                    const std::vector<expr::TermId>& trigger,
                                                    const std::vector<expr::TermId>& variables, size_t limit);

}  // namespace rondo::solve
