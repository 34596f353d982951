#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

/// Sets of states as cells of a grid: what engine and checker write of controllers that act at instants.
namespace rondo::reach {

/// Encloses the states at every instant at which a controller acts, just before it does: some cells of a grid.
/// States that the grid does not divide are constants, or are set by the controller whatever they were.
struct Paving {
  std::vector<size_t> states;                ///< that the grid divides, by their index in the problem
  std::vector<std::vector<double>> edges;    ///< by such a state, ascending: where its cells begin and end
  std::vector<std::vector<uint32_t>> cells;  ///< by such a state: after which edge the cell begins
};

}  // namespace rondo::reach
