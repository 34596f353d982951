#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "lsp/positions.h"

/// What the parts of the server share about messages and paths.
namespace rondo::lsp {

/// Returns a path without `.` and `..`, as documents are found by.
std::string Plain(const std::string& path);
/// Reports whether the server knows files of this name.
bool IsSource(const std::string& path);

nlohmann::json ToJson(Position position);
/// Read places of the protocol. Throw what the JSON library throws, where there are none.
Position PositionIn(const nlohmann::json& j);
std::pair<Position, Position> RangeIn(const nlohmann::json& j);
/// Reports whether ranges have a place in common. Those that only touch do: cursors stand between characters.
bool Meet(const nlohmann::json& a, const nlohmann::json& b);

}  // namespace rondo::lsp
