#pragma once

#include <memory>
#include <optional>
#include <string>

#include "deploy/robot.h"
#include "runs/fleet_files.h"
#include "runs/simulation_files.h"
#include "workspace/koord_files.h"

namespace rondo::runs {

/// Holds a program and a fleet that robots can run, and the texts that they come from.
struct RobotProgram {
  SimulationFiles files;
  std::unique_ptr<workspace::LoadedKoord> loaded;
  std::unique_ptr<FleetFiles> surroundings;  ///< the fleet's bodies come from there
  sim::Fleet fleet;
  deploy::RobotOptions
      texts;  ///< with the texts, the seed, and the network as the fleet and the variables of ROS say
};

/// Loads the program, the specification and the fleet of these files. Returns nothing after a report.
std::optional<RobotProgram> LoadRobotProgram(const SimulationFiles& files, std::optional<uint64_t> seed,
                                             workspace::Session& session);

/// Does the same for what a log keeps.
std::optional<RobotProgram> LoadRobotProgram(const nlohmann::json& run, workspace::Session& session);

}  // namespace rondo::runs
