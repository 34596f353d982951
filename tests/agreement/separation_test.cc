// Separating directions against what shares no code with them: points of shapes, the general solver over
// points, random states, and FCL.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "choreo/prove/decide.h"
#include "choreo/prove/sampler.h"
#include "robot/contact/contact.h"
#include "robot/separation/numeric_set.h"
#include "robot/separation/support.h"
#include "verdict/verdict.h"

namespace rondo {
namespace {

using expr::Arena;
using expr::Rational;
using expr::TermId;
using robot::Pose;
using robot::Shape;
using robot::ShapeKind;
using verdict::Verdict;

TermId Number(Arena& arena, const Rational& r) { return arena.Number(arena.Real(), r); }
TermId Number(Arena& arena, double d) {
  return Number(arena, Rational(std::llround(d * 1000)) / Rational(1000));
}

robot::Face FaceOf(Arena& arena, double x, double y, double offset) {
  return {{Number(arena, x), Number(arena, y), Number(arena, 0.0)},
          Number(arena, offset),
          Number(arena, std::hypot(x, y))};
}

// A shape of every kind with a support function, in its own frame.
Shape MakeShape(Arena& arena, ShapeKind kind, const Pose& frame, double size) {
  Shape s;
  s.kind = kind;
  s.frame = frame;
  const auto n = [&](double d) { return Number(arena, d * size); };
  switch (kind) {
    case ShapeKind::kSphere:
      s.sizes = {n(1)};
      break;
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule:
      s.sizes = {n(0.6), n(-0.5), n(1)};
      break;
    case ShapeKind::kBox:
      s.sizes = {n(-0.5), n(1), n(-0.7), n(0.4), n(-1), n(0.3)};
      break;
    case ShapeKind::kPrism:
      s.sizes = {n(-0.2), n(0.9)};
      s.faces = {FaceOf(arena, 1, 0, 0.8 * size), FaceOf(arena, 1, 2, 1.5 * size), FaceOf(arena, -2, 1, size),
                 FaceOf(arena, 0, -1, 0.5 * size)};
      break;
    default:
      break;
  }
  return s;
}

constexpr std::array kSolids{ShapeKind::kSphere, ShapeKind::kCylinder, ShapeKind::kCapsule, ShapeKind::kBox,
                             ShapeKind::kPrism};

// Wherever the numbers are, the support is that of the farthest point, and that point is in the shape.
TEST(Separation, SupportIsThatOfTheFarthestPoint) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<> unit(-1, 1);
  for (const ShapeKind kind : kSolids) {
    for (int round = 0; round < 200; ++round) {
      Arena arena;
      const Pose frame = robot::Compose(
          arena,
          robot::Translation(
              arena, {Number(arena, unit(random)), Number(arena, unit(random)), Number(arena, unit(random))}),
          robot::Compose(arena, robot::Rotation(arena, 2, Number(arena, 3 * unit(random))),
                         robot::Rotation(arena, 1, Number(arena, 3 * unit(random)))));
      robot::Set set;
      set.solid = MakeShape(arena, kind, frame, 0.5);
      const std::array<Rational, 3> c{Rational(random() % 20) - Rational(10),
                                      Rational(random() % 20) - Rational(10),
                                      Rational(random() % 20) - Rational(10)};
      const robot::Direction d = robot::DirectionIn(arena, robot::Identity(arena), c);
      expr::Numeric numeric(arena, {});
      const robot::NumericSet n = robot::Evaluate(arena, set, numeric);
      const Eigen::Vector3d v(c[0].ToDouble(), c[1].ToDouble(), c[2].ToDouble());
      EXPECT_NEAR(numeric(robot::Support(arena, set, d)), v.dot(n.FarthestAlong(v)), 1e-9);
      const Eigen::Vector3d p = n.FarthestAlong(v);
      const robot::Vector point{arena.Number(arena.Real(), Rational::FromDouble(p[0])),
                                arena.Number(arena.Real(), Rational::FromDouble(p[1])),
                                arena.Number(arena.Real(), Rational::FromDouble(p[2]))};
      const Shape wider =
          robot::Inflate(arena, set.solid, arena.Number(arena.Real(), Rational(1) / Rational(1'000'000)));
      EXPECT_EQ(expr::Numeric(arena, {}).Violation(robot::Contains(arena, wider, point)), 0);
      // Nor is any other point of the shape beyond it.
      const robot::Vector q{arena.Variable(arena.Declare("x", {}, arena.Real())),
                            arena.Variable(arena.Declare("y", {}, arena.Real())),
                            arena.Variable(arena.Declare("z", {}, arena.Real()))};
      const TermId inside = robot::Contains(arena, set.solid, q);
      const double most = numeric(robot::Support(arena, set, d));
      for (int k = 0; k < 50; ++k) {
        const Eigen::Vector3d r = n.origin + Eigen::Vector3d::Random();
        expr::Numeric::Point at;
        for (size_t i = 0; i < 3; ++i) at[q[i]] = r[static_cast<Eigen::Index>(i)];
        const bool within = expr::Numeric(arena, at).Violation(inside) == 0;
        EXPECT_TRUE(!within || v.dot(r) <= most + 1e-9);
      }
    }
  }
}

/// Two shapes that depend on two variables of a world of their own.
struct Scene {
  Arena arena;
  robot::World world;
  choreo::Obligation obligation;

  explicit Scene(std::mt19937_64& random) {
    const auto variable = [&](const char* name) {
      return arena.Variable(arena.Declare(name, {}, arena.Real()));
    };
    world.point = {variable("world.x"), variable("world.y"), variable("world.z")};
    world.clock = variable("clock");
    const TermId a = variable("a"), t = variable("t");
    robot::Body body;
    robot::Variable va, vt;
    va.term = a;
    vt.term = t;
    body.states = {va, vt};
    world.bodies.push_back(std::move(body));
    std::uniform_real_distribution<> unit(-1, 1);
    const auto angle = [&] { return random() % 2 == 0 ? a : Number(arena, 3 * unit(random)); };
    const auto place = [&](double reach) {
      return robot::Translation(
          arena,
          {Number(arena, reach * unit(random)), Number(arena, reach * unit(random)),
           arena.Add(Number(arena, reach * unit(random)), random() % 2 == 0 ? t : Number(arena, 0.0))});
    };
    const auto shape = [&] {
      Pose frame =
          robot::Compose(arena, place(1.2), robot::Rotation(arena, static_cast<int>(random() % 3), angle()));
      frame = robot::Compose(arena, frame, robot::Rotation(arena, static_cast<int>(random() % 3), angle()));
      return MakeShape(arena, kSolids[random() % kSolids.size()], frame, 0.3 + 0.3 * std::abs(unit(random)));
    };
    robot::Meeting meeting;
    const auto range = [&](TermId v, double low, double high) {
      return arena.And(arena.Le(Number(arena, low), v), arena.Le(v, Number(arena, high)));
    };
    meeting.configuration =
        arena.And(range(a, 0, 1.2 * std::abs(unit(random))), range(t, 0, 0.5 * std::abs(unit(random))));
    meeting.where = arena.True();
    meeting.shapes = {shape()};
    const auto& p = world.point;
    switch (random() % 4) {
      case 0:  // beyond planes
        meeting.where = arena.And(arena.Le(Number(arena, unit(random)), arena.Add(p[0], p[2])),
                                  arena.Lt(p[1], Number(arena, unit(random))));
        break;
      case 1:  // in, or outside of, a cylinder about z
      {
        const TermId flat = arena.Add(robot::Square(arena, p[0]), robot::Square(arena, arena.Sub(p[1], t)));
        const TermId r = Number(arena, 0.3 + std::abs(unit(random)));
        meeting.where = random() % 2 == 0 ? arena.Lt(flat, r) : arena.Le(arena.Add(r, r), flat);
        break;
      }
      default:
        meeting.shapes.push_back(shape());
    }
    obligation.formula = robot::Formula(arena, p, meeting);
    obligation.rest = arena.True();
    obligation.meeting = std::move(meeting);
  }
};

// Both ways of deciding agree, and samples confirm them.
TEST(Separation, AgreesWithPointsAndSamples) {
  std::mt19937_64 random(11);
  int proved = 0, refuted = 0, open = 0, both = 0;
  const char* more = std::getenv("RONDO_CASES");
  const int rounds = more != nullptr ? std::atoi(more) / 100 : 300;
  for (int round = 0; round < rounds; ++round) {
    Scene scene(random);
    choreo::Limits limits;
    limits.time = std::chrono::milliseconds(2000);
    limits.certificates = false;
    const choreo::Decision quick = choreo::Decide(scene.obligation, scene.world, scene.arena, {}, limits, {});
    (quick.verdict == Verdict::kProved ? proved : quick.verdict == Verdict::kRefuted ? refuted : open) += 1;
    limits.separation = false;
    limits.time = std::chrono::milliseconds(150);
    const choreo::Decision slow = choreo::Decide(scene.obligation, scene.world, scene.arena, {}, limits, {});
    if (quick.verdict != Verdict::kUnknown && slow.verdict != Verdict::kUnknown) {
      ++both;
      EXPECT_EQ(quick.verdict, slow.verdict) << round;
    }
    const robot::Meeting& m = *scene.obligation.meeting;
    if (quick.verdict == Verdict::kRefuted) {
      EXPECT_LE(expr::Numeric(scene.arena, quick.witness.values).Violation(scene.obligation.formula), 1e-6)
          << round;
      if (m.shapes.size() == 2) {
        const auto contact = robot::FindContact(scene.arena, m.shapes[0], m.shapes[1], quick.witness.values);
        EXPECT_TRUE(contact && (contact->touches || contact->distance < 1e-6)) << round;
      }
    }
    if (quick.verdict != Verdict::kProved) continue;
    const choreo::Sampler sampler(scene.arena, m.configuration);
    for (int k = 0; k < 30; ++k) {
      const auto state = sampler.Draw(random, 20);
      if (!state) continue;
      if (m.shapes.size() == 2) {
        const auto contact = robot::FindContact(scene.arena, m.shapes[0], m.shapes[1], *state);
        EXPECT_FALSE(contact && contact->touches) << round;
        continue;
      }
      // The farthest points of the shape are not where they must not be.
      robot::Set set;
      set.solid = m.shapes[0];
      expr::Numeric numeric(scene.arena, *state);
      const robot::NumericSet n = robot::Evaluate(scene.arena, set, numeric);
      for (int i = 0; i < 40; ++i) {
        const Eigen::Vector3d p =
            0.999999 * n.FarthestAlong(Eigen::Vector3d::Random()) + 0.000001 * n.Middle();
        expr::Numeric::Point at = *state;
        for (size_t c = 0; c < 3; ++c) at[scene.world.point[c]] = p[static_cast<Eigen::Index>(c)];
        EXPECT_GT(expr::Numeric(scene.arena, at).Violation(m.where), 0) << round;
      }
    }
  }
  EXPECT_GT(proved, rounds / 5);
  EXPECT_GT(refuted, rounds / 5);
  EXPECT_LT(open, rounds / 10);
  EXPECT_GT(both, rounds / 10);
}

}  // namespace
}  // namespace rondo
