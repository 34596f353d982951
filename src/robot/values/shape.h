#pragma once

#include <vector>

#include "robot/values/pose.h"

namespace rondo::robot {

enum class ShapeKind : uint8_t {
  kSphere,        ///< sizes: radius
  kCylinder,      ///< sizes: radius, from z, to z
  kCapsule,       ///< sizes: radius, from z, to z: of the segment on the z axis that it surrounds
  kBox,           ///< sizes: from x, to x, from y, to y, from z, to z
  kPrism,         ///< sizes: from z, to z; faces
  kHalfSpace,     ///< the set below one face
  kHalfSphere,    ///< sizes: radius; the part of the sphere below one face through its centre
  kUnion,         ///< of the parts; empty without any
  kIntersection,  ///< of the parts
};

/// n . v <= offset; `length` is the norm of n.
struct Face {
  Vector normal;
  TermId offset;
  TermId length;
};

/// A closed set of points, in coordinates of its frame.
struct Shape {
  ShapeKind kind = ShapeKind::kUnion;
  Pose frame;  ///< X_WS
  std::vector<TermId> sizes;
  std::vector<Face> faces;
  std::vector<Shape> parts;
};

/// Does the shape contain the point of the world? Exact.
TermId Contains(Arena& arena, const Shape& shape, const Vector& p);

/// Contains every point that is no farther than `margin` (>= 0) from a point of the shape; may contain more
/// at edges. An intersection of parts is widened part by part.
Shape Inflate(Arena& arena, const Shape& shape, TermId margin);

}  // namespace rondo::robot
