#include "robot/separation/meeting.h"

#include "expr/defined.h"
#include "expr/substitute.h"
#include "robot/separation/set.h"

namespace rondo::robot {

using expr::Rational;

TermId Formula(Arena& arena, const Vector& point, const Meeting& meeting) {
  std::vector<TermId> all{meeting.configuration, meeting.where};
  for (const Shape& s : meeting.shapes) all.push_back(Contains(arena, s, point));
  if (meeting.beyond) all.push_back(expr::Complement(arena, Contains(arena, *meeting.beyond, point)));
  return arena.And(all);
}

namespace {

void Parts(const Shape& shape, std::vector<const Shape*>& parts) {
  if (shape.kind != ShapeKind::kUnion) return parts.push_back(&shape);
  for (const Shape& p : shape.parts) Parts(p, parts);
}

bool SameFrame(const Pose& a, const Pose& b) { return a.rotation == b.rotation && a.origin == b.origin; }

}  // namespace

std::vector<TermId> LocalFormulas(Arena& arena, const Vector& point, const Meeting& meeting) {
  std::vector<const Shape*> parts;
  Parts(meeting.shapes[0], parts);
  std::vector<TermId> all;
  for (const Shape* part : parts) {
    // The point of the world is where the point with coordinates `point` in the frame of this part is.
    const Vector there = ToWorld(arena, part->frame, point);
    Shape own = *part;
    if (own.kind != ShapeKind::kIntersection) own.frame = Identity(arena);
    std::vector<TermId> conjuncts{meeting.configuration};
    conjuncts.push_back(own.kind == ShapeKind::kIntersection ? Contains(arena, own, there)
                                                             : Contains(arena, own, point));
    for (size_t i = 1; i < meeting.shapes.size(); ++i)
      conjuncts.push_back(Contains(arena, meeting.shapes[i], there));
    conjuncts.push_back(expr::Substitute(arena, meeting.where,
                                         {{point[0], there[0]}, {point[1], there[1]}, {point[2], there[2]}}));
    if (meeting.beyond) conjuncts.push_back(expr::Complement(arena, Contains(arena, *meeting.beyond, there)));
    all.push_back(arena.And(conjuncts));
  }
  return all;
}

TermId Within(Arena& arena, const Shape& inner, const Shape& outer) {
  if (inner.kind == ShapeKind::kUnion) {
    std::vector<TermId> all;
    for (const Shape& p : inner.parts) all.push_back(Within(arena, p, outer));
    return arena.And(all);
  }
  if (outer.kind == ShapeKind::kUnion) {
    std::vector<TermId> any;
    for (const Shape& p : outer.parts) any.push_back(Within(arena, inner, p));
    return arena.Or(any);
  }
  if (outer.kind == ShapeKind::kIntersection) {
    std::vector<TermId> all;
    for (const Shape& p : outer.parts) all.push_back(Within(arena, inner, p));
    return arena.And(all);
  }
  if (inner.kind == ShapeKind::kIntersection) {
    std::vector<TermId> any;
    for (const Shape& p : inner.parts) any.push_back(Within(arena, p, outer));
    return arena.Or(any);
  }
  if (!SameFrame(inner.frame, outer.frame)) return arena.False();
  const auto slab = [&](size_t in, size_t out) {
    return arena.And(arena.Le(outer.sizes[out], inner.sizes[in]),
                     arena.Le(inner.sizes[in + 1], outer.sizes[out + 1]));
  };
  const TermId zero = arena.Number(arena.Real(), Rational(0));
  if (outer.kind == ShapeKind::kCylinder &&
      (inner.kind == ShapeKind::kPrism || inner.kind == ShapeKind::kBox)) {
    const size_t z = inner.kind == ShapeKind::kBox ? 4 : 0;
    std::vector<std::array<TermId, 2>> corners;
    const auto& s = inner.sizes;
    if (inner.kind == ShapeKind::kBox) {
      corners = {{s[0], s[2]}, {s[0], s[3]}, {s[1], s[2]}, {s[1], s[3]}};
    } else if (auto found = Corners(arena, inner)) {
      corners = std::move(*found);
    } else {
      return arena.False();
    }
    std::vector<TermId> all{slab(z, 1), arena.Le(zero, outer.sizes[0])};
    for (const auto& c : corners) {
      all.push_back(
          arena.Le(arena.Add(Square(arena, c[0]), Square(arena, c[1])), Square(arena, outer.sizes[0])));
    }
    return arena.And(all);
  }
  if (inner.kind != outer.kind) return arena.False();
  switch (inner.kind) {
    case ShapeKind::kSphere:
    case ShapeKind::kHalfSphere:
      if (inner.kind == ShapeKind::kHalfSphere && inner.faces.size() != outer.faces.size())
        return arena.False();
      break;
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule:
      return arena.And(arena.Le(inner.sizes[0], outer.sizes[0]), slab(1, 1));
    case ShapeKind::kBox:
      return arena.And({slab(0, 0), slab(2, 2), slab(4, 4)});
    default:
      break;
  }
  // Face by face, if they are turned alike.
  std::vector<TermId> all;
  if (inner.faces.size() != outer.faces.size()) return arena.False();
  for (size_t i = 0; i < inner.faces.size(); ++i) {
    if (inner.faces[i].normal != outer.faces[i].normal) return arena.False();
    all.push_back(arena.Le(inner.faces[i].offset, outer.faces[i].offset));
  }
  if (inner.kind == ShapeKind::kPrism) all.push_back(slab(0, 0));
  if (inner.kind == ShapeKind::kSphere || inner.kind == ShapeKind::kHalfSphere)
    all.push_back(arena.Le(inner.sizes[0], outer.sizes[0]));
  return arena.And(all);
}

TermId Undefined(Arena& arena, const Shape& shape) {
  std::vector<TermId> terms = shape.sizes;
  for (const Vector& row : shape.frame.rotation) terms.insert(terms.end(), row.begin(), row.end());
  terms.insert(terms.end(), shape.frame.origin.begin(), shape.frame.origin.end());
  for (const Face& f : shape.faces) {
    terms.insert(terms.end(), f.normal.begin(), f.normal.end());
    terms.push_back(f.offset);
  }
  std::vector<TermId> all;
  for (const TermId t : terms) {
    if (t.valid()) all.push_back(expr::Undefined(arena, t));
  }
  for (const Shape& p : shape.parts) all.push_back(Undefined(arena, p));
  return arena.Or(all);
}

TermId MayBeEmpty(Arena& arena, const Shape& shape) {
  std::vector<TermId> any{Undefined(arena, shape)};
  const TermId zero = arena.Number(arena.Real(), Rational(0));
  const auto slab = [&](size_t low) { any.push_back(arena.Lt(shape.sizes[low + 1], shape.sizes[low])); };
  switch (shape.kind) {
    case ShapeKind::kSphere:
    case ShapeKind::kHalfSphere:
      any.push_back(arena.Lt(shape.sizes[0], zero));
      break;
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule:
      any.push_back(arena.Lt(shape.sizes[0], zero));
      slab(1);
      break;
    case ShapeKind::kBox:
      slab(0);
      slab(2);
      slab(4);
      break;
    case ShapeKind::kPrism:
      slab(0);
      break;
    case ShapeKind::kHalfSpace:
    case ShapeKind::kIntersection:  // of its parts
    case ShapeKind::kUnion:
      break;
  }
  for (const Shape& p : shape.parts) any.push_back(MayBeEmpty(arena, p));
  return arena.Or(any);
}

}  // namespace rondo::robot
