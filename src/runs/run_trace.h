#pragma once

#include <string>

#include "base/result.h"
#include "runs/run_file.h"
#include "workspace/session.h"

/// Turns runs of explorations into traces, to look at.
namespace rondo::runs {

/// Writes a run as a trace (MCAP), one second for each step: `/rondo/run` with the texts of the program,
/// `/rondo/step` with what happened and the state, and the positions of the robots if the program has a port
/// for them.
/// @error if the file cannot be written.
base::Result<bool> WriteRunTrace(const std::string& path, const RunFile& run,
                                 const workspace::Session& session);

}  // namespace rondo::runs
