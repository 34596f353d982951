#include "robot/contact/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rondo::robot {
namespace {

class SolidTest : public testing::Test {
 protected:
  TermId Number(double value) { return arena_.Number(arena_.Real(), expr::Rational::FromDouble(value)); }
  Shape Box(const Pose& frame) {
    Shape box;
    box.kind = ShapeKind::kBox;
    box.frame = frame;
    for (const double s : {-0.5, 0.5, -0.5, 0.5, 0.0, 1.0}) box.sizes.push_back(Number(s));
    return box;
  }
  Shape Ball(const Pose& frame, TermId radius) {
    Shape ball;
    ball.kind = ShapeKind::kSphere;
    ball.frame = frame;
    ball.sizes = {radius};
    return ball;
  }
  Pose At(TermId x) { return Translation(arena_, {x, Number(0), Number(0)}); }
  Solid Of(const Shape& shape) { return std::move(*Solid::Of(arena_, shape, {x_})); }

  Arena arena_;
  TermId x_ = arena_.FreshConstant("x", arena_.Real());
  static constexpr double kFar = std::numeric_limits<double>::infinity();
};

TEST_F(SolidTest, ShapesTouchWhereTheyStand) {
  Solid still = Of(Box(Identity(arena_))), moves = Of(Box(At(x_)));
  still.Place(std::vector<double>{0});
  for (const double x : {3.0, -2.5, 1.25}) {
    ASSERT_TRUE(moves.Place(std::vector<double>{x}));
    const auto contact = still.With(moves, kFar);
    ASSERT_TRUE(contact && !contact->touches) << x;
    EXPECT_NEAR(contact->distance, std::abs(x) - 1, 1e-6) << x;
  }
  moves.Place(std::vector<double>{0.9});
  EXPECT_TRUE(still.With(moves, kFar)->touches);
  // However little anybody wants to know of distances.
  EXPECT_TRUE(still.With(moves, 0)->touches);
}

TEST_F(SolidTest, SizesMayChange) {
  Solid still = Of(Box(At(Number(5)))), grows = Of(Ball(Identity(arena_), x_));
  still.Place(std::vector<double>{0});
  grows.Place(std::vector<double>{1});
  EXPECT_FALSE(still.With(grows, kFar)->touches);
  grows.Place(std::vector<double>{4.75});
  EXPECT_TRUE(still.With(grows, kFar)->touches);
}

TEST_F(SolidTest, WhatHasNoPlaceIsNowhere) {
  Solid moves = Of(Box(At(arena_.Apply(expr::Elementary::kSqrt, {x_}))));
  EXPECT_TRUE(moves.Place(std::vector<double>{4}));
  EXPECT_FALSE(moves.Place(std::vector<double>{-1}));
}

TEST_F(SolidTest, ThereAreShapesThatItDoesNotKnow) {
  Shape half;
  half.kind = ShapeKind::kIntersection;
  half.frame = Identity(arena_);
  half.parts = {Box(Identity(arena_)), Box(At(x_))};
  EXPECT_FALSE(Solid::Of(arena_, half, {x_}).has_value());
  EXPECT_FALSE(Solid::Of(arena_, Box(At(arena_.FreshConstant("y", arena_.Real()))), {x_}).has_value());
}

}  // namespace
}  // namespace rondo::robot
