#pragma once

#include <optional>

#include "expr/numeric.h"
#include "robot/values/shape.h"

/// Shapes in contact, by numbers: FCL's word against ours.
namespace rondo::robot {

struct Contact {
  bool touches = false;
  double distance = 0;  ///< metres; 0 if they touch
};

/// Whether two shapes touch in a state, as the Flexible Collision Library sees it, in double precision.
/// nullopt if FCL has no such shapes: intersections and half-spheres, nor
/// half-spaces that do not touch.
std::optional<Contact> FindContact(Arena& arena, const Shape& a, const Shape& b,
                                   const expr::Numeric::Point& state);

}  // namespace rondo::robot
