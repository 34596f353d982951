#pragma once

#include <optional>
#include <vector>

#include "solve/icp/prepare/prepare.h"

/// Angles that matter up to full turns: one period of them is enough.
namespace rondo::solve::icp {

/// Returns a number of at least one period: if `variable` occurs in `terms` (or formulas) only in sines and
/// cosines of q variable + r, for rational q and for r without it, then adding a multiple of the period
/// changes none of them, so that one window of this width has a solution if there is any. nullopt if it
/// occurs otherwise. Cost: linear in the number of distinct subterms.
std::optional<Rational> PeriodOf(const expr::Arena& arena, const std::vector<TermId>& terms, TermId variable);

/// Bounds each real variable that is unbounded on one side or both and, apart from a bound, matters up to
/// full turns only: one period of it is enough. Afterwards some solution remains, if there was any; others
/// may be gone. `proof`, if there is one, gets a step for each.
void BoundAngles(const expr::Arena& arena, const std::unordered_map<TermId, Variable>& variables,
                 Prepared& prepared, Proof* proof);

}  // namespace rondo::solve::icp
