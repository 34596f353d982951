#include "expr/rational.h"

#include <gtest/gtest.h>

namespace rondo::expr {
namespace {

TEST(Rational, ParsesEveryForm) {
  EXPECT_EQ(Rational::Parse("12")->ToString(), "12");
  EXPECT_EQ(Rational::Parse("1.50")->ToString(), "1.5");
  EXPECT_EQ(Rational::Parse(".5")->ToString(), "0.5");
  EXPECT_EQ(Rational::Parse("5.")->ToString(), "5");
  EXPECT_EQ(Rational::Parse("1e-3")->ToString(), "0.001");
  EXPECT_EQ(Rational::Parse("25e2")->ToString(), "2500");
  EXPECT_EQ(Rational::Parse("-2/6")->ToString(), "-1/3");
  EXPECT_EQ(Rational::Parse("-0.25")->ToString(), "-0.25");
}

TEST(Rational, RejectsTheRest) {
  for (const char* text :
       {"", "-", ".", "1..2", "1e", "1e+", "1e401", "1/0", "1/", "1.5/2", "x", "1 ", "0x1"}) {
    EXPECT_FALSE(Rational::Parse(text).has_value()) << text;
  }
}

TEST(Rational, IsExact) {
  const Rational tenth = *Rational::Parse("0.1");
  Rational sum;
  for (int i = 0; i < 10; ++i) sum = sum + tenth;
  EXPECT_EQ(sum, Rational(1));
}

TEST(Rational, EuclideanQuotientLeavesANonNegativeRemainder) {
  for (int a = -7; a <= 7; ++a) {
    for (const int b : {-3, -2, 2, 3}) {
      const Rational q = EuclideanQuotient(Rational(a), Rational(b));
      const Rational r = Rational(a) - Rational(b) * q;
      EXPECT_GE(r, Rational(0)) << a << " " << b;
      EXPECT_LT(r, Rational(std::abs(b))) << a << " " << b;
    }
  }
}

}  // namespace
}  // namespace rondo::expr
