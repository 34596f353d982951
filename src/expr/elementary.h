#pragma once

#include <optional>
#include <span>

#include "expr/op.h"
#include "expr/rational.h"

namespace rondo::expr {

/// The value of `function` at rational arguments, where that is known to be rational: sqrt(4/9), abs, min,
/// max, sin 0, log 1 and the like. nullopt otherwise.
std::optional<Rational> ExactValue(Elementary function, std::span<const Rational> args);

}  // namespace rondo::expr
