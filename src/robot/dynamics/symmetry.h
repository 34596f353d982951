#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/dynamics/motion_problem.h"

/// Where a motion begins, and where it leads to, often does not matter: one tube serves every start and
/// target.
namespace rondo::robot {

/// A contract of a motion, without the parameters that do not matter.
struct Reduced {
  std::vector<std::string> parameters;  ///< those: the contract holds for all of their values, or for none
  /// For one of their values each, where they have ranges; nothing if none of them has one.
  std::optional<MotionProblem> made;
  /// With zero for each: motions that differ in nothing else have the same one. It is kept if and only if the
  /// contract itself is.
  reach::Problem anywhere;
};

/// Lengths and angles among the parameters that translations and turns (or other affine changes of
/// coordinates) of the robot's states take to any value, and that leave dynamics, controller, `pre`, `during`
/// and `post` as they are (reach/problem/symmetry.h). Ranges of states stay where they are, so they must
/// follow from `pre` at the start and from `during` later, for all values of the parameters. `keep`: a
/// parameter that is asked about. Nothing if there are no such parameters.
std::optional<Reduced> WithoutPlace(const World& world, const Body& body, const MotionInstance& instance,
                                    Evaluator& evaluator, std::string_view keep = "");

}  // namespace rondo::robot
