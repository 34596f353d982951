#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deploy/judge_logs.h"
#include "deploy/stage.h"
#include "deploy/status.h"
#include "runs/children.h"
#include "runs/robot_files.h"

/// Runs a whole fleet on this machine: a process for each robot, and bodies that they reach over ROS 2 alone.
namespace rondo::runs {

/// Says how a fleet is run.
struct LaunchOptions {
  std::string executable;  ///< the program that runs one robot: `EXECUTABLE run FILE --robot NAME ...`
  std::string logs;        ///< the folder of the logs
  std::map<std::string, std::string> cores =
      {};               ///< by robot: what runs its events (`rondo run --core`); of all others: ""
  double speed = 1;     ///< seconds of the world in one; not 1 only if the fleet has `use_sim_time`
  double duration = 0;  ///< seconds of the world from when the first round begins; 0: as the fleet says
  trace::Writer* trace = nullptr;  ///< of the bodies
  base::StopToken stop;
  /// Receives, now and then, what the robots say of themselves, and how many seconds the run is old.
  std::function<void(const std::vector<deploy::RobotStatus>& robots, double time)> progress;
};

/// Tells what became of the fleet.
struct LaunchReport {
  bool interrupted = false;
  double time = 0;  ///< seconds of the world, since the first round began
  std::vector<RobotEnd> robots;
  deploy::StageReport stage;
  std::optional<deploy::LogsReport> logs;  ///< nothing: they cannot be judged
  std::string problem;                     ///< why
};

/// Runs a fleet, and judges its logs. Reports violations.
/// @error if a process, a file or the network cannot be used; then no process is left.
base::Result<LaunchReport> Launch(const RobotProgram& program, const LaunchOptions& options,
                                  workspace::Session& session);

}  // namespace rondo::runs
