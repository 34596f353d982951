#include "robot/separation/support.h"

#include "base/check.h"

namespace rondo::robot {

using expr::Elementary;
using expr::Rational;

namespace {

class Builder {
 public:
  explicit Builder(Arena& arena) : arena_(arena) {}

  TermId Zero() { return arena_.Number(arena_.Real(), Rational(0)); }
  TermId Max(TermId a, TermId b) {
    if (a == b) return a;
    if (!arena_.IsNumber(a) || !arena_.IsNumber(b)) return arena_.Apply(Elementary::kMax, {a, b});
    return arena_.number(a) < arena_.number(b) ? b : a;
  }
  TermId Max(const std::vector<TermId>& terms) {
    TermId most = terms[0];
    for (size_t i = 1; i < terms.size(); ++i) most = Max(most, terms[i]);
    return most;
  }
  // Of what cannot be negative.
  TermId Root(TermId a) { return arena_.Apply(Elementary::kSqrt, {Max(a, Zero())}); }
  // The larger of m * low and m * high.
  TermId Slab(TermId m, TermId low, TermId high) { return Max(arena_.Mul(m, low), arena_.Mul(m, high)); }

 private:
  Arena& arena_;
};

Vector ColumnOf(const Pose& frame, size_t axis) {
  return {frame.rotation[0][axis], frame.rotation[1][axis], frame.rotation[2][axis]};
}

}  // namespace

Direction DirectionIn(Arena& arena, const Pose& frame, const std::array<Rational, 3>& c) {
  Direction d;
  const Vector v{arena.Number(arena.Real(), c[0]), arena.Number(arena.Real(), c[1]),
                 arena.Number(arena.Real(), c[2])};
  for (size_t i = 0; i < 3; ++i) d.vector[i] = Dot(arena, frame.rotation[i], v);
  d.squared = Dot(arena, v, v);  // frames turn, and do not stretch
  return d;
}

Direction Opposite(Arena& arena, const Direction& d) {
  return {{arena.Neg(d.vector[0]), arena.Neg(d.vector[1]), arena.Neg(d.vector[2])}, d.squared};
}

Direction Along(Arena& arena, const Vector& vector) { return {vector, Dot(arena, vector, vector)}; }

TermId Support(Arena& arena, const Set& set, const Direction& d) {
  Builder b(arena);
  if (set.kind == SetKind::kBall) {
    const TermId radius = b.Root(set.bound);
    return arena.Add(Dot(arena, d.vector, set.centre), arena.Mul(radius, b.Root(d.squared)));
  }
  CHECK(set.kind == SetKind::kSolid) << "no support function";
  const Shape& s = set.solid;
  const TermId centre = Dot(arena, d.vector, s.frame.origin);
  const auto along = [&](size_t axis) { return Dot(arena, ColumnOf(s.frame, axis), d.vector); };
  switch (s.kind) {
    case ShapeKind::kSphere:
      return arena.Add(centre, arena.Mul(s.sizes[0], b.Root(d.squared)));
    case ShapeKind::kCapsule:
      return arena.Add(
          {centre, b.Slab(along(2), s.sizes[1], s.sizes[2]), arena.Mul(s.sizes[0], b.Root(d.squared))});
    case ShapeKind::kCylinder: {
      const TermId up = along(2);
      const TermId flat = b.Root(arena.Sub(d.squared, Square(arena, up)));
      return arena.Add({centre, b.Slab(up, s.sizes[1], s.sizes[2]), arena.Mul(s.sizes[0], flat)});
    }
    case ShapeKind::kBox:
      return arena.Add({centre, b.Slab(along(0), s.sizes[0], s.sizes[1]),
                        b.Slab(along(1), s.sizes[2], s.sizes[3]), b.Slab(along(2), s.sizes[4], s.sizes[5])});
    case ShapeKind::kPrism: {
      const auto corners = Corners(arena, s);
      CHECK(corners.has_value()) << "a prism without corners";
      const TermId x = along(0), y = along(1);
      std::vector<TermId> at;
      for (const auto& c : *corners) at.push_back(arena.Add(arena.Mul(x, c[0]), arena.Mul(y, c[1])));
      return arena.Add({centre, b.Max(at), b.Slab(along(2), s.sizes[0], s.sizes[1])});
    }
    default:
      CHECK(false) << "no support function";
  }
  return {};
}

std::optional<Shape> Around(Arena& arena, const Shape& s) {
  Builder b(arena);
  Shape cylinder;
  cylinder.kind = ShapeKind::kCylinder;
  cylinder.frame = s.frame;
  if (s.kind == ShapeKind::kPrism) {
    std::vector<TermId> squares;
    const auto corners = Corners(arena, s);
    if (!corners) return std::nullopt;
    for (const auto& c : *corners) squares.push_back(arena.Add(Square(arena, c[0]), Square(arena, c[1])));
    cylinder.sizes = {b.Root(b.Max(squares)), s.sizes[0], s.sizes[1]};
    return cylinder;
  }
  if (s.kind != ShapeKind::kBox) return std::nullopt;
  const TermId half = arena.Number(arena.Real(), Rational(1) / Rational(2));
  const auto middle = [&](size_t low) { return arena.Mul(half, arena.Add(s.sizes[low], s.sizes[low + 1])); };
  const auto side = [&](size_t low) { return arena.Mul(half, arena.Sub(s.sizes[low + 1], s.sizes[low])); };
  cylinder.frame.origin = ToWorld(arena, s.frame, {middle(0), middle(2), b.Zero()});
  cylinder.sizes = {b.Root(arena.Add(Square(arena, side(0)), Square(arena, side(2)))), s.sizes[4],
                    s.sizes[5]};
  return cylinder;
}

TermId Farthest(Arena& arena, const Shape& s, const Vector& centre, const std::array<bool, 3>& axes) {
  Builder b(arena);
  const auto distance = [&](const Vector& local) {
    const Vector p = ToWorld(arena, s.frame, local);
    std::vector<TermId> squares;
    for (size_t i = 0; i < 3; ++i) {
      if (axes[i]) squares.push_back(Square(arena, arena.Sub(p[i], centre[i])));
    }
    return b.Root(arena.Add(squares));
  };
  std::vector<TermId> ends;
  const auto corners = [&](const auto& plane, TermId low, TermId high) {
    for (const auto& c : plane) {
      ends.push_back(distance({c[0], c[1], low}));
      ends.push_back(distance({c[0], c[1], high}));
    }
  };
  switch (s.kind) {
    case ShapeKind::kSphere:
      return arena.Add(distance({b.Zero(), b.Zero(), b.Zero()}), s.sizes[0]);
    case ShapeKind::kCapsule:
    case ShapeKind::kCylinder:
      return arena.Add(
          b.Max(distance({b.Zero(), b.Zero(), s.sizes[1]}), distance({b.Zero(), b.Zero(), s.sizes[2]})),
          s.sizes[0]);
    case ShapeKind::kBox: {
      using Corner = std::array<TermId, 2>;
      corners(std::vector<Corner>{{s.sizes[0], s.sizes[2]},
                                  {s.sizes[0], s.sizes[3]},
                                  {s.sizes[1], s.sizes[2]},
                                  {s.sizes[1], s.sizes[3]}},
              s.sizes[4], s.sizes[5]);
      return b.Max(ends);
    }
    case ShapeKind::kPrism: {
      const auto plane = Corners(arena, s);
      CHECK(plane.has_value()) << "a prism without corners";
      corners(*plane, s.sizes[0], s.sizes[1]);
      return b.Max(ends);
    }
    default:
      CHECK(false) << "not a solid";
  }
  return {};
}

}  // namespace rondo::robot
