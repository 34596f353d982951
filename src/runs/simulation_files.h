#pragma once

#include <string>

#include "runs/fleet_files.h"
#include "sim/simulation.h"
#include "workspace/session.h"

/// Finds the files of simulations.
namespace rondo::runs {

/// Holds the files of one simulation.
struct SimulationFiles {
  std::string program;
  std::string spec;  ///< empty: beside the program, if there is one
  std::string fleet;
  std::string network = {};  ///< empty: the robots share one store
};

/// Returns the files of a simulation: `NAME`, `NAME.koord`, or `NAME.toml` stand for all three.
SimulationFiles FindSimulationFiles(const std::string& file, const std::string& spec,
                                    const std::string& fleet);

/// Puts the texts of the files that were read into the options, for the trace; also what the fleet refers to.
void KeepTexts(const SimulationFiles& files, const workspace::Session& session, const FileContents& of_fleet,
               sim::SimulationOptions& options);

}  // namespace rondo::runs
