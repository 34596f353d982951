#pragma once

#include <functional>
#include <limits>
#include <string>

#include "base/stop.h"
#include "choreo/node/cast.h"
#include "sim/motions/report.h"
#include "sim/motions/stage_recorder.h"

namespace rondo::sim::motions {

/// Says how a choreography is simulated. The same options give the same run.
struct ChoreographyOptions {
  uint64_t seed = 1;
  double duration = 60;  ///< virtual seconds, at most
  base::StopToken stop;
  std::function<void(double time, double end)> progress;
  double interrupt_at =
      std::numeric_limits<double>::infinity();  ///< virtual seconds: as a run that was interrupted then
};

/// Runs a choreography in virtual time: the session core of each robot, unchanged, on messages that arrive at once, and
/// bodies that move as their motions' contracts allow (`MotionRun`). Looks at contacts, contracts and assumptions at least
/// every hundredth of a second. Where it begins, which way motions take, how long they last, what inputs are and which of
/// several alternatives is taken: all of it is drawn from the seed.
///
/// @param recorder  what happens is written to it; nullptr: to nothing
ChoreographyReport RunChoreography(const choreo::Cast& cast, const ChoreographyOptions& options,
                                   StageRecorder* recorder);

}  // namespace rondo::sim::motions
