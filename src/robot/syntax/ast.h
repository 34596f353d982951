#pragma once

#include <string>
#include <variant>
#include <vector>

#include "lang/syntax_tree.h"

/// Represents the syntax of robot types and worlds, common to all languages that move robots
/// (docs/motion.md). Ids of expressions that are absent are invalid; names that are absent are empty.
namespace rondo::robot {

using lang::ExprId;

/// Holds a name and where it stands.
struct Name {
  std::string text;
  diag::Span span;
};

/// Represents a parameter of a robot or motion: `T : time = 5 s` or `d : length in [0, 1 m]`. Everything but
/// the name may be missing.
struct Param {
  Name name;
  Name dimension;  ///< empty if it is not stated
  ExprId value;
  ExprId least, most;  ///< of a motion: what values it may have
};

/// Represents the parameters of one line.
struct ParamGroup {
  diag::Span span;
  std::vector<Param> params;
};

/// Represents `state x, y : length in [-10 m, 10 m]`, and the same for `input`, `memory` and `output`.
struct StateGroup {
  diag::Span span;
  Name keyword;
  std::vector<Name> names;
  Name dimension;
  ExprId least, most;  ///< may be missing
};

/// Represents `frame base = self * rotate_z(c)` or `mount top = ...`.
struct FrameDef {
  Name keyword;
  Name name;
  ExprId value;
};

/// Represents `body cylinder(base, 0.1 m, 0.2 m)` or `hull ...`.
struct ShapeDef {
  Name keyword;
  ExprId value;
};

/// Represents `port target = (tx, ty, tz)`: what a program calls a part of the state, or inputs that it sets.
struct PortDef {
  Name name;
  ExprId value;
};

/// Represents a law such as `x' = v * cos(theta)`.
struct Derivative {
  Name variable;
  ExprId value;
};

/// Represents the dynamics of a robot: the rate of each state, per second.
struct DynamicsDef {
  diag::Span span;
  std::vector<Derivative> derivatives;
};

/// Represents `when x >= -100 m { phase = 1 }`: what happens as soon as a condition holds.
struct WhenDef {
  diag::Span span;
  ExprId condition;
  std::vector<Derivative> updates;
};

/// Represents `control every 20 ms { vx = ...; sum = ... }`: how inputs and memory are set; without a period,
/// at all times.
struct ControlDef {
  diag::Span span;
  ExprId period;  ///< may be missing
  std::vector<Derivative> laws;
  std::vector<WhenDef> events;
};

/// Represents one line of a contract: `pre`, `assume`, `during`, `post`, `footprint`, `region`, `guarantee`
/// with an expression, or `modifies` with names.
struct Clause {
  Name keyword;
  std::vector<Name> names;
  ExprId value;
};

/// Represents `motion Move(d : length, T = 5 s) noninterruptible [T, T] { ... }`.
struct MotionDef {
  diag::Span span;
  Name name;
  std::vector<Param> params;
  bool interruptible = false;
  ExprId least, most;  ///< of the duration
  std::vector<Clause> clauses;
  std::vector<ControlDef> controls;  ///< its own controller: one at most
};

using RobotItem =
    std::variant<ParamGroup, StateGroup, FrameDef, ShapeDef, PortDef, DynamicsDef, ControlDef, MotionDef>;

/// Represents a robot type: its parts in the order of the source.
struct RobotDef {
  diag::Span span;
  Name name;
  std::vector<RobotItem> items;
};

/// Represents `d = 2 m`, or an argument without a name.
struct Argument {
  Name name;
  ExprId value;
};

/// Represents a robot of a world: `cart: Cart(height = 9 cm) at (0 m, 0 m, 0 m)`, or `arm: Moveo on
/// cart.top`. Without either it stands at the origin.
struct Component {
  Name name;
  Name type;
  std::vector<Argument> args;  ///< parameters of the type, each by name
  ExprId place;                ///< `at`: a position in the world, or a frame; may be missing
  Name parent, mount;          ///< `on`; empty if it stands in the world
};

/// Represents `obstacle wall: box(world, (0 m, 0 m, 0 m), (1 m, 2 m, 1 m))`.
struct ObstacleDef {
  Name name;
  ExprId shape;
};

/// Represents `environment wind { output gust : speed in [-1 m/s, 1 m/s] }`.
struct EnvironmentDef {
  Name name;
  std::vector<StateGroup> outputs;
};

/// Represents a world: robots, obstacles and the environment.
struct WorldDef {
  diag::Span span;
  Name name;
  std::vector<Component> components;
  std::vector<ObstacleDef> obstacles;
  std::vector<EnvironmentDef> environments;
};

}  // namespace rondo::robot
