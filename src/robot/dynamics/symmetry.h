#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robot/dynamics/motion_problem.h"

/// Removes from contracts the places that do not matter: often it makes no difference where a motion begins
/// and leads to, so that one tube serves every start and target.
namespace rondo::robot {

/// Holds a contract of a motion, without the parameters that do not matter.
struct Reduced {
  std::vector<std::string> parameters;  ///< those: the contract holds for all of their values, or for none
  /// Holds the problem for one value of each of them, where they have ranges; nothing if none of them has
  /// one.
  std::optional<MotionProblem> made;
  /// Holds the problem with zero for each of them: motions that differ in nothing else have the same one. It
  /// is kept if and only if the contract itself is.
  reach::Problem anywhere;
};

/// Finds the parameters that do not matter: lengths and angles that translations and turns (or other affine
/// changes of coordinates) of the robot's states take to any value, and that leave dynamics, controller,
/// `pre`, `during` and `post` as they are (reach/problem/symmetry.h). Ranges of states stay where they are,
/// so they must follow from `pre` at the start and from `during` later, for all values of the parameters.
/// Returns nothing if there are no such parameters.
/// @param keep  a parameter that is asked about, so that it has to stay.
std::optional<Reduced> WithoutPlace(const World& world, const Body& body, const MotionInstance& instance,
                                    Evaluator& evaluator, std::string_view keep = "");

}  // namespace rondo::robot
