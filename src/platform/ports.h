#pragma once

#include <vector>

#include "platform/topics.h"

namespace rondo::platform {

/// Returns the ports of the program. Reports those that a robot lacks, that the fleet connects with what they are not, or
/// that the program does not have.
std::vector<sim::Port> PortsOf(const koord::Model& model, const sim::Fleet& fleet,
                               diag::Diagnostics& diagnostics);

}  // namespace rondo::platform
