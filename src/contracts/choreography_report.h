#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "contracts/choreography.h"

/// Presents what was proved of a choreography, as text and as data.
namespace rondo::contracts {

/// Returns a table with one line for each kind of obligation: how many hold, fail, are open, and how long
/// that took.
std::string ChoreographyTable(const ChoreographyProof& report);

/// Returns the verdict and what it rests on.
std::string ChoreographySummary(const ChoreographyProof& report, const diag::SourceSet& sources);

/// Returns a line `FILE:LINE: thread region REGION  # of `cart`` for each region that was found.
std::string RegionLines(const choreo::Inference& regions, const diag::SourceSet& sources);

/// Returns the report as JSON: {choreography, verdict, obligations: [{id, kind, title, place, verdict, ...}],
/// missing, regions, rests_on}.
nlohmann::json ToJson(const ChoreographyProof& report, const diag::SourceSet& sources);

}  // namespace rondo::contracts
