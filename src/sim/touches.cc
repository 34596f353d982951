#include "sim/touches.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::sim {

namespace {

std::vector<double> RadiiOf(const std::vector<std::unique_ptr<Body>>& bodies) {
  std::vector<double> radii;
  for (const auto& body : bodies) radii.push_back(body->radius());
  return radii;
}

}  // namespace

Touches::Touches(const Fleet& fleet, const std::vector<std::unique_ptr<Body>>& bodies, Begins begins)
    : fleet_(fleet), bodies_(bodies), begins_(std::move(begins)), contacts_(fleet.world, RadiiOf(bodies)) {}

std::string Touches::NameOf(int who) const {
  if (who >= 0) return fleet_.robots[static_cast<size_t>(who)].name;
  const auto number = static_cast<size_t>(-1 - who);
  const size_t boxes = fleet_.world.boxes.size();
  return number < boxes ? fmt::format("box {}", number) : fmt::format("cylinder {}", number - boxes);
}

void Touches::Observe(double time) {
  positions_.clear();
  for (const auto& body : bodies_) positions_.push_back(body->position());
  contacts_.Move(positions_);
  const auto touching = contacts_.Touching();
  const std::set<std::pair<int, int>> pairs(touching.begin(), touching.end());
  for (const auto& [a, b] : pairs) {
    if (touching_.contains({a, b})) continue;
    if (collisions_++ == 0) {
      first_ = time;
      first_pair_ = fmt::format("{} and {}", NameOf(a), NameOf(b));
    }
    begins_(time, NameOf(a), NameOf(b));
  }
  touching_ = pairs;
  if (bodies_.size() > 200) return;
  between_ = std::min(between_, contacts_.LeastBetweenRobots());
  obstacles_ = std::min(obstacles_, contacts_.LeastToObstacles());
}

}  // namespace rondo::sim
