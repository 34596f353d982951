#pragma once

#include <optional>

#include "expr/numeric.h"
#include "robot/values/shape.h"

/// Checks by other means, in numbers, whether shapes touch: witnesses of the prover are compared with what
/// FCL says.
namespace rondo::robot {

/// Tells whether two shapes touch, and how far apart they are.
struct Contact {
  bool touches = false;
  double distance = 0;  ///< metres; 0 if they touch
};

/// Returns whether two shapes touch in a state, as the Flexible Collision Library sees it, in double
/// precision. nullopt if FCL has no such shapes: intersections and half-spheres, nor half-spaces that do not
/// touch.
std::optional<Contact> FindContact(Arena& arena, const Shape& a, const Shape& b,
                                   const expr::Numeric::Point& state);

}  // namespace rondo::robot
