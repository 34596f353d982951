#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "lang/suggest.h"
#include "robot/values/functions.h"

namespace rondo::robot {

using diag::Kind;
using expr::Elementary;
using expr::Rational;
using lang::Dimension;

Value Functions::Solid(const Arguments& a, Shape shape) {
  const TermId zero = Number(Rational(0));
  const auto& s = shape.sizes;
  bool empty = false;
  switch (shape.kind) {
    case ShapeKind::kSphere:
    case ShapeKind::kHalfSphere:
      empty = Below(s[0], zero);
      break;
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule:
      empty = Below(s[0], zero) || Below(s[2], s[1]);
      break;
    case ShapeKind::kPrism:
      empty = Below(s[1], s[0]);
      break;
    case ShapeKind::kHalfSpace:
      empty = shape.faces[0].length == zero;
      break;
    case ShapeKind::kUnion:
    case ShapeKind::kIntersection:
      empty = shape.parts.empty();
      break;
    case ShapeKind::kBox:
      break;
  }
  if (!empty) return ShapeOf(std::move(shape));
  e_.diagnostics_.Report(Kind::kRobotType, a.call.span, "this shape is empty")
      .Note("what takes no space at all would never meet anything");
  return {};
}

bool Functions::NeedPositive(const Arguments& a, size_t i) {
  const TermId t = a.values[i].terms[0];
  if (!arena_.IsNumber(t) || arena_.number(t) > Rational(0)) return true;
  e_.diagnostics_.Report(Kind::kRobotType, SpanOf(a, i), "this must be more than 0");
  return false;
}

// linear(t, a, b, T): from a at 0 to b at T.
Value Functions::Linear(Arguments& a) {
  if (!Need(a, 0, kTime, "a time") || !NeedQuantity(a, 1) || !NeedSame(a, 1, 2) ||
      !Need(a, 3, kTime, "a time") || !NeedPositive(a, 3))
    return {};
  const TermId share = arena_.Divide(a.values[0].terms[0], a.values[3].terms[0]);
  Value v = a.values[1];
  v.terms[0] = arena_.Add(v.terms[0], arena_.Mul(share, arena_.Sub(a.values[2].terms[0], v.terms[0])));
  v.squared.reset();
  return v;
}

// The same, at rest at both ends: 3 s^2 - 2 s^3.
Value Functions::SmoothStep(Arguments& a) {
  if (!Need(a, 0, kTime, "a time") || !NeedQuantity(a, 1) || !NeedSame(a, 1, 2) ||
      !Need(a, 3, kTime, "a time") || !NeedPositive(a, 3))
    return {};
  const TermId s = arena_.Divide(a.values[0].terms[0], a.values[3].terms[0]);
  const TermId ramp =
      arena_.Mul(Square(arena_, s), arena_.Sub(Number(Rational(3)), arena_.Mul(Number(Rational(2)), s)));
  Value v = a.values[1];
  v.terms[0] = arena_.Add(v.terms[0], arena_.Mul(ramp, arena_.Sub(a.values[2].terms[0], v.terms[0])));
  v.squared.reset();
  return v;
}

Value Functions::Norm(const std::vector<TermId>& v, Dimension dimension) {
  std::vector<TermId> squares;
  for (const TermId t : v) squares.push_back(Square(arena_, t));
  const TermId sum = arena_.Add(squares);
  Value norm = Quantity(arena_.Apply(Elementary::kSqrt, {sum}), dimension);
  norm.squared = sum;
  return norm;
}

Value Functions::Distance(Arguments& a) {
  if (!NeedVector(a, 0) || !NeedSame(a, 0, 1)) return {};
  std::vector<TermId> difference;
  for (size_t i = 0; i < a.values[0].terms.size(); ++i)
    difference.push_back(arena_.Sub(a.values[0].terms[i], a.values[1].terms[i]));
  return Norm(difference, a.values[0].dimension);
}

Value Functions::Length(Arguments& a) {
  if (a.values[0].kind != ValueKind::kCoordinates)
    return e_.WrongType(SpanOf(a, 0), a.values[0], "coordinates");
  return Norm(a.values[0].terms, a.values[0].dimension);
}

Value Functions::DotProduct(Arguments& a) {
  for (size_t i = 0; i < 2; ++i) {
    if (a.values[i].kind != ValueKind::kCoordinates)
      return e_.WrongType(SpanOf(a, i), a.values[i], "coordinates");
  }
  if (a.values[0].terms.size() != a.values[1].terms.size())
    return e_.WrongType(SpanOf(a, 1), a.values[1], Describe(a.values[0]));
  std::vector<TermId> products;
  for (size_t i = 0; i < a.values[0].terms.size(); ++i)
    products.push_back(arena_.Mul(a.values[0].terms[i], a.values[1].terms[i]));
  const Dimension d = a.values[0].dimension, f = a.values[1].dimension;
  return Quantity(arena_.Add(products), {d.length + f.length, d.time + f.time, d.angle + f.angle});
}

Value Functions::Direction(Arguments& a) {
  if (!Need(a, 0, kAngle, "an angle")) return {};
  Value v;
  v.kind = ValueKind::kCoordinates;
  v.terms = {Cos(arena_, a.values[0].terms[0]), Sin(arena_, a.values[0].terms[0])};
  return v;
}

Value Functions::Point(Arguments& a) {
  Vector p;
  for (size_t i = 0; i < 3; ++i) {
    if (!Need(a, i, kLength, "a length")) return {};
    p[i] = a.values[i].terms[0];
  }
  return PointAt(p);
}

Value Functions::PointIn(Arguments& a) {
  if (!NeedFrame(a, 0)) return {};
  const auto v = NeedLengths(a, 1);
  return v ? PointAt(ToWorld(arena_, *a.values[0].pose, *v)) : Value{};
}

// coordinates(frame, p): where a point of the world is as seen from a frame.
Value Functions::Coordinates(Arguments& a) {
  if (!NeedFrame(a, 0)) return {};
  if (a.values[1].kind != ValueKind::kPoint)
    return e_.WrongType(SpanOf(a, 1), a.values[1], "a point of the world");
  const Vector v = FromWorld(arena_, *a.values[0].pose, XYZ(a.values[1]));
  Value result = a.values[1];
  result.kind = ValueKind::kCoordinates;
  result.terms = {v.begin(), v.end()};
  return result;
}

Value Functions::Origin(Arguments& a) {
  return NeedFrame(a, 0) ? PointAt(a.values[0].pose->origin) : Value{};
}

// on_segment(p, a, b, r): p is no farther than r from the segment, and beside it. With d = b - a, w = p - a:
// 0 <= d.w <= d.d and |w|^2 d.d - (d.w)^2 <= r^2 d.d; a segment of one point is a ball.
Value Functions::OnSegment(Arguments& a) {
  if (!NeedVector(a, 0) || !NeedSame(a, 0, 1) || !NeedSame(a, 0, 2)) return {};
  if (!Need(a, 3, a.values[0].dimension, "a tolerance")) return {};
  const TermId zero = Number(Rational(0));
  std::vector<TermId> dd, dw, ww;
  for (size_t i = 0; i < a.values[0].terms.size(); ++i) {
    const TermId d = arena_.Sub(a.values[2].terms[i], a.values[1].terms[i]);
    const TermId w = arena_.Sub(a.values[0].terms[i], a.values[1].terms[i]);
    dd.push_back(arena_.Mul(d, d));
    dw.push_back(arena_.Mul(d, w));
    ww.push_back(arena_.Mul(w, w));
  }
  const TermId d2 = arena_.Add(dd), along = arena_.Add(dw), w2 = arena_.Add(ww);
  const TermId r2 = Square(arena_, a.values[3].terms[0]);
  const TermId beside =
      arena_.And({arena_.Le(zero, along), arena_.Le(along, d2),
                  arena_.Le(arena_.Sub(arena_.Mul(w2, d2), Square(arena_, along)), arena_.Mul(r2, d2))});
  const TermId degenerate = arena_.Eq(d2, zero);
  return Boolean(
      arena_.Or(arena_.And(degenerate, arena_.Le(w2, r2)), arena_.And(arena_.Not(degenerate), beside)));
}

Value Functions::Translate(Arguments& a) {
  const Value p = Point(a);
  return p.kind == ValueKind::kError ? p : FrameAt(Translation(arena_, XYZ(p)));
}

Value Functions::Rotate(Arguments& a) {
  if (!Need(a, 0, kAngle, "an angle")) return {};
  return FrameAt(Rotation(arena_, e_.pool_[a.call.args[0]].text.back() - 'x', a.values[0].terms[0]));
}

}  // namespace rondo::robot
