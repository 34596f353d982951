#pragma once

#include <string>

#include "contracts/choreography.h"

/// Draws what a proof of a choreography found.
namespace rondo::contracts {

/// Draws the scene of the first obligation about shapes that is not proved and has a state to show: where
/// they touch or come too close; else the world as it begins (SVG; metres).
std::string SceneOf(const ChoreographyProof& report, expr::Arena& arena);

}  // namespace rondo::contracts
