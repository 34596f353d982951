#pragma once

#include <optional>
#include <vector>

#include "expr/op.h"
#include "expr/rational.h"

/// Values of functions that the checker of certificates knows.
namespace rondo::solve::certify {

/// Returns the value of a function at numbers, where it is rational and easily seen to be: from the
/// definitions, and not from what the search knows. nullopt where there is no value, or none that is known.
std::optional<expr::Rational> KnownValue(expr::Elementary function, const std::vector<expr::Rational>& args);

}  // namespace rondo::solve::certify
