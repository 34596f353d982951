#pragma once

#include <functional>
#include <unordered_map>

#include "expr/arena.h"

namespace rondo::expr {

using Substitution = std::unordered_map<TermId, TermId>;

/// `term` with each occurrence of a key of `map` replaced by its value, at once, rebuilt through the
/// simplifying constructors. Capture cannot happen as long as values are closed or bind no variable of a
/// quantifier inside `term`: every quantifier has variables of its own. Cost: linear in the number of
/// distinct subterms.
TermId Substitute(Arena& arena, TermId term, const Substitution& map);

/// Rebuilds `term` bottom up; `change` sees each rebuilt subterm and returns it or a replacement.
TermId Transform(Arena& arena, TermId term, const std::function<TermId(TermId)>& change);

/// Calls `visit` once for each distinct subterm, arguments before the terms that use them.
void VisitPostorder(const Arena& arena, TermId term, std::unordered_set<TermId>& seen,
                    const std::function<void(TermId)>& visit);

}  // namespace rondo::expr
