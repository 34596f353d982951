#pragma once

#include <string>

#include "sim/draw/stage_history.h"

namespace rondo::sim {

/// Draws a run of a choreography as SVG: a lane for each robot, time downwards (not to scale: every message has a row of its
/// own); motions are bars, messages arrows, what went wrong is red. Of long runs the first 400 messages.
std::string DrawTimeline(const StageHistory& history);

}  // namespace rondo::sim
