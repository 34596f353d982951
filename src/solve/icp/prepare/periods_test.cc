#include "solve/icp/prepare/periods.h"

#include <gtest/gtest.h>

#include <numbers>

namespace rondo::solve::icp {
namespace {

using expr::Elementary;

class Periods : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  TermId Cos(TermId t) { return arena_.Apply(Elementary::kCos, {t}); }
  TermId Sin(TermId t) { return arena_.Apply(Elementary::kSin, {t}); }
  TermId Times(const char* factor, TermId t) { return arena_.Mul(Number(factor), t); }
  // The period in turns.
  double Turns(const std::vector<TermId>& terms) {
    const auto period = PeriodOf(arena_, terms, x_);
    return period ? period->ToDouble() / (2 * std::numbers::pi) : -1;
  }
  // The range of x when sin x = y is prepared, with this range before.
  Range Bounded(const Range& before, Variable::Kind kind = Variable::Kind::kReal) {
    Prepared prepared;
    prepared.ranges[arena_.Sub(Sin(x_), y_)].Add(kEqual, 0);
    if (before.lo || before.hi || !before.excluded.empty()) prepared.ranges[x_] = before;
    BoundAngles(arena_, {{x_, {x_, kind}}, {y_, {y_, Variable::Kind::kReal}}}, prepared, nullptr);
    EXPECT_FALSE(prepared.ranges.contains(y_));
    return prepared.ranges[x_];
  }

  expr::Arena arena_;
  const TermId x_ = Variable("x"), y_ = Variable("y");
};

TEST_F(Periods, WavesHaveFullTurns) {
  EXPECT_NEAR(Turns({Sin(x_), Cos(arena_.Add(x_, y_))}), 1, 1e-9);
  EXPECT_GE(PeriodOf(arena_, {Sin(x_)}, x_)->ToDouble(), 2 * std::numbers::pi);
}

TEST_F(Periods, FractionsNeedMoreTurns) {
  EXPECT_NEAR(Turns({Sin(Times("1/3", x_))}), 3, 1e-8);
  EXPECT_NEAR(Turns({Sin(Times("1/2", x_)), Cos(Times("-5/3", x_))}), 6, 1e-8);
}

TEST_F(Periods, MultiplesNeedOneTurn) { EXPECT_NEAR(Turns({Sin(Times("7", x_))}), 1, 1e-9); }

TEST_F(Periods, TheRestMayBeAnything) {
  EXPECT_NEAR(Turns({arena_.Mul(y_, Sin(arena_.Add(Times("2", x_), arena_.Mul(y_, y_)))), y_}), 1, 1e-9);
}

TEST_F(Periods, VariablesOutsideOfWavesHaveNone) {
  for (const TermId t : {x_, arena_.Mul(x_, Sin(x_)), arena_.Add(Sin(x_), x_), Sin(arena_.Mul(x_, x_)),
                         Sin(arena_.Mul(x_, y_)), arena_.Apply(Elementary::kTan, {x_}),
                         Sin(arena_.Add(x_, Sin(x_))), arena_.Apply(Elementary::kExp, {x_})})
    EXPECT_EQ(Turns({Cos(x_), t}), -1);
}

TEST_F(Periods, FormulasCount) {
  EXPECT_NEAR(Turns({arena_.Or(arena_.Le(Sin(x_), y_), arena_.Le(Cos(x_), y_))}), 1, 1e-9);
  EXPECT_EQ(Turns({arena_.Or(arena_.Le(Sin(x_), y_), arena_.Le(x_, y_))}), -1);
}

TEST_F(Periods, UnboundedAnglesGetOneTurn) {
  const Range range = Bounded({});
  ASSERT_TRUE(range.lo && range.hi);
  EXPECT_GE((*range.hi - *range.lo).ToDouble(), 2 * std::numbers::pi);
  EXPECT_NEAR((*range.hi - *range.lo).ToDouble(), 2 * std::numbers::pi, 1e-9);
}

TEST_F(Periods, OneBoundIsKept) {
  Range low, high;
  low.Add(kGreater, 5);
  high.Add(kLess | kEqual, 5);
  const Range from = Bounded(low), to = Bounded(high);
  ASSERT_TRUE(from.lo && from.hi && to.lo && to.hi);
  EXPECT_EQ(*from.lo, Rational(5));
  EXPECT_TRUE(from.lo_strict);
  EXPECT_GE((*from.hi - *from.lo).ToDouble(), 2 * std::numbers::pi);
  EXPECT_EQ(*to.hi, Rational(5));
  EXPECT_GE((*to.hi - *to.lo).ToDouble(), 2 * std::numbers::pi);
}

TEST_F(Periods, BoundedAnglesStay) {
  Range range;
  range.Add(kGreater | kEqual, 0);
  range.Add(kLess | kEqual, 100);
  EXPECT_EQ(*Bounded(range).hi, Rational(100));
}

TEST_F(Periods, AnglesWithExcludedValuesStay) {
  Range range;
  range.Add(kLess | kGreater, 0);
  EXPECT_FALSE(Bounded(range).lo.has_value());
}

TEST_F(Periods, IntegersStay) { EXPECT_FALSE(Bounded({}, Variable::Kind::kInt).lo.has_value()); }

}  // namespace
}  // namespace rondo::solve::icp
