#pragma once

#include "robot/separation/set.h"

/// States how far sets reach in a direction, exactly.
namespace rondo::robot {

/// Represents a direction in the world, not necessarily of length one.
struct Direction {
  Vector vector;
  TermId squared;  ///< |vector|^2
};

/// Returns the direction with these coordinates in a frame; the opposite one; the one along a vector of the
/// world.
Direction DirectionIn(Arena& arena, const Pose& frame, const std::array<expr::Rational, 3>& coordinates);
Direction Opposite(Arena& arena, const Direction& d);
Direction Along(Arena& arena, const Vector& vector);

/// Returns the support function of a set: no point of it lies further along the direction, d . p <= Support
/// for every p in it (for a prism: in the hull of its corners). For solids and balls only; a direction of a
/// ball must be 0 along axes that are none of its own.
TermId Support(Arena& arena, const Set& set, const Direction& d);

/// Returns a cylinder that contains a box or a prism, about an axis parallel to its z axis; nothing for other
/// solids.
std::optional<Shape> Around(Arena& arena, const Shape& solid);

/// Returns an upper bound of the distance of the points of a solid from `centre`, along `axes`; no point is
/// farther. It is the largest distance itself but for cylinders that lean.
TermId Farthest(Arena& arena, const Shape& solid, const Vector& centre, const std::array<bool, 3>& axes);

}  // namespace rondo::robot
