#pragma once

#include <random>
#include <vector>

#include "sim/motions/condition.h"
#include "sim/motions/scene_state.h"

namespace rondo::sim::motions {

/// Moves what nobody in a world sets: inputs of robots and the environment. Each holds a value of its range for two seconds
/// on average, in half of the cases one of its ends, and goes to the next one evenly, within a tenth of a second.
class Disturbances {
 public:
  Disturbances(const robot::World& world, const expr::Arena& arena, SceneState& scene,
               std::mt19937_64& random);

  /// Moves them to this moment, in seconds since the run began; all but those in `set`, positions of what controllers set.
  void To(double seconds, const std::vector<bool>& set);
  /// Returns the positions of those that have a range.
  const std::vector<size_t>& all() const { return all_; }

 private:
  struct One {
    size_t place;
    double low, high;
    double from, to;      // values
    double begins, ends;  // of the way from the one to the other, seconds
  };
  double Value(const One& one);

  SceneState& scene_;
  std::mt19937_64& random_;
  std::vector<One> ones_;
  std::vector<size_t> all_;
};

}  // namespace rondo::sim::motions
