#pragma once

#include <string>

#include "reach/problem/problem.h"

namespace rondo::reach {

/// The problem as text that says all of it: equal texts are equal problems. One line for each distinct
/// subterm; states and inputs are numbered, so that robots of one type have the same text.
std::string ToText(const Problem& problem);

}  // namespace rondo::reach
