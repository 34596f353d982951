#include "sim/bodies/waypoints.h"

#include <cmath>
#include <utility>

namespace rondo::sim {

double Distance(const Point& a, const Point& b) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

double Waypoints::Away(const Point& here, const Point& point) const {
  return tolerance_.flies ? Distance(here, point) : std::hypot(here[0] - point[0], here[1] - point[1]);
}

void Waypoints::Begin(std::vector<Point> path, const Tolerance& tolerance) {
  path_ = std::move(path);
  tolerance_ = tolerance;
  next_ = 0;
  dwelt_ = 0;
  reached_ = false;
}

void Waypoints::Copy(const std::vector<Point>& path) {
  std::vector<Point> kept = std::move(path_);
  kept.assign(path.begin(), path.end());
  Begin(std::move(kept));
}

const Point& Waypoints::Next(const Point& here) {
  while (!last() && Away(here, path_[next_]) < tolerance_.others) ++next_;
  return path_[next_];
}

void Waypoints::Pass(const Point& here, double dt) {
  if (!last() || Away(here, path_.back()) > tolerance_.last) {
    dwelt_ = 0;
    return;
  }
  dwelt_ += dt;
  // Half a period: sums of periods are not exact.
  if (dwelt_ + dt / 2 >= tolerance_.dwell) reached_ = true;
}

}  // namespace rondo::sim
