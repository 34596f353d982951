#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/result.h"

/// Reads maps of occupancy, as navigation stacks of ROS 2 save them.
namespace rondo::sim {

/// Represents a rectangle of the floor; metres, world frame.
struct Rectangle {
  double low[2] = {0, 0};
  double high[2] = {0, 0};
};

/// Holds where robots cannot be: the cells of a map that are occupied or unknown, as rectangles that do not
/// overlap.
struct OccupancyMap {
  std::vector<Rectangle> walls;
  double low[2] = {0, 0};  ///< the corner of the map with the least coordinates, metres
  double high[2] = {0, 0};
};

/// Reads a map description (YAML with `image`, `resolution`, `origin`, `negate`, `occupied_thresh`,
/// `free_thresh`, `mode`) and its image (PGM or PNG). Cells mean what nav2_map_server says: a cell is free if
/// and only if its occupancy is below `free_thresh`.
/// @param read  returns the bytes of a file; the image's path is relative to that of the description.
///
/// @error says what is wrong with the description or the image.
/// @source nav2_map_server, map_io.cpp (`trinary`, `scale`, `raw`).
base::Result<OccupancyMap> ReadOccupancyMap(
    const std::string& path, const std::function<base::Result<std::string>(const std::string&)>& read);

}  // namespace rondo::sim
