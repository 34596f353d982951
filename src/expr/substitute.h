#pragma once

#include <functional>
#include <unordered_map>

#include "expr/arena.h"

/// Terms rebuilt, and terms looked through.
namespace rondo::expr {

/// Says by what each of some terms is replaced.
using Substitution = std::unordered_map<TermId, TermId>;

/// Returns `term` with each occurrence of a key of `map` replaced by its value, all at once, rebuilt through
/// the simplifying constructors: what a replacement brings in is not replaced again. Capture cannot happen as
/// long as values are closed or bind no variable of a quantifier inside `term`: every quantifier has
/// variables of its own. Cost: linear in the number of distinct subterms.
TermId Substitute(Arena& arena, TermId term, const Substitution& map);

/// Rebuilds `term` bottom up; `change` sees each rebuilt subterm and returns it or a replacement.
TermId Transform(Arena& arena, TermId term, const std::function<TermId(TermId)>& change);

/// Calls `visit` once for each distinct subterm, arguments before the terms that use them.
void VisitPostorder(const Arena& arena, TermId term, std::unordered_set<TermId>& seen,
                    const std::function<void(TermId)>& visit);

}  // namespace rondo::expr
