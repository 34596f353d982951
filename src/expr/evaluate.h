#pragma once

#include <functional>
#include <optional>

#include "expr/arena.h"
#include "expr/value.h"

/// Evaluation of terms in a model, apart from the solver that found the model.
namespace rondo::expr {

/// Gives values to variables and to applications, array reads and list operations: to what the logic leaves
/// open. nullopt: it gives none to this term.
using Valuation = std::function<std::optional<Value>(TermId)>;

/// Returns the value of a closed term in exact arithmetic, computed without any solver. nullopt where the
/// term has none: a quantifier, a whole array, a zero divisor, or a leaf without a value, if the result
/// depends on it. Cost: linear in the number of distinct subterms.
std::optional<Value> Evaluate(const Arena& arena, TermId term, const Valuation& valuation);

}  // namespace rondo::expr
