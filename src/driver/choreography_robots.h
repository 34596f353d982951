#pragma once

#include <string>
#include <vector>

#include "runs/launch_choreography.h"
#include "verdict/verdict.h"

/// Carries out `rondo run`, `rondo launch` and `rondo replay` for robots of choreographies.
namespace rondo::driver {

/// Is how late motions may be until that is told, in seconds: bodies always lag a little.
inline constexpr double kTellLate = 0.05;

/// Says how a robot of a choreography is run.
struct RunChoreographyOptions {
  runs::ChoreographyFiles files;
  std::string robot;
  deploy::PlayerOptions run;  ///< but what comes from the files
  bool json = false;
};

/// Runs one robot of a choreography, and says what became of it.
verdict::ExitStatus RunChoreography(const RunChoreographyOptions& options);

/// Says how all robots of a choreography are run on this machine.
struct LaunchedChoreographyOptions {
  runs::ChoreographyFiles files;
  runs::LaunchChoreographyOptions launch;
  bool json = false;
};

/// Runs all robots of a choreography as processes, and says what became of them.
verdict::ExitStatus LaunchChoreography(LaunchedChoreographyOptions options);

/// Judges logs of the robots of a choreography.
verdict::ExitStatus JudgeChoreography(const std::vector<deploy::SessionLog>& logs, const std::string& file,
                                      bool json);

}  // namespace rondo::driver
