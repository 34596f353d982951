#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/bodies/body.h"

namespace rondo::sim {

/// Axis-parallel, in the world frame; metres.
struct Box {
  Point centre{};
  Point size{};
};
/// Upright.
struct Cylinder {
  Point centre{};
  double radius = 0;
  double height = 0;
};

/// What stands in the way.
struct World {
  Point low{-50, -50, 0};  ///< robots plan inside these bounds
  Point high{50, 50, 20};
  std::vector<Box> boxes;
  std::vector<Cylinder> cylinders;

  /// The distance from `from` to the first obstacle in the horizontal direction `angle`; infinite beyond
  /// `range`.
  double Cast(const Point& from, double angle, double range) const;
  /// The horizontal distance of a point from the nearest obstacle at its height; 0 inside one.
  double DistanceTo(const Point& p) const;
};

/// Touching pairs and distances (FCL). Robots are spheres.
class Contacts {
 public:
  Contacts(const World& world, const std::vector<double>& radii);
  ~Contacts();
  Contacts(const Contacts&) = delete;
  Contacts& operator=(const Contacts&) = delete;

  void Move(const std::vector<Point>& positions);
  /// A robot, and another one or (negative) obstacle -1 - k: boxes first, then cylinders. Sorted.
  std::vector<std::pair<int, int>> Touching() const;
  /// The least distance of two robots' surfaces, and of a robot and an obstacle; infinite if there is none.
  double LeastBetweenRobots() const;
  double LeastToObstacles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct PlanRequest {
  Point start{};
  Point goal{};
  double clearance = 0;  ///< from the centre of the robot to obstacles
  bool flies = false;    ///< else the plan keeps the height of the start
  uint64_t seed = 0;
  unsigned iterations = 3000;
};

/// A path from start to goal that keeps clear of the obstacles: straight if that is free, else RRT* (OMPL),
/// shortened. The same request gives the same path. nullopt if there is none within the iterations.
std::optional<std::vector<Point>> Plan(const World& world, const PlanRequest& request);

/// The least distance between two paths, of points or segments.
double PathDistance(const std::vector<Point>& p, const std::vector<Point>& q);

}  // namespace rondo::sim
