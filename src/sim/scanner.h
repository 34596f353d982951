#pragma once

#include <memory>
#include <random>
#include <vector>

#include "sim/fleet/fleet.h"
#include "sim/functions/grid_map.h"

namespace rondo::sim {

/// Returns what the scanner of a robot sees in one turn: obstacles, other robots if the fleet says so, with its noise and its
/// steps.
Rays Scan(const Fleet& fleet, const std::vector<std::unique_ptr<Body>>& bodies, size_t robot,
          std::mt19937_64& noise);

}  // namespace rondo::sim
