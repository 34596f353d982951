#pragma once

#include <random>

#include "choreo/graph/graph.h"
#include "sim/motions/scene_state.h"

namespace rondo::sim::motions {

/// Puts everything where a choreography may begin, at random: what `initially` does not mention is anywhere in its range. False
/// if no such state was found.
bool Place(const choreo::Graph& graph, expr::Arena& arena, SceneState& scene, std::mt19937_64& random);

/// Returns the robots in an order in which whoever carries others comes before them.
std::vector<size_t> CarriersFirst(const robot::World& world);

}  // namespace rondo::sim::motions
