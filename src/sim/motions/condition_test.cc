#include "sim/motions/condition.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rondo::sim::motions {
namespace {

using expr::Rational;
using expr::TermId;

class ConditionTest : public testing::Test {
 protected:
  TermId Number(double value) { return arena_.Number(arena_.Real(), Rational::FromDouble(value)); }
  TermId Square(TermId t) { return arena_.Mul(t, t); }
  Condition Of(TermId formula) { return Condition::Of(arena_, formula, {x_, y_}).value(); }

  expr::Arena arena_;
  TermId x_ = arena_.FreshConstant("x", arena_.Real()), y_ = arena_.FreshConstant("y", arena_.Real());
  std::vector<double> at_{0, 0};
  std::vector<size_t> both_{0, 1};
};

TEST_F(ConditionTest, TellsByHowMuchAFormulaFails) {
  Condition c = Of(arena_.And(arena_.Le(x_, Number(1)), arena_.Le(y_, Number(5))));
  EXPECT_LE(c.Miss(std::vector<double>{1, 2}), 0);
  EXPECT_EQ(c.Miss(std::vector<double>{4, 2}), 3);
  EXPECT_FALSE(c.Holds(std::vector<double>{4, 2}));
}

TEST_F(ConditionTest, WhatHasNoValueDoesNotHold) {
  Condition c = Of(arena_.Le(arena_.Apply(expr::Elementary::kSqrt, {x_}), Number(5)));
  EXPECT_FALSE(c.Holds(std::vector<double>{-1, 0}));
  EXPECT_TRUE(c.Holds(std::vector<double>{4, 0}));
}

// Not nearly, but to the last bit: guards ask for no less.
TEST_F(ConditionTest, EquationsAreMetExactly) {
  for (const double wanted : {1.0, 0.1, -3.7, 1e-3, 123.456}) {
    Condition c = Of(arena_.And(arena_.Eq(x_, Number(wanted)), arena_.Eq(y_, arena_.Add(x_, Number(2)))));
    at_ = {wanted + 0.3, -7};
    ASSERT_TRUE(c.Approach(at_, both_)) << wanted;
    EXPECT_EQ(at_[0], wanted);
    EXPECT_NEAR(at_[1], wanted + 2, 1e-12);
  }
}

TEST_F(ConditionTest, OnlyWhatIsFreeMoves) {
  Condition c = Of(arena_.Eq(arena_.Add(x_, y_), Number(3)));
  at_ = {1, 7};
  ASSERT_TRUE(c.Approach(at_, std::vector<size_t>{1}));
  EXPECT_EQ(at_, (std::vector<double>{1, 2}));
  EXPECT_FALSE(Of(arena_.Eq(x_, Number(3))).Approach(at_, std::vector<size_t>{1}));
}

TEST_F(ConditionTest, GoesToTheNearestPointOfACircle) {
  Condition c = Of(arena_.Eq(arena_.Add(Square(x_), Square(y_)), Number(25)));
  at_ = {6, 8};
  ASSERT_TRUE(c.Approach(at_, both_));
  EXPECT_NEAR(at_[0], 3, 1e-6);
  EXPECT_NEAR(at_[1], 4, 1e-6);
}

TEST_F(ConditionTest, OfAlternativesTakesTheNearest) {
  Condition c = Of(arena_.Or(arena_.Le(x_, Number(-2)), arena_.Le(Number(10), x_)));
  at_ = {0, 0};
  ASSERT_TRUE(c.Approach(at_, both_));
  EXPECT_NEAR(at_[0], -2, 1e-7);
  at_ = {9, 0};
  ASSERT_TRUE(c.Approach(at_, both_));
  EXPECT_NEAR(at_[0], 10, 1e-7);
}

TEST_F(ConditionTest, SaysIfThereIsNothing) {
  Condition c = Of(arena_.And(arena_.Le(x_, Number(-2)), arena_.Le(Number(2), x_)));
  EXPECT_FALSE(c.Approach(at_, both_));
}

}  // namespace
}  // namespace rondo::sim::motions
