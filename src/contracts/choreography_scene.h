#pragma once

#include <string>

#include "contracts/choreography.h"

namespace rondo::contracts {

/// Draws the scene of the first shapes that fail to keep apart, or else the world as it begins (SVG; metres).
std::string SceneOf(const ChoreographyProof& report, expr::Arena& arena);

}  // namespace rondo::contracts
