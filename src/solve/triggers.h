#pragma once

#include <map>
#include <vector>

#include "expr/arena.h"
#include "solve/places.h"

namespace rondo::solve {

/// Smallest sets of applications f(..x..y..) in `body`, with only variables and closed terms as arguments, in
/// which all of `variables` occur: what E-matching instantiates by. All sets of the least size up to 3; none
/// if there is none.
std::vector<std::vector<expr::TermId>> FindTriggers(const expr::Arena& arena, expr::TermId body,
                                                    const std::vector<expr::TermId>& variables);

/// Every way to make each pattern of a trigger equal to a closed application seen by `index`: values of
/// `variables`.
std::vector<std::vector<expr::TermId>> MatchTrigger(const expr::Arena& arena, const PlaceIndex& index,
                                                    const std::vector<expr::TermId>& trigger,
                                                    const std::vector<expr::TermId>& variables, size_t limit);

}  // namespace rondo::solve
