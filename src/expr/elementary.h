#pragma once

#include <optional>
#include <span>

#include "expr/op.h"
#include "expr/rational.h"

namespace rondo::expr {

/// Has it no value for some arguments? (Division by zero is some number, as in SMT-LIB.)
constexpr bool IsPartialFunction(Elementary f) {
  return f == Elementary::kSqrt || f == Elementary::kLog || f == Elementary::kAsin || f == Elementary::kAcos;
}

/// The value of `function` at rational arguments, where that is known to be rational: sqrt(4/9), abs, min,
/// max, sin 0, log 1 and the like. nullopt otherwise.
std::optional<Rational> ExactValue(Elementary function, std::span<const Rational> args);

}  // namespace rondo::expr
