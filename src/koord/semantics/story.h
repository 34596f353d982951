#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "koord/semantics/system.h"

/// Runs as people read them, and as files keep them.
namespace rondo::koord::semantics {

/// A table: round by round, what each robot did and what changed.
std::string Tell(const Team& team, const std::vector<Step>& run);

/// All variables by name; those of robots as lists.
nlohmann::json StateToJson(const Team& team, std::span<const Word> state);

/// The steps, each with the whole state at its end.
nlohmann::json RunToJson(const Team& team, const std::vector<Step>& run);

/// Runs the program along the steps of such a file. Empty if every step is one of the program's, every state
/// is the same, and the run breaks the property (`invariant NAME`, `well-defined`, `summary NAME`,
/// `deadlock`); else what differs first, with the number of the step.
std::string Replay(Team& team, const nlohmann::json& run, const std::string& property);

}  // namespace rondo::koord::semantics
