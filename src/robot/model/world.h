#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "robot/syntax/ast.h"
#include "robot/values/evaluate.h"

/// Builds worlds of robots as terms over their states, and contracts of their motions as formulas.
namespace rondo::robot {

/// Holds a state variable or an input, with the range that it never leaves (closed; SI units).
struct Variable {
  Name name;
  lang::Dimension dimension;
  TermId term;
  std::optional<TermId> least, most;
};

/// Says what happens as soon as a condition holds: memory gets new values, all at once.
struct ControlEvent {
  TermId condition;
  std::vector<std::pair<TermId, TermId>> updates;  ///< (memory, value)
};

/// Says how inputs and memory are set: once in each period (seconds), all at once, or without a period at all
/// times; and by events.
struct Control {
  std::optional<TermId> period;
  std::vector<std::pair<TermId, TermId>> laws;  ///< (input or memory, value)
  std::vector<ControlEvent> events;
};

/// Holds a robot in a world: its variables, frames and shapes as terms. The variable `x` of the robot `cart`
/// is the real constant `cart.x`.
struct Body {
  Name name;
  const RobotDef* type = nullptr;
  std::optional<size_t> parent;  ///< the body whose mount it stands on
  Pose self;                     ///< where it was put: X_WF of its own frame
  std::vector<Variable> states;
  std::vector<Variable> inputs;                     ///< those that nothing in the world determines
  std::vector<Variable> memory;                     ///< what its controller remembers
  std::vector<Variable> unknowns;                   ///< parameters that have a range instead of a value
  std::vector<std::optional<TermId>> derivatives;   ///< of the states, if its dynamics are known
  std::map<std::string, Value, std::less<>> ports;  ///< what programs call parts of the state, or inputs
  std::optional<Control> control;                   ///< the controller of motions without one of their own
  std::optional<Shape> body;                        ///< the space it occupies; nothing is known without it
  std::optional<Shape> hull;                        ///< a coarser shape that contains the body
  std::map<std::string, Pose, std::less<>> mounts;
  Scope scope;  ///< what its own expressions may use

  /// Lists what the robot can know by itself: its states, its inputs, and what its inputs are determined by.
  std::set<TermId> sensed;
};

/// Returns the name of a variable that these terms depend on and that the robot can know neither by itself
/// nor from `told`; nothing if there is none.
std::optional<std::string> UnknownTo(const Body& body, const Arena& arena, const std::vector<TermId>& terms,
                                     const std::vector<TermId>& told);

/// Holds a part of the world that never moves, and that no robot may touch.
struct Obstacle {
  Name name;
  Shape shape;
};

/// Holds robots, obstacles and the rest of a world. Does not move in memory: scopes refer to each other.
struct World {
  const WorldDef* source = nullptr;
  std::vector<Body> bodies;  ///< in the order of the source
  std::vector<Obstacle> obstacles;
  std::vector<Variable> environment;
  Scope scope;        ///< `world`, robots, parts of the environment
  Scope point_scope;  ///< these and a point of the world: `x`, `y`, `z`, `here`
  Vector point;
  TermId clock;  ///< time since a motion began, in seconds

  World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;
};

/// Holds what one motion promises, for one robot and given arguments. Formulas are about the state; `during`,
/// `assume` and `footprint` may depend on the clock.
struct Contract {
  TermId pre, assume, during, post;
  std::optional<Shape> footprint;  ///< of the body, if it is not stated
  std::vector<bool> modifies;      ///< by state of the robot: may the motion change it?
};

/// Finds robot types by name.
using RobotTypes = std::map<std::string, const RobotDef*, std::less<>>;

/// Builds a world. Reports what is wrong with names, units and mounts; always returns a world, with what
/// could be understood.
std::unique_ptr<World> BuildWorld(const WorldDef& source, const RobotTypes& types, Evaluator& evaluator);

/// Reports what is wrong in a robot type whatever world it is used in.
void CheckRobot(const RobotDef& type, Evaluator& evaluator);

/// Returns a scope with the names of the parameters of a motion and their values. Reports values of the wrong
/// dimension at `spans`.
/// @param args  by parameter; of kind kError: the default.
Scope MotionScope(const Body& body, const MotionDef& motion, const std::vector<Value>& args,
                  const std::vector<diag::Span>& spans, Evaluator& evaluator);

/// Returns the contract of a motion whose parameters have the values of `scope`. In `pre`, the clock is 0.
Contract ContractOf(const Body& body, const MotionDef& motion, const Scope& scope, Evaluator& evaluator);

/// Returns the controller of a motion: its own, or that of the robot; nothing if neither has one.
std::optional<Control> ControlOf(const Body& body, const MotionDef& motion, const Scope& scope,
                                 Evaluator& evaluator);

}  // namespace rondo::robot
