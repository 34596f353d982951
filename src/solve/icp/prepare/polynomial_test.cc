#include "solve/icp/prepare/polynomial.h"

#include <gtest/gtest.h>

#include "expr/evaluate.h"
#include "expr/substitute.h"

namespace rondo::solve::icp {
namespace {

using expr::Rational;
using expr::TermId;

class Polynomials : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Times(const char* factor, TermId t) { return arena_.Mul(Number(factor), t); }
  TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  Rational At(TermId t, int x, int y) {
    const auto value = [&](TermId v) {
      return expr::Value{v == x_ ? Rational(x) : v == y_ ? Rational(y) / Rational(3) : Rational(7)};
    };
    return expr::Evaluate(arena_, t, value)->AsNumber();
  }
  void ExpectEqual(TermId a, TermId b) {
    for (int x = -3; x <= 3; ++x) {
      for (int y = -3; y <= 3; ++y) EXPECT_EQ(At(a, x, y), At(b, x, y)) << x << " " << y;
    }
  }
  // How many distinct terms have `t` as an argument.
  size_t Uses(TermId whole, TermId t) {
    size_t uses = 0;
    std::unordered_set<TermId> seen;
    expr::VisitPostorder(arena_, whole, seen, [&](TermId part) {
      const auto args = arena_.args(part);
      uses += std::find(args.begin(), args.end(), t) != args.end() ? 1 : 0;
    });
    return uses;
  }

  expr::Arena arena_;
  const TermId x_ = Variable("x"), y_ = Variable("y"), z_ = Variable("z");
  const TermId xx_ = arena_.Mul(x_, x_), yy_ = arena_.Mul(y_, y_), xy_ = arena_.Mul(x_, y_);
};

TEST_F(Polynomials, MonicIsANumberTimesATerm) {
  for (const TermId t : {x_, Times("3", x_), arena_.Add(Times("-2", x_), Times("5", y_)),
                         arena_.Add({Number("4"), Times("1/2", xy_), y_})}) {
    const auto [factor, rest] = Monic(arena_, t);
    ExpectEqual(t, arena_.Mul(arena_.Number(arena_.Real(), factor), rest));
  }
}

TEST_F(Polynomials, MonicSumsAreEqualWhateverTheirScale) {
  const TermId sum = arena_.Add({Number("4"), Times("-2", x_), y_});
  EXPECT_EQ(Monic(arena_, sum).second, Monic(arena_, Times("-7/3", sum)).second);
}

TEST_F(Polynomials, CondensedTermsAreEqual) {
  const TermId s = arena_.Add(x_, Times("2", y_));
  for (const TermId t :
       {arena_.Add({xx_, Times("4", x_), y_, Number("1")}), arena_.Add({Times("2", xx_), xy_, yy_, x_}),
        arena_.Add({Times("-3", xx_), Times("6", xy_), Times("-3", yy_)}),
        arena_.Add({xy_, x_, y_, Number("2")}), arena_.Add(arena_.Mul(s, xx_), arena_.Mul(s, yy_)),
        arena_.Add({arena_.Mul(s, arena_.Mul(x_, yy_)), arena_.Mul(s, Number("3")), xx_}),
        arena_.Add({arena_.Mul(xx_, x_), Times("3", xx_), Times("3", x_), yy_}),
        arena_.Add({Times("-1/4", yy_), Times("2", y_), arena_.Mul(z_, x_)})})
    ExpectEqual(t, Condense(arena_, t));
}

TEST_F(Polynomials, CompletedSquaresUseAVariableOnce) {
  const TermId t = arena_.Add({Times("2", xx_), Times("-12", x_), y_});
  EXPECT_GT(Uses(t, x_), 1u);
  EXPECT_EQ(Uses(Condense(arena_, t), x_), 1u);
}

TEST_F(Polynomials, SquaresOfSumsAreFound) {
  const TermId t = arena_.Add({xx_, Times("2", xy_), yy_});
  const TermId sum = arena_.Add(x_, y_);
  EXPECT_EQ(Condense(arena_, t), arena_.Mul(sum, sum));
}

TEST_F(Polynomials, CommonFactorsBecomeSquares) {
  // s xy + s z z = s^2 for s = xy + z z
  const TermId zz = arena_.Mul(z_, z_), s = arena_.Add(xy_, zz);
  EXPECT_EQ(Condense(arena_, arena_.Add(arena_.Mul(s, xy_), arena_.Mul(s, zz))), arena_.Mul(s, s));
}

TEST_F(Polynomials, WithoutSquaresNothingIsTornApart) {
  const TermId t = arena_.Add({xy_, y_, Number("1")});
  EXPECT_EQ(Condense(arena_, t), t);
}

TEST_F(Polynomials, WhatIsNoSumStays) {
  for (const TermId t : {x_, xx_, xy_, Number("3")}) EXPECT_EQ(Condense(arena_, t), t);
}

}  // namespace
}  // namespace rondo::solve::icp
