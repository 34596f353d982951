#pragma once

#include <array>

#include "expr/arena.h"

/// Computes with frames and points whose coordinates are terms over the state (docs/theory.md, "Robots as
/// terms").
namespace rondo::robot {

using expr::Arena;
using expr::TermId;

/// Holds coordinates in one frame; metres for positions.
using Vector = std::array<TermId, 3>;

/// Holds X_WF: where a frame F is in the world W, as terms over state variables. `rotation[i][j]` is the i-th
/// coordinate in W of the j-th axis of F; the columns are orthonormal by construction (rotations about axes
/// only). A point with coordinates v in F lies at rotation * v + origin; the origin is in metres.
struct Pose {
  std::array<Vector, 3> rotation;
  Vector origin;
};

/// Returns the pose of the world frame itself.
Pose Identity(Arena& arena);
/// Returns the pose of a frame that is moved by v, in metres, and not turned.
Pose Translation(Arena& arena, const Vector& v);
/// Returns the pose of a frame that is turned about axis 0, 1 or 2, right-handed, by an angle in radians.
/// Sine and cosine of an angle are one term each, wherever it occurs; multiples of a right angle are exact.
Pose Rotation(Arena& arena, int axis, TermId angle);
/// Returns X_AC = X_AB * X_BC.
Pose Compose(Arena& arena, const Pose& a, const Pose& b);
/// Converts the coordinates of a point from F to the world, and back.
Vector ToWorld(Arena& arena, const Pose& frame, const Vector& v);
Vector FromWorld(Arena& arena, const Pose& frame, const Vector& p);

/// Computes with vectors in one frame: scalar product, difference; and the square of a number.
TermId Dot(Arena& arena, const Vector& a, const Vector& b);
Vector Minus(Arena& arena, const Vector& a, const Vector& b);
TermId Square(Arena& arena, TermId a);

/// Returns half a turn in radians, exactly: the term 4 atan 1.
TermId Pi(Arena& arena);
/// Reports whether a < b for certain. Knows numbers and multiples of pi; false for all others.
bool IsBelow(Arena& arena, TermId a, TermId b);
/// Returns the sine and the cosine of an angle in radians; exact numbers for multiples of a right angle.
TermId Sin(Arena& arena, TermId angle);
TermId Cos(Arena& arena, TermId angle);

}  // namespace rondo::robot
