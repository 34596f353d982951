#include <fmt/format.h>

#include "expr/numeric.h"
#include "robot/values/functions.h"

namespace rondo::robot {

using diag::Kind;
using expr::Elementary;
using expr::Rational;

// sphere(frame or point, r)
Value Functions::Ball(Arguments& a) {
  const Value& at = a.values[0];
  if (at.kind != ValueKind::kPoint && !NeedFrame(a, 0)) return {};
  if (!Need(a, 1, kLength, "a length")) return {};
  Shape s;
  s.kind = ShapeKind::kSphere;
  s.frame = at.kind == ValueKind::kPoint ? Translation(arena_, XYZ(at)) : *at.pose;
  s.sizes = {a.values[1].terms[0]};
  return Solid(a, std::move(s));
}

// cylinder(frame, r, h) stands on its frame; cylinder(frame, r, from, to). A capsule surrounds its axis.
Value Functions::Cylinder(Arguments& a) {
  if (!NeedFrame(a, 0)) return {};
  for (size_t i = 1; i < a.values.size(); ++i) {
    if (!Need(a, i, kLength, "a length")) return {};
  }
  Shape s;
  s.kind = e_.pool_[a.call.args[0]].text == "capsule" ? ShapeKind::kCapsule : ShapeKind::kCylinder;
  s.frame = *a.values[0].pose;
  s.sizes = {a.values[1].terms[0], Number(Rational(0)), a.values.back().terms[0]};
  if (a.values.size() == 4) s.sizes[1] = a.values[2].terms[0];
  return Solid(a, std::move(s));
}

// box(frame, corner, opposite corner)
Value Functions::Box(Arguments& a) {
  if (!NeedFrame(a, 0)) return {};
  const auto low = NeedLengths(a, 1);
  const auto high = NeedLengths(a, 2);
  if (!low || !high) return {};
  Shape s;
  s.kind = ShapeKind::kBox;
  s.frame = *a.values[0].pose;
  for (size_t i = 0; i < 3; ++i) {
    s.sizes.push_back(arena_.Apply(Elementary::kMin, {(*low)[i], (*high)[i]}));
    s.sizes.push_back(arena_.Apply(Elementary::kMax, {(*low)[i], (*high)[i]}));
  }
  return Solid(a, std::move(s));
}

// Is the point above the face, as far as numbers tell? Corners on it are not.
bool Functions::IsAbove(const Face& f, const Value& point) {
  expr::Numeric numeric(arena_, {});
  const double height = numeric(f.normal[0]) * numeric(point.terms[0]) +
                        numeric(f.normal[1]) * numeric(point.terms[1]) - numeric(f.offset);
  return !(height <= 1e-9 * numeric(f.length));
}

// prism(frame, from, to, (x, y), ...): a convex polygon, counterclockwise.
Value Functions::Prism(Arguments& a) {
  if (!NeedFrame(a, 0) || !Need(a, 1, kLength, "a length") || !Need(a, 2, kLength, "a length")) return {};
  Shape s;
  s.kind = ShapeKind::kPrism;
  s.frame = *a.values[0].pose;
  s.sizes = {a.values[1].terms[0], a.values[2].terms[0]};
  const TermId zero = Number(Rational(0));
  const size_t corners = a.values.size() - 3;
  for (size_t i = 0; i < corners; ++i) {
    const Value& p = a.values[3 + i];
    const bool good = p.kind == ValueKind::kCoordinates && p.terms.size() == 2;
    if (!good) return e_.WrongType(SpanOf(a, 3 + i), p, "a corner `(x, y)`");
    if (!p.any_dimension && !(p.dimension == kLength))
      return e_.WrongUnit(SpanOf(a, 3 + i), p, "coordinates in m");
    if (!IsConstant(arena_, p)) return e_.WrongType(SpanOf(a, 3 + i), p, "a constant corner");
  }
  for (size_t i = 0; i < corners; ++i) {
    const Value& p = a.values[3 + i];
    const Value& q = a.values[3 + (i + 1) % corners];
    const TermId dx = arena_.Sub(q.terms[0], p.terms[0]), dy = arena_.Sub(q.terms[1], p.terms[1]);
    Face f{{dy, arena_.Neg(dx), zero}, {}, {}};
    f.offset = arena_.Add(arena_.Mul(f.normal[0], p.terms[0]), arena_.Mul(f.normal[1], p.terms[1]));
    f.length = arena_.Apply(Elementary::kSqrt, {arena_.Add(Square(arena_, dx), Square(arena_, dy))});
    for (size_t j = 0; j < corners; ++j) {
      const Value& r = a.values[3 + j];
      const TermId above = arena_.Lt(
          f.offset, arena_.Add(arena_.Mul(f.normal[0], r.terms[0]), arena_.Mul(f.normal[1], r.terms[1])));
      if (above != arena_.True() && !IsAbove(f, r)) continue;
      e_.diagnostics_.Report(
          Kind::kRobotType, SpanOf(a, 3 + j),
          "the corners of a prism go counterclockwise around a convex polygon, but this one does not");
      return {};
    }
    s.faces.push_back(f);
  }
  return Solid(a, std::move(s));
}

// hexagon(frame, r1, r2, h): -r1 <= u_i <= r2 for three directions in the plane, 120 degrees apart, the last
// of them x.
Value Functions::Hexagon(Arguments& a) {
  if (!NeedFrame(a, 0)) return {};
  for (size_t i = 1; i < 4; ++i) {
    if (!Need(a, i, kLength, "a length")) return {};
  }
  Shape s;
  s.kind = ShapeKind::kPrism;
  s.frame = *a.values[0].pose;
  const TermId zero = Number(Rational(0)), one = Number(Rational(1));
  for (const size_t i : {size_t{1}, size_t{2}}) {
    if (!IsConstant(arena_, a.values[i])) return e_.WrongType(SpanOf(a, i), a.values[i], "a constant");
    if (Below(a.values[i].terms[0], zero)) {
      e_.diagnostics_.Report(Kind::kRobotType, SpanOf(a, i), "this hexagon is empty");
      return {};
    }
  }
  s.sizes = {zero, a.values[3].terms[0]};
  const TermId half = Number(Rational(1) / Rational(2));
  const TermId height = arena_.Mul(half, arena_.Apply(Elementary::kSqrt, {Number(Rational(3))}));
  const Vector u0{arena_.Neg(half), arena_.Neg(height), zero}, u1{arena_.Neg(half), height, zero},
      u2{one, zero, zero};
  const auto near = [&](const Vector& u) { s.faces.push_back({u, a.values[2].terms[0], one}); };
  const auto far = [&](const Vector& u) {
    s.faces.push_back({{arena_.Neg(u[0]), arena_.Neg(u[1]), zero}, a.values[1].terms[0], one});
  };
  near(u2);  // counterclockwise
  far(u0);
  near(u1);
  far(u2);
  near(u0);
  far(u1);
  return Solid(a, std::move(s));
}

// half_space(frame, n, offset): n . v >= offset
Value Functions::HalfSpace(Arguments& a) {
  if (!NeedFrame(a, 0)) return {};
  if (a.values[1].kind != ValueKind::kCoordinates || a.values[1].terms.size() != 3)
    return e_.WrongType(SpanOf(a, 1), a.values[1], "a direction, three numbers,");
  if (!a.values[1].any_dimension && !(a.values[1].dimension == lang::Dimension{}))
    return e_.WrongUnit(SpanOf(a, 1), a.values[1], "a direction, three numbers,");
  if (!Need(a, 2, kLength, "a length")) return {};
  const Vector n = XYZ(a.values[1]);
  Shape s;
  s.kind = ShapeKind::kHalfSpace;
  s.frame = *a.values[0].pose;
  s.faces.push_back({{arena_.Neg(n[0]), arena_.Neg(n[1]), arena_.Neg(n[2])},
                     arena_.Neg(a.values[2].terms[0]),
                     arena_.Apply(Elementary::kSqrt, {Dot(arena_, n, n)})});
  return Solid(a, std::move(s));
}

// half_sphere(frame, r): the upper half
Value Functions::HalfSphere(Arguments& a) {
  if (!NeedFrame(a, 0) || !Need(a, 1, kLength, "a length")) return {};
  const TermId zero = Number(Rational(0)), one = Number(Rational(1));
  Shape s;
  s.kind = ShapeKind::kHalfSphere;
  s.frame = *a.values[0].pose;
  s.sizes = {a.values[1].terms[0]};
  s.faces.push_back({{zero, zero, arena_.Neg(one)}, zero, one});
  return Solid(a, std::move(s));
}

Value Functions::Combined(Arguments& a) {
  Shape s;
  s.kind = e_.pool_[a.call.args[0]].text == "union" ? ShapeKind::kUnion : ShapeKind::kIntersection;
  s.frame = Identity(arena_);
  for (size_t i = 0; i < a.values.size(); ++i) {
    if (!NeedShape(a, i)) return {};
    s.parts.push_back(*a.values[i].shape);
  }
  return Solid(a, std::move(s));
}

Value Functions::Inflated(Arguments& a) {
  if (!NeedShape(a, 0) || !Need(a, 1, kLength, "a length")) return {};
  const TermId margin = a.values[1].terms[0];
  const TermId zero = Number(Rational(0));
  if (Below(margin, zero)) {
    e_.diagnostics_.Report(Kind::kRobotType, SpanOf(a, 1), "a shape cannot be inflated by less than nothing");
    return {};
  }
  // By less than nothing is by nothing, so that the result never is the smaller one.
  return ShapeOf(Inflate(arena_, *a.values[0].shape, arena_.Apply(Elementary::kMax, {margin, zero})));
}

}  // namespace rondo::robot
