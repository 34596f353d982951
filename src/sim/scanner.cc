#include "sim/scanner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/uniform.h"
#include "sim/world/world.h"

namespace rondo::sim {

Rays Scan(const Fleet& fleet, const std::vector<std::unique_ptr<Body>>& bodies, size_t robot,
          std::mt19937_64& noise) {
  const Lidar& lidar = fleet.lidar;
  Rays rays;
  rays.first = bodies[robot]->yaw() - std::numbers::pi;
  rays.step = 2 * std::numbers::pi / lidar.beams;
  rays.range = lidar.range;
  rays.distances.resize(static_cast<size_t>(lidar.beams));
  const Point from = bodies[robot]->position();
  const World others = lidar.robots ? Others(bodies, robot) : World{};
  for (int b = 0; b < lidar.beams; ++b) {
    const double angle = rays.first + b * rays.step;
    double d = std::min(fleet.world.Cast(from, angle, rays.range), others.Cast(from, angle, rays.range));
    if (std::isfinite(d)) {
      if (lidar.noise > 0) d += lidar.noise * base::Normal(noise);
      if (lidar.resolution > 0) d = std::round(d / lidar.resolution) * lidar.resolution;
      d = std::max(d, 0.0);
    }
    rays.distances[static_cast<size_t>(b)] = d;
  }
  return rays;
}

}  // namespace rondo::sim
