#include <nlohmann/json.hpp>

#include "sim/run.h"

namespace rondo::sim {

// Cells that a robot could come to from where the robots are.
std::vector<bool> Run::Reachable(const GridMap& map, const World& world, const std::vector<Point>& starts) {
  std::vector<bool> seen(map.cells.size());
  std::vector<std::pair<int, int>> stack;
  for (const Point& p : starts) stack.emplace_back(map.Column(p[0]), map.Row(p[1]));
  while (!stack.empty()) {
    const auto [c, r] = stack.back();
    stack.pop_back();
    if (!map.Inside(c, r)) continue;
    const size_t at = static_cast<size_t>(r) * static_cast<size_t>(map.columns) + static_cast<size_t>(c);
    if (seen[at] || TrulyOccupied(map, world, c, r)) continue;
    seen[at] = true;
    for (const auto& [dc, dr] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
      stack.emplace_back(c + dc, r + dr);
  }
  return seen;
}

void Run::Finish() {
  report_.violations = monitor_->violations();
  report_.plans = functions_.plans();
  report_.collisions = touches_->collisions();
  report_.first_collision = touches_->first();
  report_.first_pair = touches_->first_pair();
  report_.least_between_robots = touches_->least_between_robots();
  report_.least_to_obstacles = touches_->least_to_obstacles();
  if (networked_ != nullptr) {
    for (Violation& v : networked_->violations()) report_.violations.push_back(std::move(v));
    report_.plans = networked_->plans();
    report_.network = networked_->Report();
  }
  if (const auto map = SharedMap()) {
    std::vector<Point> starts;
    for (const FleetRobot& robot : fleet_.robots) starts.push_back(robot.position);
    const std::vector<bool> reachable = Reachable(*map, fleet_.world, starts);
    for (int r = 0; r < map->rows; ++r) {
      for (int c = 0; c < map->columns; ++c) {
        const int8_t cell = map->At(c, r);
        if (cell != GridMap::kUnknown) ++report_.known_cells;
        if (cell == GridMap::kOccupied && !TrulyOccupied(*map, fleet_.world, c, r)) ++report_.wrong_cells;
        const size_t at = static_cast<size_t>(r) * static_cast<size_t>(map->columns) + static_cast<size_t>(c);
        if (cell == GridMap::kUnknown && reachable[at]) ++report_.reachable_unknown;
      }
    }
  }
  recorder_.Event(report_.time, {{"event", "end"}, {"why", Name(report_.ended)}, {"rounds", report_.rounds}});
}

}  // namespace rondo::sim
