#pragma once

#include <functional>
#include <string>

#include "base/stop.h"
#include "workspace/session.h"

/// Makes recorded runs again.
namespace rondo::runs {

/// Tells whether a recorded run was made again.
struct Replayed {
  bool same = false;
  std::string text;  ///< says that it was, or where it differs first
  bool interrupted = false;
};

/// Says who is told how far a replay is, and how it is stopped.
struct ReplayOptions {
  std::function<void(double time, double end)> progress;  ///< of simulations; seconds
  base::StopToken stop;
};

/// Runs again what a file records, and compares: a trace of a simulation bit for bit, from the texts and the
/// seed that it keeps; a run that breaks a property step by step; a trajectory that breaks a contract by
/// integrating it.
///
/// @param bytes  the contents of the file
Replayed Replay(const std::string& bytes, workspace::Session& session, const ReplayOptions& options);

}  // namespace rondo::runs
