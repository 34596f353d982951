#pragma once

#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "sim/campaign/scenario.h"

/// Scenarios as files (TOML): docs/runtime.md, "Scenarios".
namespace rondo::sim::campaign {

/// Reads scenarios. What is wrong is reported; a file with errors gives those that could be read.
std::vector<Scenario> ReadScenarios(const diag::SourceSet& sources, diag::FileId file,
                                    diag::Diagnostics& diagnostics);

/// Returns the text of a file that holds this scenario, `comment` in front: it reads back as the same.
std::string WriteScenario(const Scenario& scenario, const std::string& comment);

}  // namespace rondo::sim::campaign
