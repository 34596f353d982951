#pragma once

#include "robot/model/world.h"

namespace rondo::robot {

/// The variables of one line, as constants `owner.x`.
std::vector<Variable> DeclareVariables(const StateGroup& group, const std::string& owner, const Scope& scope,
                                       Evaluator& evaluator);

/// Does the type have a parameter or an input of this name?
bool HasParameter(const RobotDef& type, std::string_view name);

/// Values for parameters and inputs, and where they are written.
using Arguments = std::map<std::string, std::pair<Value, diag::Span>, std::less<>>;

/// Everything of a body but where it stands.
void FillBody(const RobotDef& type, const Arguments& given, TermId clock, Body& body, Evaluator& evaluator);

/// The laws of a controller as terms; reports what cannot be set, what is set twice, and wrong units.
Control ReadControl(const Body& body, const ControlDef& def, const Scope& scope, Evaluator& evaluator);

/// States, inputs, frames and mounts, for others.
Value SeenFromOutside(const Body& body);

}  // namespace rondo::robot
