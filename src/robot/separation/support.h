#pragma once

#include "robot/separation/set.h"

namespace rondo::robot {

/// A direction in the world, not necessarily of length one.
struct Direction {
  Vector vector;
  TermId squared;  ///< |vector|^2
};

/// Coordinates given in a frame.
Direction DirectionIn(Arena& arena, const Pose& frame, const std::array<expr::Rational, 3>& coordinates);
Direction Opposite(Arena& arena, const Direction& d);
Direction Along(Arena& arena, const Vector& vector);

/// No point of the set lies further along the direction: d . p <= Support, for every p in it (the support
/// function; for a prism that of the hull of its corners). For solids and balls; a direction of a ball must
/// be 0 along axes that are none of its own.
TermId Support(Arena& arena, const Set& set, const Direction& d);

/// The cylinder around a box or a prism: about an axis parallel to its z axis.
std::optional<Shape> Around(Arena& arena, const Shape& solid);

/// No point of the solid is farther from `centre`, along `axes`: an upper bound of the largest distance,
/// equal to it but for cylinders that lean.
TermId Farthest(Arena& arena, const Shape& solid, const Vector& centre, const std::array<bool, 3>& axes);

}  // namespace rondo::robot
