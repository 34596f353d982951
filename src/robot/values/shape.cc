#include "robot/values/shape.h"

namespace rondo::robot {
namespace {

TermId Between(Arena& arena, TermId low, TermId value, TermId high) {
  return arena.And(arena.Le(low, value), arena.Le(value, high));
}

// |v| <= r, without a root.
TermId WithinRadius(Arena& arena, TermId squared, TermId radius) {
  const TermId zero = arena.Number(arena.Real(), expr::Rational(0));
  return arena.And(arena.Le(zero, radius), arena.Le(squared, Square(arena, radius)));
}

TermId BelowFaces(Arena& arena, const Shape& shape, const Vector& v) {
  std::vector<TermId> below;
  for (const Face& f : shape.faces) below.push_back(arena.Le(Dot(arena, f.normal, v), f.offset));
  return arena.And(below);
}

}  // namespace

TermId Contains(Arena& arena, const Shape& shape, const Vector& p) {
  if (shape.kind == ShapeKind::kUnion || shape.kind == ShapeKind::kIntersection) {
    std::vector<TermId> parts;
    for (const Shape& part : shape.parts) parts.push_back(Contains(arena, part, p));
    return shape.kind == ShapeKind::kUnion ? arena.Or(parts) : arena.And(parts);
  }
  const Vector v = FromWorld(arena, shape.frame, p);
  const auto& s = shape.sizes;
  const TermId flat = arena.Add(Square(arena, v[0]), Square(arena, v[1]));
  switch (shape.kind) {
    case ShapeKind::kSphere:
      // Distances do not depend on how the frame is turned.
      return WithinRadius(
          arena, Dot(arena, Minus(arena, p, shape.frame.origin), Minus(arena, p, shape.frame.origin)), s[0]);
    case ShapeKind::kCylinder:
      return arena.And(WithinRadius(arena, flat, s[0]), Between(arena, s[1], v[2], s[2]));
    case ShapeKind::kCapsule: {
      const auto ball = [&](TermId at) {
        return WithinRadius(arena, arena.Add(flat, Square(arena, arena.Sub(v[2], at))), s[0]);
      };
      return arena.Or({arena.And(WithinRadius(arena, flat, s[0]), Between(arena, s[1], v[2], s[2])),
                       ball(s[1]), ball(s[2])});
    }
    case ShapeKind::kBox:
      return arena.And({Between(arena, s[0], v[0], s[1]), Between(arena, s[2], v[1], s[3]),
                        Between(arena, s[4], v[2], s[5])});
    case ShapeKind::kPrism:
      return arena.And(BelowFaces(arena, shape, v), Between(arena, s[0], v[2], s[1]));
    case ShapeKind::kHalfSpace:
      return BelowFaces(arena, shape, v);
    case ShapeKind::kHalfSphere:
      return arena.And(WithinRadius(arena, arena.Add(flat, Square(arena, v[2])), s[0]),
                       BelowFaces(arena, shape, v));
    case ShapeKind::kUnion:
    case ShapeKind::kIntersection:
      break;
  }
  return arena.False();
}

Shape Inflate(Arena& arena, const Shape& shape, TermId margin) {
  Shape wide = shape;
  for (Shape& part : wide.parts) part = Inflate(arena, part, margin);
  for (Face& f : wide.faces) f.offset = arena.Add(f.offset, arena.Mul(margin, f.length));
  const auto grow = [&](size_t low) {
    wide.sizes[low] = arena.Sub(wide.sizes[low], margin);
    wide.sizes[low + 1] = arena.Add(wide.sizes[low + 1], margin);
  };
  switch (shape.kind) {
    case ShapeKind::kCylinder:
      grow(1);
      [[fallthrough]];
    case ShapeKind::kSphere:
    case ShapeKind::kCapsule:
    case ShapeKind::kHalfSphere:
      wide.sizes[0] = arena.Add(wide.sizes[0], margin);
      break;
    case ShapeKind::kBox:
      grow(0);
      grow(2);
      grow(4);
      break;
    case ShapeKind::kPrism:
      grow(0);
      break;
    case ShapeKind::kHalfSpace:
    case ShapeKind::kUnion:
    case ShapeKind::kIntersection:
      break;
  }
  return wide;
}

}  // namespace rondo::robot
