#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "choreo/node/cast.h"
#include "runs/replay.h"
#include "sim/motions/choreography_run.h"
#include "workspace/module_files.h"
#include "workspace/session.h"

/// Simulates choreographies that stand in files.
namespace rondo::runs {

/// Says what is to be simulated.
struct ChoreographyFiles {
  std::vector<std::string> files;
  std::vector<std::string> admitted;  ///< options for every choreography
  std::string choreography;           ///< its name; empty: the only one there is
  bool projections = false;           ///< everybody follows its projection, even where there is a process
};

/// Holds a choreography that is ready to be run, again and again. One run at a time.
struct StagedChoreography {
  std::unique_ptr<workspace::LoadedModule> module;
  choreo::Cast cast;
};

/// Loads and checks a choreography. Nothing if something is wrong, which is in the session.
std::optional<StagedChoreography> StageChoreography(const ChoreographyFiles& files,
                                                    workspace::Session& session);

/// Returns what a trace keeps of a run, so that it can be made again: `/rondo/run`.
nlohmann::json RecordOf(const ChoreographyFiles& files, const StagedChoreography& staged,
                        const sim::motions::ChoreographyOptions& options, const workspace::Session& session);

/// Runs a choreography and writes its trace. @error if it cannot be simulated, or the trace not written.
base::Result<sim::motions::ChoreographyReport> RecordChoreography(
    const StagedChoreography& staged, const sim::motions::ChoreographyOptions& options,
    const nlohmann::json& record, const std::string& path);

/// Loads and checks the choreography of which a trace keeps the record. Nothing if it cannot be used; then the session knows
/// why, or the record is damaged.
std::optional<StagedChoreography> StageRecorded(const nlohmann::json& record, workspace::Session& session);

/// Makes the run of a trace again, from what it keeps, and compares bit for bit.
Replayed ReplayChoreography(const std::string& bytes, const nlohmann::json& record,
                            workspace::Session& session, const ReplayOptions& options);

}  // namespace rondo::runs
