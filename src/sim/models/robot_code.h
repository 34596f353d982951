#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "reach/problem/formula.h"
#include "reach/problem/program.h"
#include "robot/model/world.h"
#include "sim/bodies/body.h"

/// Turns robot types of models into bodies that fleets can have.
namespace rondo::sim {

/// Holds a variable of a robot and the range that it never leaves, in SI units; infinite where nothing bounds
/// it.
struct RobotVariable {
  std::string name;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// Holds a formula as code.
struct RobotFormula {
  reach::Formula formula;
  reach::Program terms;
};

/// Says that variables get new values, all at once: `set[i]` becomes output i of `values`.
struct RobotUpdate {
  reach::Program values;
  std::vector<size_t> set;
};

/// Holds what a robot type does as straight-line code, the same that reachability proves contracts of: its
/// dynamics, the controller that it has beside motions, its events and ports. All code is about the variables
/// in the order of `variables`: states, memory, inputs, and parameters that have a range instead of a value.
struct RobotCode {
  std::vector<RobotVariable> variables;
  size_t states = 0, memory = 0, inputs = 0;  ///< how many of each kind
  reach::Program rates;                       ///< of the states, per second
  std::optional<double> period;  ///< of the controller, seconds; nothing: there is none, or a continuous one
  RobotUpdate laws;              ///< of a sampled controller
  struct Event {
    RobotFormula condition;
    RobotUpdate update;
  };
  std::vector<Event> events;
  struct Port {
    std::string name;
    BodyPort port;
    reach::Program values;              ///< of a number or a point
    std::optional<RobotFormula> holds;  ///< of a bool
    std::vector<size_t> set;            ///< of what can be set: the inputs
  };
  std::vector<Port> ports;
  /// Lists the inputs that neither a controller nor a port sets.
  std::vector<size_t> disturbances;
  /// Holds where the frame `base` is (without one, the robot's own): its origin in metres, then its axes, row
  /// by row.
  reach::Program place;
  std::vector<size_t> position;  ///< the states `x`, `y`, `z`; `variables.size()` for one that it has not
  size_t heading = 0;            ///< the state `theta` or `yaw`; `variables.size()` without one

  /// Returns the number of the variable; `variables.size()` if there is none of this name.
  size_t Find(std::string_view name) const;
};

/// Compiles a robot that stands alone (robot/dynamics). Costs a few milliseconds.
///
/// @error names what cannot be run: states without dynamics, inputs that nobody sets and that have no bounds,
/// what depends on the clock of motions.
base::Result<RobotCode> CodeOf(const robot::World& world, const robot::Body& body, expr::Arena& arena);

}  // namespace rondo::sim
