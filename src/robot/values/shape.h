#pragma once

#include <vector>

#include "robot/values/pose.h"

/// Represents shapes of robots and obstacles as sets of points.
namespace rondo::robot {

/// Names the kinds of shapes and what their sizes mean, in metres in the frame of the shape.
enum class ShapeKind : uint8_t {
  kSphere,        ///< sizes: radius
  kCylinder,      ///< sizes: radius, from z, to z
  kCapsule,       ///< sizes: radius, from z, to z: of the segment on the z axis that it surrounds
  kBox,           ///< sizes: from x, to x, from y, to y, from z, to z
  kPrism,         ///< sizes: from z, to z; faces
  kHalfSpace,     ///< the set below one face
  kHalfSphere,    ///< sizes: radius; the part of the sphere below one face through its centre
  kUnion,         ///< the points of any part; empty without parts
  kIntersection,  ///< the points that all parts have in common
};

/// Represents the half-space n . v <= offset, v in the frame of the shape; `length` is the norm of n.
struct Face {
  Vector normal;
  TermId offset;
  TermId length;
};

/// Represents a closed set of points, in coordinates of its frame.
struct Shape {
  ShapeKind kind = ShapeKind::kUnion;
  Pose frame;  ///< X_WS: where the frame of the shape is in the world
  std::vector<TermId> sizes;
  std::vector<Face> faces;
  std::vector<Shape> parts;
};

/// Returns the formula that the shape contains the point of the world. Exact.
TermId Contains(Arena& arena, const Shape& shape, const Vector& p);

/// Returns a shape that contains every point that is no farther than `margin` (>= 0, metres) from a point of
/// the shape; it may contain more at edges. An intersection of parts is widened part by part.
Shape Inflate(Arena& arena, const Shape& shape, TermId margin);

}  // namespace rondo::robot
