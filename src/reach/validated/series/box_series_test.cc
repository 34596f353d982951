#include "reach/validated/series/box_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace rondo::reach {
namespace {

using expr::Elementary;

class BoxCoefficients : public testing::Test {
 protected:
  static constexpr size_t kOrders = 6;

  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Of(Elementary f, std::vector<TermId> args) { return arena_.Apply(f, std::move(args)); }
  void Use(const std::vector<TermId>& functions) {
    auto program = Compile(arena_, {x_, y_}, functions);
    ASSERT_TRUE(program.ok());
    program_ = std::move(program).value();
    series_.emplace(program_, kOrders);
    branches_.assign(program_.code.size(), Branch::kEither);
    held_.assign(program_.code.size(), Interval());
  }
  // Solves x' = first output, y' = second one.
  void Solve(Interval x, Interval y) {
    series_->SetVariable(0, 0, x);
    series_->SetVariable(1, 0, y);
    for (size_t k = 0; k + 1 < kOrders; ++k) {
      ASSERT_TRUE(series_->Compute(k, branches_, held_));
      series_->SetFromDerivative(0, 0, k);
      series_->SetFromDerivative(1, 1, k);
    }
  }
  // The variables are straight lines: x = x0 + t, y = y0.
  bool AlongX(Interval x, Interval y) {
    for (size_t k = 0; k < kOrders; ++k) {
      series_->SetVariable(0, k, k == 0 ? x : Interval::Point(k == 1 ? 1 : 0));
      series_->SetVariable(1, k, k == 0 ? y : Interval::Point(0));
      if (!series_->Compute(k, branches_, held_)) return false;
    }
    return true;
  }
  Interval StateAt(size_t variable, size_t k) const {
    return series_->Of(program_.variable_nodes[variable], k);
  }
  Interval OutputAt(size_t output, size_t k) const { return series_->Of(program_.outputs[output], k); }

  expr::Arena arena_;
  TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  TermId y_ = arena_.Variable(arena_.Declare("y", {}, arena_.Real()));
  Program program_;
  std::optional<BoxSeries> series_;
  std::vector<Branch> branches_;
  std::vector<Interval> held_;
};

void ExpectHolds(Interval enclosure, double exact) {
  const double noise = 1e-15 * (1 + std::fabs(exact));
  EXPECT_LE(enclosure.lo, exact + noise);
  EXPECT_GE(enclosure.hi, exact - noise);
}

TEST_F(BoxCoefficients, OfTheHarmonicOscillatorAreThoseOfSineAndCosine) {
  Use({y_, arena_.Neg(x_)});
  Solve(Interval::Point(1), Interval::Point(0));
  const double cosine[] = {1, 0, -1.0 / 2, 0, 1.0 / 24, 0};
  const double sine[] = {0, -1, 0, 1.0 / 6, 0, -1.0 / 120};
  for (size_t k = 0; k < kOrders; ++k) {
    ExpectHolds(StateAt(0, k), cosine[k]);
    ExpectHolds(StateAt(1, k), sine[k]);
    EXPECT_LT(StateAt(0, k).Width(), 1e-14);
  }
}

TEST_F(BoxCoefficients, OfTheLogisticEquationAreThoseOfItsSolution) {
  Use({arena_.Mul(x_, arena_.Sub(Num("1"), x_)), Num("0")});
  Solve(Interval::Point(0.5), Interval::Point(0));
  // 1 / (1 + exp(-t)) = 1/2 + t/4 - t^3/48 + t^5/480 - ...
  const double exact[] = {0.5, 0.25, 0, -1.0 / 48, 0, 1.0 / 480};
  for (size_t k = 0; k < kOrders; ++k) {
    ExpectHolds(StateAt(0, k), exact[k]);
    EXPECT_LT(StateAt(0, k).Width(), 1e-14);
  }
}

TEST_F(BoxCoefficients, EncloseThoseOfEveryStartInTheBox) {
  Use({arena_.Mul(x_, arena_.Sub(Num("1"), x_)), arena_.Neg(y_)});
  Solve({0.3, 0.4}, {1, 2});
  std::mt19937_64 random(2);
  for (int sample = 0; sample < 50; ++sample) {
    const double x = std::uniform_real_distribution<double>(0.3, 0.4)(random);
    const double y = std::uniform_real_distribution<double>(1, 2)(random);
    const double slope = x * (1 - x);
    ExpectHolds(StateAt(0, 1), slope);
    ExpectHolds(StateAt(0, 2), slope * (1 - 2 * x) / 2);
    ExpectHolds(StateAt(0, 3), slope * (1 - 6 * x + 6 * x * x) / 6);
    ExpectHolds(StateAt(1, 4), y / 24);
  }
}

TEST_F(BoxCoefficients, OfRootsAndReciprocalsAreBinomial) {
  Use({Of(Elementary::kSqrt, {x_}), arena_.Divide(Num("1"), x_)});
  ASSERT_TRUE(AlongX(Interval::Point(1), Interval::Point(0)));
  const double root[] = {1, 0.5, -0.125, 0.0625, -5.0 / 128, 7.0 / 256};
  for (size_t k = 0; k < kOrders; ++k) {
    ExpectHolds(OutputAt(0, k), root[k]);
    ExpectHolds(OutputAt(1, k), k % 2 == 0 ? 1 : -1);
  }
}

TEST_F(BoxCoefficients, OfLogarithmsAndArctangentsAreTheirSeries) {
  Use({Of(Elementary::kLog, {x_}), Of(Elementary::kAtan, {x_}), Of(Elementary::kAtan2, {x_, y_})});
  ASSERT_TRUE(AlongX(Interval::Point(1), Interval::Point(1)));
  const double log[] = {0, 1, -0.5, 1.0 / 3, -0.25, 0.2};
  const double atan[] = {std::atan(1.0), 0.5, -0.25, 1.0 / 12, 0, -1.0 / 40};
  for (size_t k = 0; k < kOrders; ++k) {
    ExpectHolds(OutputAt(0, k), log[k]);
    ExpectHolds(OutputAt(1, k), atan[k]);
    ExpectHolds(OutputAt(2, k), atan[k]);
  }
}

TEST_F(BoxCoefficients, OfExponentialsOfSinesAreTheirSeries) {
  Use({Of(Elementary::kExp, {Of(Elementary::kSin, {x_})}), Of(Elementary::kCos, {x_})});
  ASSERT_TRUE(AlongX(Interval::Point(0), Interval::Point(0)));
  // exp(sin t) = 1 + t + t^2/2 - t^4/8 - t^5/15 + ...
  const double exact[] = {1, 1, 0.5, 0, -0.125, -1.0 / 15};
  for (size_t k = 0; k < kOrders; ++k) ExpectHolds(OutputAt(0, k), exact[k]);
  ExpectHolds(OutputAt(1, 4), 1.0 / 24);
}

TEST_F(BoxCoefficients, AreNotThereOutsideTheDomain) {
  Use({arena_.Divide(Num("1"), x_), Of(Elementary::kSqrt, {y_})});
  EXPECT_FALSE(AlongX({-1, 1}, {1, 2}));
  EXPECT_FALSE(AlongX({1, 2}, {-1, 1}));
  EXPECT_TRUE(AlongX({1, 2}, {1, 2}));
}

TEST_F(BoxCoefficients, OfAnAngleAreNotThereWhereItJumps) {
  Use({Of(Elementary::kAtan2, {y_, x_})});
  EXPECT_FALSE(AlongX({-2, -1}, {-1, 1}));
  EXPECT_TRUE(AlongX({-2, -1}, {0.5, 1}));
}

TEST_F(BoxCoefficients, TellTheBranchWhereThereIsOne) {
  Use({Of(Elementary::kAbs, {x_}), Of(Elementary::kMax, {x_, y_})});
  const auto branches = [&](Interval x, Interval y) {
    series_->SetVariable(0, 0, x);
    series_->SetVariable(1, 0, y);
    EXPECT_TRUE(series_->Decide(branches_, held_));
    return std::pair(branches_[program_.outputs[0]], branches_[program_.outputs[1]]);
  };
  EXPECT_EQ(branches({1, 2}, {-1, 0}), std::pair(Branch::kFirst, Branch::kFirst));
  EXPECT_EQ(branches({-2, -1}, {-1, 0}), std::pair(Branch::kSecond, Branch::kSecond));
  EXPECT_EQ(branches({-1, 1}, {0, 2}), std::pair(Branch::kEither, Branch::kEither));
}

TEST_F(BoxCoefficients, HoldWhatAKinkCanBe) {
  Use({Of(Elementary::kAbs, {x_}), Of(Elementary::kMax, {x_, y_}),
       arena_.Ite(arena_.Le(x_, y_), Num("5"), Num("7"))});
  series_->SetVariable(0, 0, {-1, 3});
  series_->SetVariable(1, 0, {0, 2});
  ASSERT_TRUE(series_->Decide(branches_, held_));
  EXPECT_EQ(held_[program_.outputs[0]], (Interval{0, 3}));
  EXPECT_EQ(held_[program_.outputs[1]], (Interval{0, 3}));
  EXPECT_EQ(held_[program_.outputs[2]], (Interval{5, 7}));
}

TEST_F(BoxCoefficients, OfAKinkThatIsHeldAreConstant) {
  Use({Of(Elementary::kAbs, {x_}), Num("0")});
  held_[program_.outputs[0]] = {0, 1};
  ASSERT_TRUE(AlongX({-1, 1}, Interval::Point(0)));
  EXPECT_EQ(OutputAt(0, 0), (Interval{0, 1}));
  EXPECT_EQ(OutputAt(0, 1), Interval::Point(0));
}

TEST_F(BoxCoefficients, GradientsEncloseTheDerivatives) {
  Use({arena_.Mul(x_, Of(Elementary::kSin, {y_})), Of(Elementary::kSqrt, {arena_.Add(x_, y_)}),
       Of(Elementary::kAtan2, {y_, x_}), arena_.Divide(Of(Elementary::kExp, {y_}), x_),
       Of(Elementary::kLog, {arena_.Mul(x_, x_)}), Of(Elementary::kCos, {x_})});
  ASSERT_TRUE(AlongX({1, 1.2}, {0.4, 0.7}));
  std::vector<Interval> gradient;
  series_->Gradient(program_.outputs, branches_, {}, false, gradient);
  std::mt19937_64 random(3);
  for (int sample = 0; sample < 40; ++sample) {
    const double x = std::uniform_real_distribution<double>(1, 1.2)(random);
    const double y = std::uniform_real_distribution<double>(0.4, 0.7)(random);
    const double r = x * x + y * y;
    const double root = 0.5 / std::sqrt(x + y);
    const double exact[] = {
        std::sin(y),     x * std::cos(y), root, root,         -y / r, x / r, -std::exp(y) / (x * x),
        std::exp(y) / x, 2 / x,           0,    -std::sin(x), 0};
    for (size_t i = 0; i < std::size(exact); ++i) ExpectHolds(gradient[i], exact[i]);
  }
}

TEST_F(BoxCoefficients, GradientsOfOpenKinksHoldBothSlopes) {
  Use({Of(Elementary::kAbs, {x_}), Of(Elementary::kMax, {x_, arena_.Mul(Num("3"), y_)})});
  series_->SetVariable(0, 0, {-1, 1});
  series_->SetVariable(1, 0, {-1, 1});
  ASSERT_TRUE(series_->Decide(branches_, held_));
  std::vector<Interval> gradient;
  series_->Gradient(program_.outputs, branches_, {}, true, gradient);
  EXPECT_TRUE(gradient[0].Contains(Interval{-1, 1}));
  EXPECT_TRUE(gradient[2].Contains(Interval{0, 1}));
  EXPECT_TRUE(gradient[3].Contains(Interval{0, 3}));
}

TEST_F(BoxCoefficients, GradientsByHeldKinksHaveAColumnOfTheirOwn) {
  Use({arena_.Add(arena_.Mul(Num("2"), Of(Elementary::kAbs, {x_})), y_), Num("0")});
  const std::vector<uint32_t> sources = program_.kinks;
  ASSERT_EQ(sources.size(), 1u);
  held_[sources[0]] = {0, 1};
  ASSERT_TRUE(AlongX({-1, 1}, {0, 1}));
  std::vector<Interval> gradient;
  series_->Gradient(program_.outputs, branches_, sources, false, gradient);
  EXPECT_EQ(gradient[0], Interval::Point(0));
  ExpectHolds(gradient[1], 1);
  ExpectHolds(gradient[2], 2);
  EXPECT_LT(gradient[2].Width(), 1e-14);
}

}  // namespace
}  // namespace rondo::reach
