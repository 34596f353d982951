#pragma once

#include "robot/model/world.h"

/// Turns robot types into bodies: the parts of `BuildWorld` that are about one robot.
namespace rondo::robot {

/// Returns the variables of one line, such as `state x, y : length`, as constants `owner.x`.
std::vector<Variable> DeclareVariables(const StateGroup& group, const std::string& owner, const Scope& scope,
                                       Evaluator& evaluator);

/// Reports whether the type has a parameter or an input of this name.
bool HasParameter(const RobotDef& type, std::string_view name);

/// Holds values for parameters and inputs, and where they are written.
using Arguments = std::map<std::string, std::pair<Value, diag::Span>, std::less<>>;

/// Fills in everything of a body but where it stands; reports what is wrong.
void FillBody(const RobotDef& type, const Arguments& given, TermId clock, Body& body, Evaluator& evaluator);

/// Returns the laws of a controller as terms; reports what cannot be set, what is set twice, and wrong units.
Control ReadControl(const Body& body, const ControlDef& def, const Scope& scope, Evaluator& evaluator);

/// Returns what others can name of a robot, as `cart.x`: states, inputs, frames and mounts.
Value SeenFromOutside(const Body& body);

}  // namespace rondo::robot
