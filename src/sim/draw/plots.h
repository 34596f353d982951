#pragma once

#include <string>

#include "sim/draw/history.h"
#include "sim/world/world.h"

/// Draws pictures of a run, as SVG.
namespace rondo::sim {

/// Draws the run from above: obstacles, the paths of the robots, where they began and ended, where they
/// touched.
std::string DrawPaths(const History& history, const World& world);
/// Draws the least distance of two robots, and of each robot to its nearest obstacle, over time.
std::string DrawDistances(const History& history, const World& world);
/// Draws the last map of the robots, with the obstacles as they are.
std::string DrawMap(const History& history, const World& world);

}  // namespace rondo::sim
