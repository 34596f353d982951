#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "koord/semantics/system.h"

/// Turns runs into text for people and into JSON for files, and runs such files again.
namespace rondo::koord::semantics {

/// Returns a table that says, round by round, what each robot did and what changed.
std::string Tell(const Team& team, const std::vector<Step>& run);

/// Returns the values of all variables by name; those that each robot has are lists by robot.
nlohmann::json StateToJson(const Team& team, std::span<const Word> state);

/// Returns the steps of a run, each with the whole state at its end; `Replay` reads it.
nlohmann::json RunToJson(const Team& team, const std::vector<Step>& run);

/// Runs the program along the steps of such a file. Returns an empty text if every step is one of the
/// program's, every state is the same, and the run breaks the property (`invariant NAME`, `well-defined`,
/// `summary NAME`, `deadlock`); else says what differs first, with the number of the step.
std::string Replay(Team& team, const nlohmann::json& run, const std::string& property);

}  // namespace rondo::koord::semantics
