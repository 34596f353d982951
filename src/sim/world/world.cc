#include "sim/world/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rondo::sim {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Slabs: where does the ray enter the rectangle?
double CastBox(const Box& box, const Point& from, double dx, double dy) {
  if (std::fabs(from[2] - box.centre[2]) > box.size[2] / 2) return kInfinity;
  double enter = 0;
  double leave = kInfinity;
  const double direction[2] = {dx, dy};
  for (size_t i = 0; i < 2; ++i) {
    const double low = box.centre[i] - box.size[i] / 2 - from[i];
    const double high = box.centre[i] + box.size[i] / 2 - from[i];
    if (direction[i] == 0) {
      if (low > 0 || high < 0) return kInfinity;
      continue;
    }
    const double a = low / direction[i];
    const double b = high / direction[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : kInfinity;
}

double CastCylinder(const Cylinder& c, const Point& from, double dx, double dy) {
  if (std::fabs(from[2] - c.centre[2]) > c.height / 2) return kInfinity;
  const double ox = from[0] - c.centre[0];
  const double oy = from[1] - c.centre[1];
  const double outside = ox * ox + oy * oy - c.radius * c.radius;
  if (outside <= 0) return 0;
  const double half = ox * dx + oy * dy;
  const double root = half * half - outside;
  if (root < 0 || half > 0) return kInfinity;
  return -half - std::sqrt(root);
}

Point Sub(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double Dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point At(const Point& p, const Point& d, double t) {
  return {p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
}

// Of the segments [a, b] and [c, d]: minimise a convex quadratic over the unit square.
double SegmentDistance(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Point u = Sub(b, a);
  const Point v = Sub(d, c);
  const Point w = Sub(a, c);
  const double uu = Dot(u, u);
  const double vv = Dot(v, v);
  const double uv = Dot(u, v);
  const auto clamp = [](double t) { return std::clamp(t, 0.0, 1.0); };
  // The best point of the second segment for one of the first, and the other way round.
  const auto second = [&](double s) { return vv > 0 ? clamp((Dot(v, w) + s * uv) / vv) : 0.0; };
  const auto first = [&](double t) { return uu > 0 ? clamp((t * uv - Dot(u, w)) / uu) : 0.0; };
  const auto distance = [&](double s, double t) { return Distance(At(a, u, s), At(c, v, t)); };
  double best = kInfinity;
  for (const double s : {0.0, 1.0}) best = std::min(best, distance(s, second(s)));
  for (const double t : {0.0, 1.0}) best = std::min(best, distance(first(t), t));
  const double det = uu * vv - uv * uv;
  if (det > 1e-12 * uu * vv) {
    const double s = (uv * Dot(v, w) - vv * Dot(u, w)) / det;
    const double t = (uu * Dot(v, w) - uv * Dot(u, w)) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, distance(s, t));
  }
  return best;
}

}  // namespace

double World::Cast(const Point& from, double angle, double range) const {
  const double dx = std::cos(angle);
  const double dy = std::sin(angle);
  double best = kInfinity;
  for (const Box& box : boxes) best = std::min(best, CastBox(box, from, dx, dy));
  for (const Cylinder& c : cylinders) best = std::min(best, CastCylinder(c, from, dx, dy));
  return best <= range ? best : kInfinity;
}

double World::DistanceTo(const Point& p) const {
  double best = kInfinity;
  for (const Box& box : boxes) {
    if (std::fabs(p[2] - box.centre[2]) > box.size[2] / 2) continue;
    const double x = std::max(0.0, std::fabs(p[0] - box.centre[0]) - box.size[0] / 2);
    const double y = std::max(0.0, std::fabs(p[1] - box.centre[1]) - box.size[1] / 2);
    best = std::min(best, std::hypot(x, y));
  }
  for (const Cylinder& c : cylinders) {
    if (std::fabs(p[2] - c.centre[2]) > c.height / 2) continue;
    best = std::min(best, std::max(0.0, std::hypot(p[0] - c.centre[0], p[1] - c.centre[1]) - c.radius));
  }
  return best;
}

World Others(const std::vector<std::unique_ptr<Body>>& bodies, size_t self) {
  World world;
  for (size_t r = 0; r < bodies.size(); ++r) {
    if (r != self)
      world.cylinders.push_back({bodies[r]->position(), bodies[r]->radius(), 2 * bodies[r]->radius()});
  }
  return world;
}

double PathDistance(const std::vector<Point>& p, const std::vector<Point>& q) {
  double best = kInfinity;
  if (p.empty() || q.empty()) return best;
  // A path of one point is a segment of length zero.
  for (size_t i = 0; i == 0 || i + 1 < p.size(); ++i) {
    for (size_t k = 0; k == 0 || k + 1 < q.size(); ++k) {
      best = std::min(best, SegmentDistance(p[i], p[std::min(i + 1, p.size() - 1)], q[k],
                                            q[std::min(k + 1, q.size() - 1)]));
    }
  }
  return best;
}

}  // namespace rondo::sim
