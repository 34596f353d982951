#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "robot/contact/solid.h"
#include "sim/motions/condition.h"
#include "sim/motions/scene_state.h"

namespace rondo::sim::motions {

/// Holds values that variables get, all at once.
struct Assignment {
  std::vector<size_t> set;  ///< positions in the scene
  Functions values;
};

/// Holds what a motion with a controller does by itself.
struct DriveCode {
  double period = 0;  ///< seconds between two times at which the controller acts; 0: always, or there is none
  std::optional<Assignment> laws;
  Assignment rates;  ///< of the states, per second
  struct Event {
    Condition condition;
    Assignment update;
  };
  std::vector<Event> events;
};

/// Holds a motion of one robot with its arguments, as code over the variables of the scene.
struct MotionCode {
  std::string text;  ///< for people: `cart: Move(1 m)`
  std::string call;  ///< `Move(1 m)`
  size_t robot = 0;
  double least = 0, most = std::numeric_limits<double>::infinity();  ///< seconds
  bool interruptible = true;
  std::vector<size_t> free;       ///< the states that it may change
  std::vector<double> low, high;  ///< of these: their ranges; infinite where there is none
  std::vector<size_t> reads;      ///< what `pre`, `during` and `end` depend on
  Condition pre, assume;
  Condition during;  ///< with the ranges of the states
  Condition end;     ///< `during` and `post` together
  std::optional<robot::Solid> footprint;
  bool unseen = false;             ///< it has a footprint, of which contacts cannot be told
  std::optional<DriveCode> drive;  ///< if its model has dynamics and a controller
};

/// Compiles a motion.
/// @error says why it cannot be simulated.
base::Result<MotionCode> CodeOf(const choreo::Graph& graph, const choreo::Instance& instance,
                                expr::Arena& arena, const SceneState& scene);

}  // namespace rondo::sim::motions
