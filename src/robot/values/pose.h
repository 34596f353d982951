#pragma once

#include <array>

#include "expr/arena.h"

namespace rondo::robot {

using expr::Arena;
using expr::TermId;

/// Coordinates in one frame; metres for positions.
using Vector = std::array<TermId, 3>;

/// X_WF: where a frame F is in the world W, as terms over state variables. `rotation[i][j]` is the i-th
/// coordinate in W of the j-th axis of F; the columns are orthonormal by construction (rotations about axes
/// only). A point with coordinates v in F lies at rotation * v + origin.
struct Pose {
  std::array<Vector, 3> rotation;
  Vector origin;
};

Pose Identity(Arena& arena);
Pose Translation(Arena& arena, const Vector& v);
/// Right-handed, about axis 0, 1 or 2 of the frame; radians. Sine and cosine of an angle are one term each,
/// wherever it occurs; multiples of a right angle are exact.
Pose Rotation(Arena& arena, int axis, TermId angle);
/// X_AC = X_AB * X_BC
Pose Compose(Arena& arena, const Pose& a, const Pose& b);
/// From coordinates in F to the world, and back.
Vector ToWorld(Arena& arena, const Pose& frame, const Vector& v);
Vector FromWorld(Arena& arena, const Pose& frame, const Vector& p);

TermId Dot(Arena& arena, const Vector& a, const Vector& b);
Vector Minus(Arena& arena, const Vector& a, const Vector& b);
TermId Square(Arena& arena, TermId a);

/// Half a turn, exactly: 4 atan 1.
TermId Pi(Arena& arena);
/// Is a < b for certain? Knows numbers and multiples of pi.
bool IsBelow(Arena& arena, TermId a, TermId b);
TermId Sin(Arena& arena, TermId angle);
TermId Cos(Arena& arena, TermId angle);

}  // namespace rondo::robot
