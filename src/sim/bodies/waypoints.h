#pragma once

#include <array>
#include <utility>
#include <vector>

namespace rondo::sim {

using Point = std::array<double, 3>;  ///< metres, world frame

/// Returns the distance of two points in metres.
double Distance(const Point& a, const Point& b);

/// Follows who goes along points, one after the other: which is next, and whether the last is reached.
class Waypoints {
 public:
  /// Says how near to a point somebody is there, and for how long to the last one; metres and seconds.
  struct Tolerance {
    double last = 0.05, others = 0.2, dwell = 0;
    bool flies = false;  ///< else heights do not matter
  };

  /// Begins a path, of one point at least.
  void Begin(std::vector<Point> path, const Tolerance& tolerance);
  /// Goes on with a new path and the tolerance of before.
  void Begin(std::vector<Point> path) { Begin(std::move(path), tolerance_); }
  /// Does the same in the memory of the path before.
  void Copy(const std::vector<Point>& path);
  /// Returns the point to go to from here.
  const Point& Next(const Point& here);
  /// Takes in where somebody is after `dt` more seconds, `Next` having said where to go.
  void Pass(const Point& here, double dt);

  /// Reports whether the point to go to is the last one.
  bool last() const { return next_ + 1 == path_.size(); }
  /// Reports whether the last one was reached, and held for the dwell time; it stays so.
  bool reached() const { return reached_; }
  const std::vector<Point>& path() const { return path_; }

 private:
  double Away(const Point& here, const Point& point) const;

  Tolerance tolerance_;
  std::vector<Point> path_{Point{}};
  size_t next_ = 0;
  double dwelt_ = 0;
  bool reached_ = false;
};

}  // namespace rondo::sim
