#pragma once

#include <string>

namespace rondo::deploy {

/// Returns a name for the log of a robot that no log of an earlier life has, complete or not: `bot0.mcap`, `bot0.2.mcap`, ...
std::string UnusedLogName(const std::string& wanted);

}  // namespace rondo::deploy
