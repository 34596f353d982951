#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/world.h"

namespace rondo::sim {

/// A map of square cells, as the mapping programs use it (22 x 22 cells of 1 m in the original application).
struct GridMap {
  enum Cell : int8_t { kUnknown = -1, kEmpty = 0, kOccupied = 1 };
  double cell = 1;
  int columns = 0;
  int rows = 0;
  double x0 = 0;  ///< the lower corner of the first cell
  double y0 = 0;
  std::vector<int8_t> cells;  ///< row by row

  int Column(double x) const;
  int Row(double y) const;
  bool Inside(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
  int8_t& At(int column, int row) {
    return cells[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
  }
  int8_t At(int column, int row) const {
    return cells[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
  }
  Point Centre(int column, int row) const;
};

/// Covers the bounds of the world; nothing is known, but that the cells on its edge are occupied.
GridMap EmptyMap(const World& world, double cell);

/// Cell by cell the larger of both: occupied before empty before unknown.
GridMap Merge(const GridMap& a, const GridMap& b);

/// Distances in the directions `first + i * step` (world frame), seen from a point; infinite: free up to
/// `range`.
struct Rays {
  double first = 0;
  double step = 0;
  double range = 0;
  std::vector<double> distances;
};
/// Cells whose four corners are nearer than what the rays see in their direction are empty; the cells in
/// which rays end are occupied. Rays count up to `range`.
void Draw(GridMap& map, const Point& from, const Rays& rays, double range);

/// The cell to go to next: empty, reachable through empty cells, with an unknown neighbour, the nearest
/// first. False if there is none.
bool Frontier(const GridMap& map, const Point& from, Point& target);

/// Does a cell contain a part of an obstacle, or lie on the edge?
bool TrulyOccupied(const GridMap& map, const World& world, int column, int row);

}  // namespace rondo::sim
