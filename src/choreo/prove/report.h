#pragma once

#include "choreo/prove/prove.h"
#include "diag/diagnostic.h"

/// Says what became of the obligations of a choreography.
namespace rondo::choreo {

/// Checks witnesses by other means: FCL looks whether shapes touch, and formulas are evaluated in doubles.
/// What they do not confirm is a bug and added to `proofs.problems`.
void ConfirmWitnesses(const Obligations& obligations, expr::Arena& arena, Proofs& proofs);

/// Reports what is missing, and each obligation that does not hold or was not decided: what may happen, when,
/// where and in which state, and what would mend it.
void ReportProofs(const Graph& graph, const Obligations& obligations, const Proofs& proofs,
                  diag::Diagnostics& diagnostics);

/// Returns what a proof rests on, in sentences: contracts of motions, ranges, what controllers have to
/// bridge.
/// @param proved  motions (`Type.Motion`) whose contracts are proved.
std::vector<std::string> AssumptionsOf(const Graph& graph, const std::set<std::string>& proved,
                                       const Obligations& obligations, const Proofs& proofs);

/// Returns the state of a witness, "arm.a = 130 deg" for each variable, in the order of the world.
std::vector<std::string> StateOf(const Graph& graph, const Witness& witness);

/// Returns where the point of a witness is, in the world frame: "(1 m, 0.5 m, 0 m)"; empty if it has none.
std::string PlaceOf(const Graph& graph, const Witness& witness);

}  // namespace rondo::choreo
