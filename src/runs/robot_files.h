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
      texts;         ///< with the texts, the seed, and the network as the fleet and the variables of ROS say
  std::string keys;  ///< the folder of the keys; empty: there is no security
};

/// Returns the network in which a part of a fleet runs: as the fleet says, and the variables of ROS say, and with the keys
/// of this enclave, if there is security (`keys` in the fleet, or ROS_SECURITY_ENABLE and ROS_SECURITY_KEYSTORE).
/// @error if a variable has a value that it cannot have, there are no keys, or other files were signed.
base::Result<dds::Network> NetworkOf(const RobotProgram& program, const std::string& enclave);

/// Loads the program, the specification and the fleet of these files. Returns nothing after a report.
std::optional<RobotProgram> LoadRobotProgram(const SimulationFiles& files, std::optional<uint64_t> seed,
                                             workspace::Session& session);

/// Does the same for what a log keeps.
std::optional<RobotProgram> LoadRobotProgram(const nlohmann::json& run, workspace::Session& session);

}  // namespace rondo::runs
