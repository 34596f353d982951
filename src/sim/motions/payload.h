#pragma once

#include <optional>
#include <random>
#include <vector>

#include "choreo/graph/graph.h"
#include "expr/numeric.h"

namespace rondo::sim::motions {

/// Returns values at random for the payload of a message that only says what is known of it, as the state is: SI units, in the
/// order of its terms. Nothing if none were found.
std::optional<std::vector<double>> DrawPayload(expr::Arena& arena, const choreo::Node& message,
                                               const expr::Numeric::Point& state, std::mt19937_64& random);

}  // namespace rondo::sim::motions
