#include "robot/separation/support.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expr/numeric.h"

namespace rondo::robot {
namespace {

using expr::Rational;

class Supports : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  Vector At(const char* x, const char* y, const char* z) { return {Number(x), Number(y), Number(z)}; }
  Set Solid(ShapeKind kind, const std::vector<const char*>& sizes) {
    Set set;
    set.solid.kind = kind;
    set.solid.frame = Translation(arena_, At("10", "20", "30"));
    for (const char* s : sizes) set.solid.sizes.push_back(Number(s));
    return set;
  }
  // A triangle (0, 0), (4, 0), (0, 2), from z = -1 to 1.
  Set Prism() {
    Set set = Solid(ShapeKind::kPrism, {"-1", "1"});
    set.solid.faces = {{At("0", "-1", "0"), Number("0"), Number("1")},
                       {At("1", "2", "0"), Number("4"), Number("2.2360679775")},
                       {At("-1", "0", "0"), Number("0"), Number("1")}};
    return set;
  }
  double Value(TermId t) { return expr::Numeric(arena_, {})(t); }
  // Beyond the origin of the frame.
  double Reach(const Set& set, int x, int y, int z) {
    const Direction d = DirectionIn(arena_, Identity(arena_), {Rational(x), Rational(y), Rational(z)});
    return Value(Support(arena_, set, d)) - (10 * x + 20 * y + 30 * z);
  }

  Arena arena_;
  const std::array<bool, 3> all_{true, true, true};
};

TEST_F(Supports, SpheresReachAlikeInAllDirections) {
  const Set s = Solid(ShapeKind::kSphere, {"2"});
  EXPECT_NEAR(Reach(s, 3, 4, 0), 10, 1e-12);
  EXPECT_NEAR(Reach(s, 0, 0, -1), 2, 1e-12);
  EXPECT_NEAR(Reach(s, 0, 0, 0), 0, 1e-12);
}

TEST_F(Supports, CylindersReachToTheirRims) {
  const Set s = Solid(ShapeKind::kCylinder, {"2", "-1", "5"});
  EXPECT_NEAR(Reach(s, 3, 4, 0), 10, 1e-12);
  EXPECT_NEAR(Reach(s, 3, 4, 1), 15, 1e-9);
  EXPECT_NEAR(Reach(s, 0, 0, -1), 1, 1e-9);
}

TEST_F(Supports, CapsulesReachBeyondTheirEnds) {
  const Set s = Solid(ShapeKind::kCapsule, {"2", "-1", "5"});
  EXPECT_NEAR(Reach(s, 0, 0, 1), 7, 1e-12);
  EXPECT_NEAR(Reach(s, 0, 3, -4), 4 + 10, 1e-12);
}

TEST_F(Supports, BoxesReachToTheirCorners) {
  const Set s = Solid(ShapeKind::kBox, {"-1", "2", "-3", "4", "-5", "6"});
  EXPECT_NEAR(Reach(s, 1, -1, 1), 2 + 3 + 6, 1e-12);
  EXPECT_NEAR(Reach(s, -2, 0, -1), 2 + 5, 1e-12);
}

TEST_F(Supports, PrismsReachToTheirCorners) {
  EXPECT_NEAR(Reach(Prism(), 1, 0, 0), 4, 1e-12);
  EXPECT_NEAR(Reach(Prism(), 1, 3, 1), 6 + 1, 1e-12);
  EXPECT_NEAR(Reach(Prism(), -1, -1, 0), 0, 1e-12);
}

TEST_F(Supports, BallsReachByTheRootOfTheirBound) {
  Set ball;
  ball.kind = SetKind::kBall;
  ball.centre = At("10", "20", "30");
  ball.bound = Number("9");
  EXPECT_NEAR(Reach(ball, 0, 3, 4), 15, 1e-12);
}

TEST_F(Supports, FramesTurnDirections) {
  const TermId quarter = arena_.Mul(Number("0.5"), Pi(arena_));
  const Pose turned = Rotation(arena_, 2, quarter);
  const Direction d = DirectionIn(arena_, turned, {Rational(2), Rational(0), Rational(1)});
  EXPECT_EQ(d.vector, At("0", "2", "1"));
  EXPECT_EQ(d.squared, Number("5"));
}

TEST_F(Supports, OppositeDirectionsAreAsLong) {
  const Direction d = Along(arena_, At("1", "-2", "3"));
  EXPECT_EQ(d.squared, Number("14"));
  EXPECT_EQ(Opposite(arena_, d).vector, At("-1", "2", "-3"));
  EXPECT_EQ(Opposite(arena_, d).squared, d.squared);
}

TEST_F(Supports, CylindersAroundSolidsHoldTheirCorners) {
  const Set box = Solid(ShapeKind::kBox, {"-1", "5", "-3", "5", "-5", "6"});
  const auto around = Around(arena_, box.solid);
  ASSERT_TRUE(around.has_value());
  EXPECT_EQ(around->kind, ShapeKind::kCylinder);
  EXPECT_NEAR(Value(around->sizes[0]), 5, 1e-12);  // half of the diagonal of 6 and 8
  for (const double x : {-1.0, 5.0}) {
    for (const double y : {-3.0, 5.0}) {
      const double dx = 10 + x - Value(around->frame.origin[0]), dy = 20 + y - Value(around->frame.origin[1]);
      EXPECT_LE(std::hypot(dx, dy), Value(around->sizes[0]) + 1e-12);
    }
  }
  EXPECT_NEAR(Value(Around(arena_, Prism().solid)->sizes[0]), 4, 1e-12);
  EXPECT_FALSE(Around(arena_, Solid(ShapeKind::kSphere, {"1"}).solid).has_value());
}

TEST_F(Supports, TheFarthestPointsAreCornersAndEnds) {
  const Vector centre = At("10", "20", "30");
  const Set box = Solid(ShapeKind::kBox, {"-1", "2", "-4", "3", "0", "4"});
  EXPECT_NEAR(Value(Farthest(arena_, box.solid, centre, all_)), 6, 1e-12);  // (2, -4, 4)
  EXPECT_NEAR(Value(Farthest(arena_, box.solid, centre, {true, true, false})), std::sqrt(20), 1e-12);
  EXPECT_NEAR(Value(Farthest(arena_, Prism().solid, centre, {true, true, false})), 4, 1e-12);
  const Set capsule = Solid(ShapeKind::kCapsule, {"2", "-3", "1"});
  EXPECT_NEAR(Value(Farthest(arena_, capsule.solid, centre, all_)), 5, 1e-12);
  const Set sphere = Solid(ShapeKind::kSphere, {"2"});
  EXPECT_NEAR(Value(Farthest(arena_, sphere.solid, At("13", "24", "30"), all_)), 7, 1e-12);
}

}  // namespace
}  // namespace rondo::robot
