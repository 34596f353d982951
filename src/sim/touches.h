#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sim/fleet/fleet.h"

namespace rondo::sim {

/// Watches what robots touch, and how near they come.
class Touches {
 public:
  /// Receives each contact as it begins: a robot, and what it touches.
  using Begins = std::function<void(double time, const std::string& robot, const std::string& with)>;
  /// @param fleet, bodies  outlive this.
  Touches(const Fleet& fleet, const std::vector<std::unique_ptr<Body>>& bodies, Begins begins);

  /// Looks at where the bodies are; `time` in seconds.
  void Observe(double time);

  uint64_t collisions() const { return collisions_; }            ///< how often a contact began
  double first() const { return first_; }                        ///< when; -1: never
  const std::string& first_pair() const { return first_pair_; }  ///< `a and b`
  /// Give the least distances so far, in metres between surfaces; infinite if there is nothing, or (beyond 200 robots) if it
  /// is not measured.
  double least_between_robots() const { return between_; }
  double least_to_obstacles() const { return obstacles_; }

 private:
  std::string NameOf(int who) const;

  const Fleet& fleet_;
  const std::vector<std::unique_ptr<Body>>& bodies_;
  Begins begins_;
  Contacts contacts_;
  std::vector<Point> positions_;
  std::set<std::pair<int, int>> touching_;
  uint64_t collisions_ = 0;
  double first_ = -1;
  std::string first_pair_;
  double between_ = std::numeric_limits<double>::infinity();
  double obstacles_ = std::numeric_limits<double>::infinity();
};

}  // namespace rondo::sim
