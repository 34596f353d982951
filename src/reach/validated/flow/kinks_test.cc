#include "reach/validated/flow/kinks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reach/problem/bounds.h"
#include "reach/validated/flow/map.h"

namespace rondo::reach {
namespace {

class Kinks : public testing::Test {
 protected:
  TermId Num(const char* value) { return arena_.Number(arena_.Real(), *Rational::Parse(value)); }
  void Use(TermId function) {
    auto program = Compile(arena_, {x_, y_}, {function});
    ASSERT_TRUE(program.ok());
    program_ = std::move(program).value();
    ASSERT_FALSE(program_.kinks.empty());
  }
  Interval At(const Program& program, double x, double y) const {
    return ValuesOn(program, {Interval::Point(x), Interval::Point(y)})[program.outputs[0]];
  }

  expr::Arena arena_;
  const TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  const TermId y_ = arena_.Variable(arena_.Declare("y", {}, arena_.Real()));
  Program program_;
};

TEST_F(Kinks, ChordsHoldTheFunction) {
  std::mt19937_64 random(1);
  for (int k = 0; k < 2000; ++k) {
    const Interval x{-std::exp(std::uniform_real_distribution<double>(-20, 5)(random)),
                     std::exp(std::uniform_real_distribution<double>(-20, 5)(random))};
    const Chord max = ChordOfMax(x);
    const Chord abs = ChordOfAbs(x);
    for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0, -1.0}) {
      const double at = share < 0 ? 0 : x.lo + share * (x.hi - x.lo);
      if (!x.Contains(at)) continue;
      const auto on = [&](const Chord& c) {
        return Interval::Point(c.slope) * Interval::Point(at) + c.offset;
      };
      EXPECT_TRUE(on(max).Contains(std::fmax(at, 0))) << x.lo << " " << x.hi << " " << at;
      EXPECT_TRUE(on(abs).Contains(std::fabs(at))) << x.lo << " " << x.hi << " " << at;
    }
    // No more than it must be: half of the largest distance from the chord.
    EXPECT_LE(max.offset.Width(), -x.lo * x.hi / (x.hi - x.lo) + 1e-12 * (x.hi - x.lo));
  }
}

TEST_F(Kinks, WhatTakesTheirPlaceHoldsThem) {
  std::mt19937_64 random(2);
  for (const TermId function : {arena_.Apply(expr::Elementary::kMax, {x_, arena_.Mul(Num("3"), y_)}),
                                arena_.Apply(expr::Elementary::kAbs, {arena_.Sub(x_, y_)})}) {
    Use(function);
    const uint32_t kink = program_.kinks[0];
    const Program compared = ComparedAt(program_, kink);
    for (int k = 0; k < 2000; ++k) {
      const auto draw = [&] { return std::uniform_real_distribution<double>(-2, 2)(random); };
      const double x = draw();
      const double y = draw();
      const Interval argument = At(compared, x, y);
      const Interval around{argument.lo - std::fabs(draw()), argument.hi + std::fabs(draw())};
      Program replaced = program_;
      ReplaceKink(replaced, kink, around);
      EXPECT_TRUE(replaced.kinks.empty());
      const Interval exact = At(program_, x, y);
      const Interval held = At(replaced, x, y);
      EXPECT_TRUE(held.lo <= exact.hi && exact.lo <= held.hi) << x << " " << y;
    }
  }
}

// A set whose width are errors, which no bisection makes smaller: a clamp that touches it must not forget them.
TEST_F(Kinks, MapsKeepWhatErrorsHaveInCommon) {
  // y - max(x, -0.1) with x = y in [-1, 1] as errors: at most 0.1 + ... apart, not 1.
  Use(arena_.Sub(y_, arena_.Apply(expr::Elementary::kMax, {x_, Num("-0.9")})));
  auto monomials = std::make_shared<Monomials>(0);
  FlowSet set = FromBox({Interval::Point(0), Interval::Point(0)}, *monomials, {-1, -1});
  set.generators = Eigen::MatrixXd::Ones(2, 1);
  set.used = 1;
  Map map(program_, 2, {}, monomials);
  ASSERT_TRUE(map.Apply(set));
  const Interval range = map.Range(0);
  EXPECT_TRUE(range.Contains(Interval{-0.1, 0}));
  EXPECT_LT(range.Width(), 0.3);
}

}  // namespace
}  // namespace rondo::reach
