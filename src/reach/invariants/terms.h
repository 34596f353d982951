#pragma once

#include "reach/problem/problem.h"

/// What the search for invariants asks of terms.
namespace rondo::reach::invariants {

/// Reports whether the term, or each comparison of the formula, has a value everywhere that depends on its
/// variables continuously.
bool IsContinuous(const expr::Arena& arena, TermId term);

/// Returns the derivative of the term in time along these rates, by state: exact. Nothing if the term depends
/// on anything but states, or is not made of sums, products, sines, cosines and exponentials.
std::optional<TermId> RateOf(expr::Arena& arena, TermId term, const std::vector<TermId>& states,
                             const std::vector<TermId>& rates);

}  // namespace rondo::reach::invariants
