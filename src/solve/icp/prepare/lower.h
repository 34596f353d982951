#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "expr/arena.h"
#include "solve/solver.h"

/// Queries as formulas over reals alone: the first step of the interval solver.
namespace rondo::solve::icp {

using expr::Rational;
using expr::TermId;

/// Is a variable of the query: a real, or something else told by an integer.
struct Variable {
  enum class Kind : uint8_t { kReal, kInt, kBool, kEnum };
  TermId source;  ///< in the query's arena
  Kind kind = Kind::kReal;
  bool integral() const { return kind != Kind::kReal; }
};

/// Is a query over reals only, in negation normal form: conjunctions, disjunctions and (negated) comparisons.
/// Integers, truth values (false = 0) and members of enumerations have become reals of which `variables` says
/// that they are integral. Stated in an arena of its own.
struct Lowered {
  expr::Arena arena;
  std::vector<TermId> conjuncts;                   ///< all of them must hold
  std::unordered_map<TermId, Variable> variables;  ///< by the term in `arena`
  std::string unsupported;                         ///< why the query cannot be told so; empty if it can
};

/// Lowers the query; `unsupported` says why, if that cannot be done. Cost: linear in the number of distinct
/// subterms.
void Lower(const Query& query, Lowered& lowered);

/// Returns the negation of a formula, in negation normal form if `formula` is.
TermId Negate(expr::Arena& arena, TermId formula);

}  // namespace rondo::solve::icp
