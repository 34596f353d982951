#include "sim/functions/grid_map.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

namespace rondo::sim {

int GridMap::Column(double x) const { return static_cast<int>(std::floor((x - x0) / cell)); }
int GridMap::Row(double y) const { return static_cast<int>(std::floor((y - y0) / cell)); }
Point GridMap::Centre(int column, int row) const {
  return {x0 + (column + 0.5) * cell, y0 + (row + 0.5) * cell, 0};
}

GridMap EmptyMap(const World& world, double cell) {
  GridMap map;
  map.cell = cell;
  map.x0 = world.low[0];
  map.y0 = world.low[1];
  map.columns =
      std::clamp(static_cast<int>(std::ceil((world.high[0] - world.low[0]) / cell - 1e-9)), 1, 2000);
  map.rows = std::clamp(static_cast<int>(std::ceil((world.high[1] - world.low[1]) / cell - 1e-9)), 1, 2000);
  map.cells.assign(static_cast<size_t>(map.columns) * static_cast<size_t>(map.rows), GridMap::kUnknown);
  for (int c = 0; c < map.columns; ++c) map.At(c, 0) = map.At(c, map.rows - 1) = GridMap::kOccupied;
  for (int r = 0; r < map.rows; ++r) map.At(0, r) = map.At(map.columns - 1, r) = GridMap::kOccupied;
  return map;
}

GridMap Merge(const GridMap& a, const GridMap& b) {
  if (a.cells.empty()) return b;
  GridMap result = a;
  for (size_t i = 0; i < std::min(a.cells.size(), b.cells.size()); ++i)
    result.cells[i] = std::max(a.cells[i], b.cells[i]);
  return result;
}

void Draw(GridMap& map, const Point& from, const Rays& rays, double range) {
  if (rays.distances.empty()) return;
  const auto count = static_cast<long>(rays.distances.size());
  const bool full = std::fabs(rays.step * static_cast<double>(count) - 2 * std::numbers::pi) < rays.step / 2;
  // How far is it free in this direction? The nearer one of the two rays around it.
  const auto free = [&](double angle) {
    const double turn = 2 * std::numbers::pi;
    double offset = std::fmod(angle - rays.first, turn);
    if (offset < 0) offset += turn;
    const auto low = static_cast<long>(std::floor(offset / rays.step));
    double best = range;
    for (long k = low; k <= low + 1; ++k) {
      if (!full && (k < 0 || k >= count)) return 0.0;
      best = std::min(best, rays.distances[static_cast<size_t>(((k % count) + count) % count)]);
    }
    return best;
  };
  const int reach = static_cast<int>(std::ceil(range / map.cell)) + 1;
  const int column = map.Column(from[0]);
  const int row = map.Row(from[1]);
  for (int r = std::max(0, row - reach); r <= std::min(map.rows - 1, row + reach); ++r) {
    for (int c = std::max(0, column - reach); c <= std::min(map.columns - 1, column + reach); ++c) {
      if (map.At(c, r) != GridMap::kUnknown) continue;
      bool seen = true;
      for (int corner = 0; corner < 4 && seen; ++corner) {
        const int right = corner % 2;
        const int up = corner / 2;
        const double x = map.x0 + (c + right) * map.cell - from[0];
        const double y = map.y0 + (r + up) * map.cell - from[1];
        seen = std::hypot(x, y) < free(std::atan2(y, x));
      }
      // The rays around the middle, too: a thin obstacle may stand between the corners.
      if (seen) {
        const Point centre = map.Centre(c, r);
        const double x = centre[0] - from[0];
        const double y = centre[1] - from[1];
        const double far = std::hypot(x, y) + map.cell * std::numbers::sqrt2 / 2;
        const double half =
            std::atan2(map.cell * std::numbers::sqrt2 / 2, std::max(std::hypot(x, y), map.cell / 2));
        const double middle = std::atan2(y, x);
        for (double a = middle - half; a <= middle + half && seen; a += rays.step) {
          const double f = free(a);
          // A ray that ends inside this cell says that it is not empty.
          const double ex = from[0] + (f + 1e-3) * std::cos(a);
          const double ey = from[1] + (f + 1e-3) * std::sin(a);
          seen = f >= std::min(far, range) || map.Column(ex) != c || map.Row(ey) != r;
        }
      }
      if (seen) map.At(c, r) = GridMap::kEmpty;
    }
  }
  for (long i = 0; i < count; ++i) {
    const double distance = rays.distances[static_cast<size_t>(i)];
    if (!(distance <= range) || distance < 0) continue;
    // A little behind the surface, so that the end lies in a cell of the obstacle.
    const double angle = rays.first + static_cast<double>(i) * rays.step;
    const int c = map.Column(from[0] + (distance + 0.05) * std::cos(angle));
    const int r = map.Row(from[1] + (distance + 0.05) * std::sin(angle));
    if (map.Inside(c, r)) map.At(c, r) = GridMap::kOccupied;
  }
}

bool Frontier(const GridMap& map, const Point& from, Point& target) {
  const int column = map.Column(from[0]);
  const int row = map.Row(from[1]);
  if (!map.Inside(column, row)) return false;
  std::vector<bool> seen(map.cells.size());
  std::deque<std::pair<int, int>> queue{{column, row}};
  const auto index = [&](int c, int r) {
    return static_cast<size_t>(r) * static_cast<size_t>(map.columns) + static_cast<size_t>(c);
  };
  seen[index(column, row)] = true;
  constexpr int kSteps[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  while (!queue.empty()) {
    const auto [c, r] = queue.front();
    queue.pop_front();
    const bool here = c == column && r == row;
    if (!here && map.At(c, r) != GridMap::kEmpty) continue;
    bool frontier = false;
    for (const auto& step : kSteps) {
      const int nc = c + step[0];
      const int nr = r + step[1];
      if (!map.Inside(nc, nr)) continue;
      frontier = frontier || map.At(nc, nr) == GridMap::kUnknown;
      if (seen[index(nc, nr)]) continue;
      seen[index(nc, nr)] = true;
      queue.emplace_back(nc, nr);
    }
    if (frontier && map.At(c, r) == GridMap::kEmpty) {
      target = map.Centre(c, r);
      return true;
    }
  }
  return false;
}

bool TrulyOccupied(const GridMap& map, const World& world, int column, int row) {
  if (column == 0 || row == 0 || column == map.columns - 1 || row == map.rows - 1) return true;
  const double x = map.x0 + column * map.cell;
  const double y = map.y0 + row * map.cell;
  for (const Box& b : world.boxes) {
    if (b.centre[0] - b.size[0] / 2 <= x + map.cell && x <= b.centre[0] + b.size[0] / 2 &&
        b.centre[1] - b.size[1] / 2 <= y + map.cell && y <= b.centre[1] + b.size[1] / 2)
      return true;
  }
  for (const Cylinder& c : world.cylinders) {
    const double nearest_x = std::clamp(c.centre[0], x, x + map.cell);
    const double nearest_y = std::clamp(c.centre[1], y, y + map.cell);
    if (std::hypot(nearest_x - c.centre[0], nearest_y - c.centre[1]) <= c.radius) return true;
  }
  return false;
}

}  // namespace rondo::sim
