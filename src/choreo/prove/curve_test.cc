#include "choreo/prove/curve.h"

#include <gtest/gtest.h>

#include "choreo/obligations/solve_for.h"
#include "choreo/prove/exact_point.h"
#include "choreo/prove/switches.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Elementary;
using expr::Rational;
using expr::TermId;

class Curves : public ::testing::Test {
 protected:
  TermId Number(const char* text) { return arena.Number(arena.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name) { return arena.Variable(arena.Declare(name, {}, arena.Real())); }
  TermId Sin(TermId t) { return arena.Apply(Elementary::kSin, {t}); }

  Arena arena;
  TermId clock = Variable("clock"), x = Variable("x"), y = Variable("y");
};

TEST_F(Curves, WhatIsConvexHoldsBetweenTwoMoments) {
  const TermId line = arena.Add(x, arena.Mul(y, clock));
  EXPECT_TRUE(HoldsBetween(arena, arena.Le(line, Number("1")), clock));
  EXPECT_TRUE(HoldsBetween(arena, arena.Le(Number("1"), line), clock));
  EXPECT_TRUE(HoldsBetween(arena, arena.Lt(arena.Mul(line, line), Number("1")), clock));
  EXPECT_TRUE(HoldsBetween(arena, arena.Eq(line, Number("1")), clock));
  EXPECT_TRUE(HoldsBetween(arena, arena.Le(arena.Apply(Elementary::kMax, {line, clock}), x), clock));
  // What is not: outside of a circle, above a maximum, an equation of squares, factors of unknown sign.
  EXPECT_FALSE(HoldsBetween(arena, arena.Le(Number("1"), arena.Mul(line, line)), clock));
  EXPECT_FALSE(HoldsBetween(arena, arena.Le(x, arena.Apply(Elementary::kMax, {line, clock})), clock));
  EXPECT_FALSE(HoldsBetween(arena, arena.Eq(arena.Mul(line, line), Number("1")), clock));
  EXPECT_FALSE(HoldsBetween(arena, arena.Le(arena.Mul(y, arena.Mul(line, line)), Number("1")), clock));
  EXPECT_FALSE(HoldsBetween(arena, arena.Le(Sin(clock), Number("1")), clock));
  EXPECT_FALSE(HoldsBetween(arena, arena.Or(arena.Le(clock, x), arena.Le(y, clock)), clock));
  EXPECT_FALSE(HoldsBetween(arena, arena.Le(arena.Sub(Number("0"), arena.Mul(clock, clock)), x), clock));
}

TEST_F(Curves, ContinuousTermsAreKnown) {
  const std::vector<TermId> changing{clock, x};
  EXPECT_TRUE(IsContinuous(arena, arena.Add(Sin(clock), arena.Mul(x, y)), changing));
  EXPECT_TRUE(IsContinuous(arena, arena.Apply(Elementary::kMin, {clock, x}), changing));
  EXPECT_TRUE(IsContinuous(arena, arena.Divide(x, y), changing));  // y does not change
  EXPECT_FALSE(IsContinuous(arena, arena.Divide(y, x), changing));
  EXPECT_FALSE(IsContinuous(arena, arena.Ite(arena.Lt(clock, y), x, y), changing));
  EXPECT_FALSE(IsContinuous(arena, arena.Apply(Elementary::kAtan2, {x, y}), changing));
  EXPECT_FALSE(IsContinuous(arena, arena.Apply(Elementary::kTan, {clock}), changing));
}

TEST_F(Curves, ChoicesOfTheClockAreMadeBetweenTheirMoments) {
  const TermId chosen = arena.Ite(arena.Lt(clock, Number("2")), x, y);
  Switches switches(arena, arena.Eq(x, chosen), clock);
  EXPECT_EQ(switches.Settled(chosen, Rational(0), Rational(2)), x);
  EXPECT_EQ(switches.Settled(chosen, Rational(2), std::nullopt), y);
  EXPECT_TRUE(switches.IsContinuousBetween(chosen, {clock, x, y}));
  const Curve curve = switches.Split({{Rational(0), Rational(4), {{x, chosen}}}});
  ASSERT_EQ(curve.size(), 2U);
  EXPECT_EQ(curve[0].to, Rational(2));
  EXPECT_EQ(curve[1].value.at(x), y);
  // Between moments that are not known, nothing is decided: at 1 it is chosen otherwise than at 3.
  const TermId hidden = arena.Ite(arena.Lt(arena.Mul(clock, clock), Number("4")), x, y);
  Switches none(arena, arena.Eq(x, hidden), clock);
  EXPECT_EQ(none.Settled(hidden, Rational(0), Rational(4)), hidden);
  EXPECT_FALSE(none.IsContinuousBetween(hidden, {clock, x, y}));
}

TEST_F(Curves, EquationsAreSolved) {
  EXPECT_EQ(SolveFor(arena, arena.Eq(x, Sin(y)), x), Sin(y));
  const auto half = SolveFor(arena, arena.Eq(arena.Add(arena.Mul(Number("2"), x), y), Number("3")), x);
  ASSERT_TRUE(half.has_value());
  EXPECT_EQ(arena.Sub(*half, arena.Sub(Number("1.5"), arena.Mul(Number("0.5"), y))), Number("0"));
  EXPECT_FALSE(SolveFor(arena, arena.Eq(arena.Mul(x, x), y), x).has_value());
  EXPECT_FALSE(SolveFor(arena, arena.Eq(arena.Mul(x, y), Number("1")), x).has_value());
  EXPECT_FALSE(SolveFor(arena, arena.Eq(x, Sin(x)), x).has_value());
}

TEST_F(Curves, TouchesHaveExactPoints) {
  // Two circles that touch at (1.234567, 0.2).
  const TermId dx = arena.Sub(x, Number("1.234567")), dy = arena.Sub(y, Number("0.3"));
  const auto squares = [&](TermId a, TermId b) { return arena.Add(arena.Mul(a, a), arena.Mul(b, b)); };
  const TermId touch =
      arena.And(arena.Le(squares(dx, y), Number("0.04")), arena.Le(squares(dx, dy), Number("0.01")));
  const auto point = ExactPoint(arena, touch, {{x, 1.234567 + 3e-6}, {y, 0.2 + 1e-9}});
  ASSERT_TRUE(point.has_value());
  EXPECT_DOUBLE_EQ(point->at(x), 1.234567);
  EXPECT_DOUBLE_EQ(point->at(y), 0.2);
  // Nothing is made up where they do not touch.
  const TermId apart =
      arena.And(arena.Le(squares(dx, y), Number("0.04")), arena.Le(squares(dx, dy), Number("0.0099")));
  EXPECT_FALSE(ExactPoint(arena, apart, {{x, 1.234567}, {y, 0.2}}).has_value());
}

}  // namespace
}  // namespace rondo::choreo
