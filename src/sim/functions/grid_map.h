#pragma once

#include <cstdint>
#include <vector>

#include "sim/world/world.h"

/// Draws and reads maps of square cells.
namespace rondo::sim {

/// Represents a map of square cells, as the mapping programs use it (22 x 22 cells of 1 m in the original
/// application). The columns go along x, the rows along y of the world frame.
struct GridMap {
  enum Cell : int8_t { kUnknown = -1, kEmpty = 0, kOccupied = 1 };
  double cell = 1;
  int columns = 0;
  int rows = 0;
  double x0 = 0;  ///< the corner of the first cell with the least coordinates, metres
  double y0 = 0;
  std::vector<int8_t> cells;  ///< row by row

  /// Returns the column, and the row, of a coordinate in metres; it may lie outside of the map.
  int Column(double x) const;
  int Row(double y) const;
  bool Inside(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
  int8_t& At(int column, int row) {
    return cells[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
  }
  int8_t At(int column, int row) const {
    return cells[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)];
  }
  /// Returns the middle of a cell, at height 0.
  Point Centre(int column, int row) const;
};

/// Returns a map that covers the bounds of the world, at most 2000 cells wide and high; nothing is known, but
/// that the cells on its edge are occupied. `cell`: the side of a cell in metres.
GridMap EmptyMap(const World& world, double cell);

/// Returns, cell by cell, the larger of both: occupied before empty before unknown. Both maps must be laid
/// out alike; an empty first one stands for nothing known.
GridMap Merge(const GridMap& a, const GridMap& b);

/// Holds distances, in metres, that a scanner sees in the directions `first + i * step` (radians, world
/// frame); infinite: free up to `range`.
/// `distances`: in metres; infinite: nothing in range; negative: nothing is known of that direction.
struct Rays {
  double first = 0;
  double step = 0;
  double range = 0;
  std::vector<double> distances;
};
/// Draws what rays from a point see into the map. Unknown cells that lie within `range` before what the rays
/// see in their direction become empty; the cells in which rays of at most `range` end become occupied.
void Draw(GridMap& map, const Point& from, const Rays& rays, double range);

/// Finds the cell to go to next, the nearest one, counted in steps from cell to cell, that is empty,
/// reachable through empty cells, and has an unknown neighbour. Puts its centre into `target`; returns false
/// if there is none.
bool Frontier(const GridMap& map, const Point& from, Point& target);

/// Reports whether a cell contains a part of an obstacle, at whatever height, or lies on the edge of the map.
bool TrulyOccupied(const GridMap& map, const World& world, int column, int row);

}  // namespace rondo::sim
