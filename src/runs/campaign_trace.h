#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/result.h"
#include "runs/fleet_files.h"
#include "runs/replay.h"
#include "sim/campaign/campaign.h"

/// Keeps runs of campaigns as traces, and makes them again.
namespace rondo::runs {

/// Holds the texts that a run is made from.
struct CampaignTexts {
  std::string program_name, program, spec, fleet;
  FileContents files = {};  ///< what the fleet refers to
};

/// Writes what the robots of a run logged as MCAP: `/rondo/run` has the texts, the scenario and what is wrong;
/// `/rondo/log` each line of the logs, in order, with the state of the team where there is one.
/// @param team  compiled for as many robots as the run has.
/// @error if it cannot be written.
base::Result<bool> WriteCampaignTrace(const std::string& path, const CampaignTexts& texts,
                                      const sim::campaign::Trial& trial, koord::semantics::Team& team);

/// Runs the scenario of such a trace again, and compares bit for bit.
/// @param bytes  of the trace; `record`: what `/rondo/run` says.
Replayed ReplayCampaign(const std::string& bytes, const nlohmann::json& record, workspace::Session& session);

}  // namespace rondo::runs
