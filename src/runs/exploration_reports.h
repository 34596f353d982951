#pragma once

#include <vector>

#include "diag/diagnostic.h"
#include "explore/search.h"
#include "koord/semantics/system.h"
#include "koord/semantics/team.h"
#include "runs/exploration.h"

/// Tells people what an exploration found.
namespace rondo::runs {

/// Report that somebody waits longer than response `number` allows, or what else is broken at the end of a path,
/// with the run that leads there, which is kept in `explored`.
void ReportLate(koord::semantics::Team& team, koord::semantics::System& system,
                const std::vector<explore::KeptState>& path, size_t number, Explored& explored,
                diag::Diagnostics& diagnostics);
void ReportBroken(koord::semantics::Team& team, koord::semantics::System& system,
                  const std::vector<explore::KeptState>& path, const explore::Broken& broken,
                  Explored& explored, diag::Diagnostics& diagnostics);
/// Reports the run to a state in which nothing can change any more.
void ReportDeadlock(koord::semantics::Team& team, koord::semantics::System& system, Explored& explored,
                    diag::Diagnostics& diagnostics);
/// Reports that no declared state is one in which a run may begin.
void ReportNoInitialState(const koord::semantics::Team& team, Explored& explored,
                          diag::Diagnostics& diagnostics);
/// Reports parts of the specification that runs are not checked against.
void ReportUnchecked(const koord::semantics::Team& team, Explored& explored, diag::Diagnostics& diagnostics);
/// Reports invariants and responses that have no value somewhere, and sensors that have none.
void ReportGaps(const koord::semantics::Team& team, const koord::semantics::System& system,
                const std::vector<bool>& undefined_responses, Explored& explored,
                diag::Diagnostics& diagnostics);

}  // namespace rondo::runs
