#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "deploy/choreography/choreography_robot.h"
#include "deploy/choreography/choreography_stage.h"
#include "deploy/choreography/judge_sessions.h"
#include "runs/children.h"
#include "runs/choreography_runs.h"

/// Runs choreographies as processes that only ROS 2 joins.
namespace rondo::runs {

/// Says how the robots of a choreography are run on this machine.
struct LaunchChoreographyOptions {
  std::string executable;  ///< the program that runs one robot: `EXECUTABLE run FILE --robot NAME ...`
  std::string logs;        ///< the folder of the logs
  std::string trace;       ///< the file of a trace; empty: none
  uint64_t seed =
      1;  ///< of where everything is in the beginning, of the environment, and of what robots choose
  double duration = 0;   ///< seconds from when the session begins; 0: until it is over
  double tolerance = 0;  ///< of the robots (`Precision`); 0: the usual one
  base::StopToken stop;
  /// Receives, now and then, what each robot did last, and how many seconds the run is old.
  std::function<void(const std::map<std::string, deploy::SessionEvent>& robots, double time)> progress;
};

/// Tells what became of them.
struct LaunchChoreographyReport {
  bool interrupted = false, time_over = false;
  double time = 0;  ///< seconds since the session began
  std::vector<RobotEnd> robots;
  std::map<std::string, deploy::SessionEvent> left;  ///< by robot: the outcome of its session
  sim::motions::ChoreographyReport stage;            ///< contacts of bodies
  double behind = 0;  ///< seconds by which the bodies were behind the clock, at most
  deploy::SessionsReport judged;
};

/// Runs a process for each robot, and bodies that they reach over topics of ROS 2 alone; then judges their logs.
/// @error if a process, a file or the network cannot be used; then no process is left.
base::Result<LaunchChoreographyReport> LaunchChoreography(const ChoreographyFiles& files,
                                                          const StagedChoreography& staged,
                                                          const LaunchChoreographyOptions& options,
                                                          const workspace::Session& session);

/// Returns the network of choreographies, as the variables of ROS 2 say; without any, all that can be reached.
/// @error if a variable has a value that it cannot have.
base::Result<dds::Network> ChoreographyNetwork();

/// Returns what logs and agreements keep of a choreography.
nlohmann::json LogRecordOf(const ChoreographyFiles& files, const StagedChoreography& staged,
                           const workspace::Session& session);

}  // namespace rondo::runs
