#pragma once

#include <set>
#include <string>

#include "choreo/prove/prove.h"

/// Tells what runs break from what only the facts at a node allow.
namespace rondo::choreo {

/// Looks, for each obligation about a step that is refuted, for a way from the start on which it is refuted too: the
/// proof gets its turns, and the state there. If there is none, the verdict becomes kNotInductive: what is known where
/// ways meet is too little, and perhaps no run comes there. Changes the arena. Cost: the deciding of the obligation
/// once for each of some ways, within `options.limits.time` for each obligation.
///
/// @param proved  as for `ObligationsOf`.
void FindRuns(const Obligations& obligations, const Graph& graph, expr::Arena& arena,
              const std::set<std::string>& proved, const ProveOptions& options, Proofs& proofs);

}  // namespace rondo::choreo
