#include "robot/separation/numeric_set.h"

#include <algorithm>
#include <cmath>

namespace rondo::robot {

using Eigen::Vector3d;

Vector3d NumericSet::FarthestAlong(const Vector3d& d) const {
  if (kind == SetKind::kBall) {
    const double length = d.norm();
    return length > 0 ? Vector3d(origin + std::sqrt(std::max(bound, 0.0)) / length * d) : origin;
  }
  const Vector3d m = rotation.transpose() * d;
  const auto end = [&](double along, size_t low) { return along < 0 ? sizes[low] : sizes[low + 1]; };
  Vector3d local = Vector3d::Zero();
  switch (shape) {
    case ShapeKind::kSphere:
    case ShapeKind::kCapsule: {
      if (m.norm() > 0) local = sizes[0] / m.norm() * m;
      if (shape == ShapeKind::kCapsule) local.z() += end(m.z(), 1);
      break;
    }
    case ShapeKind::kCylinder: {
      const double flat = std::hypot(m.x(), m.y());
      if (flat > 0) local = Vector3d(m.x(), m.y(), 0) * (sizes[0] / flat);
      local.z() = end(m.z(), 1);
      break;
    }
    case ShapeKind::kBox:
      local = {end(m.x(), 0), end(m.y(), 2), end(m.z(), 4)};
      break;
    case ShapeKind::kPrism: {
      const auto best = std::ranges::max_element(
          corners, {}, [&](const Eigen::Vector2d& c) { return c.x() * m.x() + c.y() * m.y(); });
      local = {best->x(), best->y(), end(m.z(), 0)};
      break;
    }
    default:
      break;
  }
  return origin + rotation * local;
}

Vector3d NumericSet::Middle() const {
  if (kind == SetKind::kBall) return origin;
  return (FarthestAlong(rotation.col(2)) + FarthestAlong(-rotation.col(2))) / 2;
}

NumericSet Evaluate(Arena& arena, const Set& set, expr::Numeric& numeric) {
  NumericSet n;
  n.kind = set.kind;
  n.axes = set.axes;
  n.rotation.setIdentity();
  const auto vector = [&](const Vector& v) { return Vector3d(numeric(v[0]), numeric(v[1]), numeric(v[2])); };
  switch (set.kind) {
    case SetKind::kSolid: {
      n.shape = set.solid.kind;
      for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 3; ++j) n.rotation(i, j) = numeric(set.solid.frame.rotation[i][j]);
      }
      n.origin = vector(set.solid.frame.origin);
      for (const TermId s : set.solid.sizes) n.sizes.push_back(numeric(s));
      if (n.shape == ShapeKind::kPrism) {
        const auto corners = Corners(arena, set.solid);
        for (const auto& c : *corners) n.corners.emplace_back(numeric(c[0]), numeric(c[1]));
      }
      break;
    }
    case SetKind::kBelow:
      n.normal = vector(set.normal);
      n.bound = numeric(set.bound);
      break;
    case SetKind::kBall:
    case SetKind::kOutside:
      n.origin = vector(set.centre);
      n.bound = numeric(set.bound);
      break;
  }
  return n;
}

namespace {

Vector3d Restricted(const NumericSet& set, Vector3d d) {
  if (set.kind != SetKind::kBall) return d;
  for (int i = 0; i < 3; ++i) d[i] = set.axes[static_cast<size_t>(i)] ? d[i] : 0;
  return d;
}

}  // namespace

void Complete(const std::vector<NumericSet>& sets, size_t first, Separation& s) {
  Vector3d rest = Vector3d::Zero();
  s.sum = 0;
  s.length = 0;
  for (size_t i = 0; i < sets.size(); ++i) {
    if (i == first || sets[i].kind == SetKind::kOutside) continue;
    if (sets[i].kind == SetKind::kBelow) {
      s.directions[i] = s.factors[i] * sets[i].normal;
      s.sum += s.factors[i] * sets[i].bound;
    } else {
      s.sum += s.directions[i].dot(sets[i].FarthestAlong(s.directions[i]));
    }
    rest -= s.directions[i];
    s.length = std::max(s.length, s.directions[i].norm());
  }
  s.directions[first] = rest;
  s.point = sets[first].FarthestAlong(rest);
  s.sum += rest.dot(s.point);
}

Separation Separate(const std::vector<NumericSet>& sets, size_t first) {
  Separation s;
  s.directions.assign(sets.size(), Vector3d::Zero());
  s.factors.assign(sets.size(), 0);
  const Vector3d middle = sets[first].Middle();
  for (size_t i = 0; i < sets.size(); ++i) {
    if (i == first) continue;
    if (sets[i].kind == SetKind::kBelow) {
      const double length = std::max(sets[i].normal.norm(), 1e-12);
      s.factors[i] = std::max(0.0, (sets[i].normal.dot(middle) - sets[i].bound) / length) / length;
    } else if (sets[i].kind != SetKind::kOutside) {
      s.directions[i] = Restricted(sets[i], middle - sets[i].Middle());
    }
  }
  Separation best;
  constexpr int kSteps = 600;
  for (int step = 0; step < kSteps; ++step) {
    Complete(sets, first, s);
    if (s.length > 0) {  // homogeneous: keep the longest direction at length one
      for (auto& d : s.directions) d /= s.length;
      for (auto& f : s.factors) f /= s.length;
      s.sum /= s.length;
      s.length = 1;
    }
    if (best.directions.empty() || s.sum < best.sum) best = s;
    const double size = 0.5 / std::sqrt(1 + step * step * 0.05);
    std::vector<Vector3d> gradients(sets.size(), Vector3d::Zero());
    std::vector<double> slopes(sets.size(), 0);
    double norm = 1e-12;
    for (size_t i = 0; i < sets.size(); ++i) {
      if (i == first || sets[i].kind == SetKind::kOutside) continue;
      if (sets[i].kind == SetKind::kBelow) {
        slopes[i] = sets[i].bound - sets[i].normal.dot(s.point);
        norm += slopes[i] * slopes[i];
      } else {
        gradients[i] = Restricted(sets[i], sets[i].FarthestAlong(s.directions[i]) - s.point);
        norm += gradients[i].squaredNorm();
      }
    }
    norm = std::sqrt(norm);
    for (size_t i = 0; i < sets.size(); ++i) {
      s.directions[i] -= size / norm * gradients[i];
      s.factors[i] = std::max(0.0, s.factors[i] - size / norm * slopes[i]);
    }
  }
  return best;
}

}  // namespace rondo::robot
