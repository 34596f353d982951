#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "expr/op.h"
#include "expr/rational.h"

/// What is known of the functions of reals apart from their enclosures: names, domains, exact values.
namespace rondo::expr {

/// Reports whether the function has no value for some arguments. (Division by zero is some number, as in
/// SMT-LIB.)
constexpr bool IsPartialFunction(Elementary f) {
  constexpr bool kPartial[] = {
#define RONDO_ELEMENTARY(kind, name, other, arity, partial) partial,
#include "expr/elementary.def"
#undef RONDO_ELEMENTARY
      false};
  return kPartial[static_cast<size_t>(f)];
}

/// Returns the function with this name, or this other name; nothing if there is none.
std::optional<Elementary> FindElementary(std::string_view name);

/// Returns the value of `function` at rational arguments, where that is known to be rational: sqrt(4/9), abs,
/// min, max, sin 0, log 1 and the like. nullopt otherwise.
std::optional<Rational> ExactValue(Elementary function, std::span<const Rational> args);

}  // namespace rondo::expr
