#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "solve/solver.h"

/// Quantifiers by instances, for solvers that are better without them.
namespace rondo::solve {

/// Says by which terms universal variables are replaced.
enum class InstantiationMode : uint8_t {
  /// Several variables that are not integers take only values that stand together in some application: few
  /// instances.
  kTriggers,
  /// Every variable takes every term that stands where it stands: all combinations.
  kPlaces,
};

/// Bounds the number of instances; what is beyond is left out, and the result not `complete`.
struct InstantiationLimits {
  InstantiationMode mode = InstantiationMode::kTriggers;
  int rounds = 3;                ///< how often instances may give rise to further instances
  size_t per_quantifier = 4000;  ///< instances of one quantifier
  size_t total = 8000;           ///< instances of all quantifiers together
};

/// Holds quantifier-free assertions that follow from `assertions` (so that unsatisfiability carries over):
/// - existential variables become constants;
/// - universal variables are replaced by the closed terms that stand where the variable stands: a
///   variable that is an argument of f, or an index of an array, takes every closed term that occurs at
///   the same place of f or of that array; a number that is compared with a closed term by equality
///   takes that term. For formulas in which variables occur only in such places this loses nothing (Ge &
///   de Moura, Complete instantiation for quantified formulas, CAV 2009), up to `limits`;
/// - a variable in no such place takes the `fallback` terms of its sort;
/// - quantifiers under equality or if-then-else are named by a Boolean constant.
/// `complete` is false when something was left out, so that satisfiability need not carry over.
struct Ground {
  std::vector<Assertion> assertions;
  bool complete = true;
};
/// Holds, by existential quantifier, its body for the constants that stand for its variables.
using Witnesses = std::unordered_map<expr::TermId, expr::TermId>;

/// Instantiates the assertions. `fallback`: by sort, terms for variables that stand nowhere else.
///
/// @param witnesses  constants of earlier calls, which are used again; new ones are added. Whoever states
/// more about a question can then speak of the constants of the first attempt.
Ground Instantiate(expr::Arena& arena, const std::vector<Assertion>& assertions,
                   const std::map<expr::SortId, std::vector<expr::TermId>>& fallback,
                   const InstantiationLimits& limits, Witnesses& witnesses);
/// Does the same with constants of its own.
Ground Instantiate(expr::Arena& arena, const std::vector<Assertion>& assertions,
                   const std::map<expr::SortId, std::vector<expr::TermId>>& fallback,
                   const InstantiationLimits& limits = {});

}  // namespace rondo::solve
