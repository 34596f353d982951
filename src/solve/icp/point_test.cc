#include "solve/icp/point.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expr/numeric.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;
using expr::Rational;
using expr::TermId;
using verdict::Truth;

class Points : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  TermId Call(Elementary f, TermId a) { return arena_.Apply(f, {a}); }
  TermId Sqrt(TermId a) { return Call(Elementary::kSqrt, a); }
  Truth Check(TermId formula) { return PointChecker(arena_, point_).Check(formula); }

  expr::Arena arena_;
  const TermId x_ = Variable("x"), y_ = Variable("y"), free_ = Variable("free");
  const Assignment point_{{x_, Rational(1) / Rational(3)}, {y_, Rational(-2)}};
};

TEST_F(Points, RationalNumbersAreComparedExactly) {
  EXPECT_EQ(Check(arena_.Eq(arena_.Mul(Number("3"), x_), Number("1"))), Truth::kTrue);
  EXPECT_EQ(Check(arena_.Lt(x_, Number("0.3333333333333333333333"))), Truth::kFalse);
  EXPECT_EQ(Check(arena_.Lt(Number("0.3333333333333333333333"), x_)), Truth::kTrue);
  EXPECT_EQ(Check(arena_.Eq(arena_.Divide(y_, x_), Number("-6"))), Truth::kTrue);
  EXPECT_EQ(Check(arena_.Le(arena_.Mul(y_, y_), Number("4"))), Truth::kTrue);
}

TEST_F(Points, IrrationalNumbersAreComparedByBounds) {
  const TermId root = Sqrt(arena_.Mul(y_, arena_.Neg(Number("1"))));
  EXPECT_EQ(Check(arena_.Lt(root, Number("1.4142135623731"))), Truth::kTrue);
  EXPECT_EQ(Check(arena_.Le(root, Number("1.414213562373"))), Truth::kFalse);
  EXPECT_EQ(Check(arena_.Eq(root, Number("1.5"))), Truth::kFalse);
  EXPECT_EQ(Check(arena_.Eq(arena_.Mul(root, root), arena_.Neg(y_))), Truth::kOpen);
}

TEST_F(Points, RootsOfSquaresAreExact) {
  PointChecker checker(arena_, point_);
  EXPECT_EQ(checker.Exact(Sqrt(arena_.Mul(y_, y_))), Rational(2));
  EXPECT_EQ(checker.Exact(Sqrt(arena_.Neg(y_))), std::nullopt);
}

TEST_F(Points, NothingIsKnownOfWhatIsUndefined) {
  for (const TermId t : {Sqrt(y_), Call(Elementary::kLog, y_), Call(Elementary::kAsin, y_),
                         Call(Elementary::kAcos, y_), arena_.Divide(x_, arena_.Add(y_, Number("2")))}) {
    EXPECT_EQ(Check(arena_.Le(t, Number("100"))), Truth::kOpen);
    EXPECT_EQ(Check(arena_.Not(arena_.Eq(t, Number("100")))), Truth::kOpen);
    EXPECT_TRUE(PointChecker(arena_, point_).Enclosure(t).IsEmpty());
  }
}

TEST_F(Points, VariablesWithoutAValueAreOpen) {
  EXPECT_EQ(Check(arena_.Le(free_, Number("1"))), Truth::kOpen);
  EXPECT_EQ(PointChecker(arena_, point_).Exact(free_), std::nullopt);
}

TEST_F(Points, WidenedVariablesHaveAllValues) {
  PointChecker checker(arena_, point_);
  checker.Widen(free_, {0, 1});
  EXPECT_EQ(checker.Check(arena_.Le(free_, Number("1"))), Truth::kTrue);
  EXPECT_EQ(checker.Check(arena_.Le(free_, Number("0.5"))), Truth::kOpen);
  EXPECT_EQ(checker.Check(arena_.Lt(Number("1"), free_)), Truth::kFalse);
  EXPECT_EQ(checker.Check(arena_.Eq(free_, Number("2"))), Truth::kFalse);
  EXPECT_EQ(checker.Check(arena_.Not(arena_.Eq(free_, Number("2")))), Truth::kTrue);
}

TEST_F(Points, WideningHidesTheValue) {
  PointChecker checker(arena_, point_);
  checker.Widen(x_, {0, 1});
  EXPECT_EQ(checker.Exact(x_), std::nullopt);
  EXPECT_EQ(checker.Check(arena_.Eq(x_, Number("1/3"))), Truth::kOpen);
}

TEST_F(Points, OnePartMayDecideAJunction) {
  const TermId open = arena_.Le(free_, Number("1")), yes = arena_.Lt(y_, x_), no = arena_.Lt(x_, y_);
  EXPECT_EQ(Check(arena_.Or(open, yes)), Truth::kTrue);
  EXPECT_EQ(Check(arena_.Or(open, no)), Truth::kOpen);
  EXPECT_EQ(Check(arena_.And(open, no)), Truth::kFalse);
  EXPECT_EQ(Check(arena_.And(open, yes)), Truth::kOpen);
}

TEST_F(Points, ChoicesNeedTheirConditions) {
  PointChecker checker(arena_, point_);
  EXPECT_EQ(checker.Exact(arena_.Ite(arena_.Lt(x_, y_), Sqrt(y_), Number("5"))), Rational(5));
  EXPECT_EQ(checker.Exact(arena_.Ite(arena_.Lt(free_, y_), x_, y_)), std::nullopt);
}

TEST_F(Points, EnclosuresHoldTheValue) {
  for (const TermId t :
       {Call(Elementary::kSin, y_), Call(Elementary::kCos, x_), Call(Elementary::kTan, x_),
        Call(Elementary::kAtan, y_), Call(Elementary::kExp, y_), Call(Elementary::kAsin, x_),
        Call(Elementary::kAcos, x_), Call(Elementary::kLog, x_), arena_.Apply(Elementary::kAtan2, {x_, y_}),
        arena_.Apply(Elementary::kMin, {Call(Elementary::kSin, x_), y_}),
        arena_.Apply(Elementary::kPower, {x_, Number("0.7")}), arena_.Mul(Call(Elementary::kSin, y_), x_)}) {
    const interval::Interval range = PointChecker(arena_, point_).Enclosure(t);
    const double value = expr::Numeric(arena_, {{x_, 1.0 / 3}, {y_, -2}})(t);
    EXPECT_NEAR(range.lo, value, 1e-12);
    EXPECT_NEAR(range.hi, value, 1e-12);
    EXPECT_LE(range.lo, range.hi);
  }
}

TEST_F(Points, FarAnglesAreBroughtNear) {
  for (const double far : {0x1p40, -0x1p40, 1e9}) {
    const Assignment point{{x_, Rational::FromDouble(far)}};
    const interval::Interval range = PointChecker(arena_, point).Enclosure(Call(Elementary::kSin, x_));
    EXPECT_LT(range.Width(), 1e-6);
    EXPECT_NEAR(range.Middle(), std::sin(far), 1e-6);
  }
}

}  // namespace
}  // namespace rondo::solve::icp
