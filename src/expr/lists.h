#pragma once

#include <span>
#include <vector>

#include "expr/arena.h"

/// The meaning of list operators, for solvers that have no theory of lists.
namespace rondo::expr {

/// Returns what the solvers, which take list operators as uninterpreted, must be told about the closed list
/// terms that occur in `formulas`: lengths are not negative; a literal has its length and items; `Append`
/// adds one item at the end; `Remove` drops the first occurrence and is the identity if there is none; `Set`
/// replaces one item, `Insert` adds and `Drop` takes away one at a place, `Slice` keeps those between two places; lists that are compared are equal if their items are.
///
/// Every axiom is true of finite sequences, so adding them is sound; lists that are never compared may differ
/// in a model although their items are equal. Terms in `done` have been served already; new ones are added to
/// it.
std::vector<TermId> ListAxioms(Arena& arena, std::span<const TermId> formulas,
                               std::unordered_set<TermId>& done);

}  // namespace rondo::expr
