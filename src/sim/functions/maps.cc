#include <cmath>

#include "sim/functions/functions.h"

namespace rondo::sim {

using koord::semantics::FromFloat;
using koord::semantics::ToFloat;

GridMap Functions::MapOf(Word handle) const {
  auto known = DecodeMap(heap(), handle);
  return known ? std::move(*known) : EmptyMap(fleet_.world, fleet_.cell);
}

void Functions::MergeMaps(size_t, Arguments a, std::span<Word> result) {
  if (a[0] == 0 || a[1] == 0) {
    result[0] = a[0] == 0 ? a[1] : a[0];
  } else {
    result[0] = EncodeMap(heap(), Merge(MapOf(a[0]), MapOf(a[1])));
  }
}

void Functions::ScanToMap(size_t, Arguments a, std::span<Word> result) {
  GridMap drawn = EmptyMap(fleet_.world, fleet_.cell);
  const double range = fleet_.map_range > 0 ? fleet_.map_range : fleet_.lidar.range;
  Draw(drawn, ReadPoint(a.data()), DecodeRays(heap(), a[3]), range);
  result[0] = EncodeMap(heap(), drawn);
}

void Functions::PickFrontier(size_t, Arguments a, std::span<Word> result) {
  Point target = ReadPoint(a.data() + 1);
  Frontier(MapOf(a[0]), target, target);
  target[2] = ToFloat(a[3]);
  WritePoint(target, result.data());
}

// Cells that are not known to be empty, beside cells that are.
void Functions::FindObstacles(size_t, Arguments a, std::span<Word> result) {
  const GridMap grid = MapOf(a[0]);
  std::vector<Word> cells;
  const auto is_empty = [&](int c, int r) { return grid.Inside(c, r) && grid.At(c, r) == GridMap::kEmpty; };
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c) {
      bool edge = false;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) edge = edge || is_empty(c + dc, r + dr);
      }
      if (!edge || is_empty(c, r)) continue;
      const Point centre = grid.Centre(c, r);
      const Word cell[3] = {FromFloat(centre[0]), FromFloat(centre[1]), FromFloat(grid.cell)};
      cells.push_back(heap().Intern(cell));
    }
  }
  result[0] = heap().Intern(cells);
}

void Functions::Right(size_t, Arguments a, std::span<Word> result) {
  const GridMap grid = MapOf(a[0]);
  bool right = true;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.columns; ++c)
      right = right && (grid.At(c, r) != GridMap::kOccupied || TrulyOccupied(grid, fleet_.world, c, r));
  }
  result[0] = right;
}

// Every ray that ends, ends on an obstacle, within what the scanner may be wrong: rounding, five deviations of its
// noise, and its resolution.
void Functions::TrueScan(size_t, Arguments a, std::span<Word> result) {
  const Point from = ReadPoint(a.data());
  const Rays rays = DecodeRays(heap(), a[3]);
  const double margin = 1e-6 + 5 * fleet_.lidar.noise + fleet_.lidar.resolution;
  bool good = true;
  for (size_t i = 0; i < rays.distances.size(); ++i) {
    if (!std::isfinite(rays.distances[i]) || rays.distances[i] < 0) continue;
    const double angle = rays.first + static_cast<double>(i) * rays.step;
    const Point end{from[0] + rays.distances[i] * std::cos(angle),
                    from[1] + rays.distances[i] * std::sin(angle), from[2]};
    good = good && fleet_.world.DistanceTo(end) <= margin;
  }
  result[0] = good;
}

}  // namespace rondo::sim
