#pragma once

#include "diag/diagnostic.h"
#include "koord/semantics/team.h"
#include "sim/fleet/fleet.h"

/// Parameters of programs as fleet files give them.
namespace rondo::sim {

/// Puts the values that a fleet gives parameters into the options of a team, and their lists and texts into its
/// heap. What the program does not have, or what is no value of its type, is reported.
void ReadParameters(const koord::Model& model, const Fleet& fleet, koord::semantics::TeamOptions& options,
                    koord::semantics::Heap& heap, diag::Diagnostics& diagnostics);

}  // namespace rondo::sim
