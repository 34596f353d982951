#pragma once

#include <span>
#include <string>

#include "sim/cores/fault.h"
#include "sim/fleet/tables.h"

/// Faults in files (TOML): docs/runtime.md, "Scenarios".
namespace rondo::sim::cores {

/// Reads one fault; what is wrong is reported.
/// @param robots  how many there are.
/// @param names  of the robots, if there are any: a file may say `robot = "car1"` then.
Fault ReadFault(Tables& tables, const toml::table& table, size_t robots, std::span<const std::string> names);

/// Returns the lines of a table that reads back as the same fault.
std::string WriteFault(const Fault& fault);

}  // namespace rondo::sim::cores
