#include "robot/values/value.h"

#include <gtest/gtest.h>

namespace rondo::robot {
namespace {

class Values : public testing::Test {
 protected:
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }

  Arena arena_;
  const TermId x_ = Variable("x"), y_ = Variable("y");
  const TermId one_ = arena_.Number(arena_.Real(), expr::Rational(1));
};

TEST_F(Values, UnitsAreSpelledAsQuotients) {
  EXPECT_EQ(UnitText(kLength), "m");
  EXPECT_EQ(UnitText({1, -1, 0}), "m/s");
  EXPECT_EQ(UnitText({1, -2, 0}), "m/s^2");
  EXPECT_EQ(UnitText({0, -1, 1}), "rad/s");
  EXPECT_EQ(UnitText({0, -1, 0}), "1/s");
  EXPECT_EQ(UnitText({2, 0, 0}), "m^2");
  EXPECT_EQ(UnitText({}), "a number");
}

TEST_F(Values, QuantitiesAreDescribedByWhatTheyMeasure) {
  EXPECT_EQ(Describe(Quantity(x_, kLength)), "a length");
  EXPECT_EQ(Describe(Quantity(x_, kTime)), "a time");
  EXPECT_EQ(Describe(Quantity(x_, kAngle)), "an angle");
  EXPECT_EQ(Describe(Quantity(x_, {})), "a number");
  EXPECT_NE(Describe(Quantity(x_, {1, -1, 0})).find("m/s"), std::string::npos);
}

TEST_F(Values, KindsAreToldApart) {
  EXPECT_EQ(Boolean(arena_.True()).kind, ValueKind::kBool);
  EXPECT_EQ(PointAt({x_, y_, one_}).terms, (std::vector<TermId>{x_, y_, one_}));
  EXPECT_EQ(PointAt({x_, y_, one_}).dimension, kLength);
  EXPECT_EQ(FrameAt(Identity(arena_)).kind, ValueKind::kFrame);
  EXPECT_EQ(ShapeOf({}).kind, ValueKind::kShape);
}

TEST_F(Values, VariablesAreFoundInside) {
  EXPECT_EQ(VariablesOf(arena_, {arena_.Mul(x_, arena_.Add(y_, one_)), x_}), (std::set<TermId>{x_, y_}));
  EXPECT_TRUE(VariablesOf(arena_, {one_}).empty());
}

TEST_F(Values, ConstantsDependOnNothing) {
  EXPECT_TRUE(IsConstant(arena_, Quantity(one_, kLength)));
  EXPECT_FALSE(IsConstant(arena_, Quantity(arena_.Add(x_, one_), kLength)));
  EXPECT_TRUE(IsConstant(arena_, Identity(arena_)));
  EXPECT_FALSE(IsConstant(arena_, Translation(arena_, {one_, x_, one_})));
  EXPECT_FALSE(IsConstant(arena_, Rotation(arena_, 1, y_)));
}

TEST_F(Values, EveryPartOfAShapeCounts) {
  Shape ball;
  ball.kind = ShapeKind::kSphere;
  ball.frame = Identity(arena_);
  ball.sizes = {one_};
  EXPECT_TRUE(IsConstant(arena_, ball));
  Shape wide = ball, moved = ball, cut = ball, both;
  wide.sizes = {x_};
  moved.frame = Translation(arena_, {x_, one_, one_});
  cut.faces = {{{one_, one_, one_}, y_, one_}};
  both.parts = {ball, moved};
  for (const Shape& s : {wide, moved, cut, both}) EXPECT_FALSE(IsConstant(arena_, s));
  both.parts = {ball, ball};
  EXPECT_TRUE(IsConstant(arena_, both));
}

}  // namespace
}  // namespace rondo::robot
