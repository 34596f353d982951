#pragma once

#include <string>

#include "base/result.h"
#include "sim/draw/stage_history.h"
#include "workspace/session.h"

namespace rondo::runs {

/// Draws where everything is at a moment of a recorded run, in seconds since it began (SVG; metres): the last states that the
/// trace shows until then, with the shapes of the models that it keeps.
/// @error if these cannot be used.
base::Result<std::string> DrawRunScene(const sim::StageHistory& history, double time,
                                       workspace::Session& session);

}  // namespace rondo::runs
