#pragma once

#include <string>

#include "reach/problem/problem.h"

/// Problems as text, by which proofs are found again.
namespace rondo::reach {

/// Returns the problem as text that says all of it: equal texts are equal problems. One line for each
/// distinct subterm; states and inputs are numbered, so that robots of one type have the same text.
std::string ToText(const Problem& problem);

}  // namespace rondo::reach
