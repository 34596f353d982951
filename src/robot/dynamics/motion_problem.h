#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "diag/diagnostic.h"
#include "reach/problem/problem.h"
#include "robot/model/body.h"

/// States contracts of motions as problems of reachability.
namespace rondo::robot {

/// Holds a motion with its arguments, and what it promises.
struct MotionInstance {
  std::string text;  ///< as it is called: `Move(1 m)`
  const MotionDef* motion = nullptr;
  std::vector<Value> arguments;  ///< by parameter
  Contract contract;
  std::optional<Control> control;
  std::optional<expr::Rational> duration;  ///< the longest it may take, seconds; nothing: for ever
  expr::Rational least;                    ///< the shortest it may take, seconds
  bool interruptible = false;
  bool known_duration = true;  ///< `duration` and `least` are constants
  /// Lists parameters that may have any value in their range, the same one all the time.
  std::vector<Variable> unknowns;
  /// Lists pairs (variable, state): the variable is what the state was at the start.
  std::vector<std::pair<TermId, TermId>> copies;
  /// Lists the states that are allowed to leave their ranges: the ranges bound the start only.
  std::vector<TermId> visible;
};

/// Holds a problem, and what its states are called by people.
struct MotionProblem {
  reach::Problem problem;
  size_t robot_states = 0;           ///< the first ones: the robot's own, without memory, clock and the like
  std::vector<std::string> names;    ///< by state
  Scope scope;                       ///< the states and the robot's inputs: what one may ask about
  std::vector<size_t> in_range;      ///< the claims, by number, that one of these states stays in its range
  std::vector<std::string> assumed;  ///< what a proof of it rests on, for people
};

/// Returns the problem that asks whether, whenever the motion starts as its contract demands, the robot keeps
/// the contract: `during` at all times, `post` at the end, states in their ranges, and states that it does
/// not modify as they were. Inputs that no controller sets, and everything of other robots and the
/// environment, may change at any time within their ranges and within what the contract assumes.
///
/// A robot with inputs needs a controller, and be it an empty one: else nothing is known of them.
///
/// @error says why there is no such problem: no dynamics, no bounds for the start, a motion that modifies
/// nothing but whose robot moves anyway.
base::Result<MotionProblem> ProblemOf(const World& world, const Body& body, const MotionInstance& instance,
                                      Arena& arena);

/// Encloses a term without variables: bounds in degrees are no rational numbers. Returns nothing if there is
/// no term or it cannot be enclosed.
std::optional<interval::Interval> ConstantRange(const Arena& arena, std::optional<TermId> term);

/// Reads a quantity that is computed from what `problem` is about, in the language of models: `abs(x - y) + 2
/// cm`. nullopt if it is none; why is reported, and stands in `text`.
std::optional<Value> QuantityOf(const std::string& text, const MotionProblem& problem, Arena& arena,
                                diag::SourceSet& sources, diag::Diagnostics& diagnostics);

/// Returns the motion with these arguments (of kind kError: the default); reports what is wrong with them at
/// `spans`.
MotionInstance InstanceOf(const Body& body, const MotionDef& motion, const std::vector<Value>& args,
                          const std::vector<diag::Span>& spans, Evaluator& evaluator);

/// Makes `world` a world with one robot of this type at its origin. Returns false if the type has parameters
/// without a value.
/// @param given  values for parameters.
bool StandAlone(const RobotDef& type, Evaluator& evaluator, World& world, const Arguments& given = {});

/// Returns the motions of a robot type that can be looked at without a choreography: those whose parameters
/// all have a value or a range. `world` becomes a world with one such robot, which the instances are about.
/// @param left_out  gets the others, and why.
std::vector<MotionInstance> MotionsOf(const RobotDef& type, Evaluator& evaluator, World& world,
                                      std::vector<std::string>* left_out = nullptr);

}  // namespace rondo::robot
