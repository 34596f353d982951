#pragma once

#include <string>
#include <vector>

#include "base/stop.h"
#include "deploy/robot_log.h"
#include "history/judge.h"
#include "sim/simulation.h"

namespace rondo::deploy {

/// Tells what logs of a fleet say together.
struct LogsReport {
  std::vector<history::Finding> findings;  ///< what the protocol did and must not
  std::vector<sim::Violation> violations;  ///< of the specification, in states that were final
  std::vector<std::string> unchecked;      ///< what could not be judged, and why
  uint64_t rounds = 0;                     ///< the latest that was final
  size_t explained = 0;                    ///< rounds that follow from the one before by the program
  uint64_t fallbacks = 0;
  size_t lines = 0;
  std::vector<double> waits =
      {};             ///< seconds from what a robot said to the end of its round, in increasing order
  double length = 0;  ///< seconds from the first line to the last
  std::vector<std::pair<double, std::string>>
      story;  ///< when something happened to the team, in seconds, and what
};

/// Judges logs: by `history` whether each state follows from the one before and nobody acted too early or too late, and by the
/// specification each state that was final. Reports violations.
/// @error if the logs are not of one run, or make no sense.
base::Result<LogsReport> JudgeLogs(const std::vector<RobotLog>& logs, const koord::Model& model,
                                   const sim::Fleet& fleet, const base::StopToken& stop,
                                   diag::Diagnostics& diagnostics);

}  // namespace rondo::deploy
