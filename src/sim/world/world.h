#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sim/bodies/body.h"

/// Models what surrounds simulated robots: obstacles, contacts with them, and paths around them.
namespace rondo::sim {

/// Represents a box whose edges are parallel to the axes of the world frame W: its centre and the lengths of
/// its edges along x, y and z, in metres.
struct Box {
  Point centre{};
  Point size{};
  friend bool operator==(const Box&, const Box&) = default;
};
/// Represents a cylinder whose axis is parallel to the z axis of W: its centre, radius and height, in metres.
/// It reaches half its height above and below the centre.
struct Cylinder {
  Point centre{};
  double radius = 0;
  double height = 0;
};

/// Holds the obstacles, and the bounds within which robots plan; metres, world frame.
struct World {
  Point low{-50, -50, 0};  ///< the corner of the bounds with the least coordinates
  Point high{50, 50, 20};
  std::vector<Box> boxes;
  std::vector<Cylinder> cylinders;

  /// Returns the distance from `from` to the first obstacle in the horizontal direction `angle` (radians from
  /// the x axis), among those at the height of `from`; infinite if there is none within `range` metres.
  double Cast(const Point& from, double angle, double range) const;
  /// Returns the horizontal distance of a point from the nearest obstacle at its height, in metres; 0 inside
  /// one, infinite if there is none at its height.
  double DistanceTo(const Point& p) const;
};

/// Returns the robots but number `self`, which is about to scan or to plan, as obstacles: cylinders around
/// spheres.
World Others(const std::vector<std::unique_ptr<Body>>& bodies, size_t self);

/// Finds touching pairs and least distances (FCL). Robots are spheres around their positions.
class Contacts {
 public:
  /// Takes the obstacles of the world, and a robot for each radius in metres.
  Contacts(const World& world, const std::vector<double>& radii);
  ~Contacts();
  Contacts(const Contacts&) = delete;
  Contacts& operator=(const Contacts&) = delete;

  /// Puts the robots at these positions, one for each radius.
  void Move(const std::vector<Point>& positions);
  /// Returns pairs of a robot and another one or (negative) an obstacle -1 - k: boxes first, then cylinders.
  /// Sorted.
  std::vector<std::pair<int, int>> Touching() const;
  /// Returns the least distance of two robots' surfaces, and of the surfaces of a robot and an obstacle, in
  /// metres; infinite if there is no such pair.
  double LeastBetweenRobots() const;
  double LeastToObstacles() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Says what path is wanted.
struct PlanRequest {
  Point start{};
  Point goal{};
  double clearance = 0;  ///< metres that the centre of the robot keeps from obstacles
  bool flies = false;    ///< false: the path keeps the height of the start
  uint64_t seed = 0;
  unsigned iterations = 3000;
};

/// Returns a path from start to goal that keeps clear of the obstacles: straight if that is free, else found
/// by RRT* (OMPL) and shortened. The same request gives the same path. nullopt if none is found within the
/// iterations.
std::optional<std::vector<Point>> Plan(const World& world, const PlanRequest& request);

/// Returns the least distance between two paths, each a point or segments between its points; infinite if one
/// of them is empty.
double PathDistance(const std::vector<Point>& p, const std::vector<Point>& q);

}  // namespace rondo::sim
