#include "robot/values/pose.h"

#include <utility>

namespace rondo::robot {

using expr::Elementary;
using expr::Op;
using expr::Rational;

namespace {

TermId Real(Arena& arena, int64_t value) { return arena.Number(arena.Real(), Rational(value)); }

// An angle as `rest` and a number of right angles; multiples of pi in sums and alone are recognised.
struct Turned {
  TermId rest;
  int quarters = 0;  // 0 to 3
};

// How often `unit` is in a term that is a multiple of it: coefficients stand in front.
std::optional<Rational> Times(const Arena& arena, TermId t, TermId unit) {
  if (t == unit) return Rational(1);
  if (arena.op(t) == Op::kMul && arena.args(t).size() == 2) {
    const TermId a = arena.arg(t, 0), b = arena.arg(t, 1);
    if (arena.IsNumber(a) && b == unit) return arena.number(a);
    if (arena.IsNumber(b) && a == unit) return arena.number(b);
  }
  return std::nullopt;
}

TermId QuarterPi(Arena& arena) { return arena.Apply(Elementary::kAtan, {Real(arena, 1)}); }

Turned Split(Arena& arena, TermId angle) {
  const TermId unit = QuarterPi(arena);
  const TermId quarter = arena.Mul(Real(arena, 2), unit);  // pi / 2
  std::optional<Rational> found = Times(arena, angle, unit);
  if (!found && arena.op(angle) == Op::kAdd) {
    for (const TermId t : arena.args(angle)) {
      if (auto q = Times(arena, t, unit)) found = std::move(q);
    }
  }
  if (!found) return {angle, 0};
  const Rational quarters = *found / Rational(2);  // of a turn, rounded down
  const Rational whole = quarters.Floor();
  const Rational in_turn = whole - Rational(4) * (whole / Rational(4)).Floor();
  const TermId rest = arena.Sub(angle, arena.Mul(arena.Number(arena.Real(), whole), quarter));
  return {rest, static_cast<int>(in_turn.ToDouble())};
}

}  // namespace

TermId Pi(Arena& arena) { return arena.Mul(Real(arena, 4), QuarterPi(arena)); }

bool IsBelow(Arena& arena, TermId a, TermId b) {
  const TermId unit = QuarterPi(arena);
  const TermId difference = arena.Sub(b, a);
  // Bounds of pi / 4.
  const Rational low(785398163397448309), scale(1'000'000'000'000'000'000), high(785398163397448310);
  Rational least(0);
  const auto add = [&](TermId t) {
    if (arena.IsNumber(t)) {
      least = least + arena.number(t);
      return true;
    }
    const auto times = Times(arena, t, unit);
    if (times) least = least + *times * (*times < Rational(0) ? high : low) / scale;
    return times.has_value();
  };
  if (arena.op(difference) != Op::kAdd) return add(difference) && Rational(0) < least;
  for (const TermId t : arena.args(difference)) {
    if (!add(t)) return false;
  }
  return Rational(0) < least;
}

TermId Sin(Arena& arena, TermId angle) {
  const Turned t = Split(arena, angle);
  const TermId value = arena.Apply(t.quarters % 2 == 0 ? Elementary::kSin : Elementary::kCos, {t.rest});
  return t.quarters < 2 ? value : arena.Neg(value);
}

TermId Cos(Arena& arena, TermId angle) {
  const Turned t = Split(arena, angle);
  const TermId value = arena.Apply(t.quarters % 2 == 0 ? Elementary::kCos : Elementary::kSin, {t.rest});
  return t.quarters == 0 || t.quarters == 3 ? value : arena.Neg(value);
}

TermId Dot(Arena& arena, const Vector& a, const Vector& b) {
  return arena.Add({arena.Mul(a[0], b[0]), arena.Mul(a[1], b[1]), arena.Mul(a[2], b[2])});
}

Vector Minus(Arena& arena, const Vector& a, const Vector& b) {
  return {arena.Sub(a[0], b[0]), arena.Sub(a[1], b[1]), arena.Sub(a[2], b[2])};
}

TermId Square(Arena& arena, TermId a) { return arena.Mul(a, a); }

Pose Identity(Arena& arena) {
  const TermId zero = Real(arena, 0), one = Real(arena, 1);
  return {{{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}}, {zero, zero, zero}};
}

Pose Translation(Arena& arena, const Vector& v) {
  Pose pose = Identity(arena);
  pose.origin = v;
  return pose;
}

Pose Rotation(Arena& arena, int axis, TermId angle) {
  Pose pose = Identity(arena);
  const TermId sine = Sin(arena, angle), cosine = Cos(arena, angle);
  const auto i = static_cast<size_t>((axis + 1) % 3), j = static_cast<size_t>((axis + 2) % 3);
  pose.rotation[i][i] = cosine;
  pose.rotation[j][j] = cosine;
  pose.rotation[i][j] = arena.Neg(sine);
  pose.rotation[j][i] = sine;
  return pose;
}

Vector ToWorld(Arena& arena, const Pose& frame, const Vector& v) {
  Vector p;
  for (size_t i = 0; i < 3; ++i) p[i] = arena.Add(Dot(arena, frame.rotation[i], v), frame.origin[i]);
  return p;
}

Vector FromWorld(Arena& arena, const Pose& frame, const Vector& p) {
  const Vector d = Minus(arena, p, frame.origin);
  Vector v;
  for (size_t j = 0; j < 3; ++j) {
    v[j] = Dot(arena, {frame.rotation[0][j], frame.rotation[1][j], frame.rotation[2][j]}, d);
  }
  return v;
}

Pose Compose(Arena& arena, const Pose& a, const Pose& b) {
  Pose c;
  c.origin = ToWorld(arena, a, b.origin);
  for (size_t j = 0; j < 3; ++j) {
    const Vector axis{b.rotation[0][j], b.rotation[1][j], b.rotation[2][j]};
    for (size_t i = 0; i < 3; ++i) c.rotation[i][j] = Dot(arena, a.rotation[i], axis);
  }
  return c;
}

}  // namespace rondo::robot
