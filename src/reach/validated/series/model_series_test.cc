#include "reach/validated/series/model_series.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

namespace rondo::reach {
namespace {

using expr::Elementary;

long double Power(long double x, size_t k) { return std::pow(x, static_cast<long double>(k)); }

class ModelCoefficients : public testing::Test {
 protected:
  static constexpr size_t kOrders = 12;
  static constexpr size_t kDegree = 5;

  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Of(Elementary f, std::vector<TermId> args) { return arena_.Apply(f, std::move(args)); }
  void Use(const std::vector<TermId>& functions, size_t last = kOrders - 1) {
    auto program = Compile(arena_, {x_, y_}, functions);
    ASSERT_TRUE(program.ok());
    program_ = std::move(program).value();
    monomials_ = std::make_shared<Monomials>(2);
    series_.emplace(program_, monomials_, kOrders);
    series_->Begin(kDegree, last);
    branches_.assign(program_.code.size(), Branch::kEither);
    held_.assign(program_.code.size(), Interval());
  }
  // x = x0 + rx s0 and y = y0 + ry s1 at the start.
  void Start(double x0, double rx, double y0, double ry) {
    series_->SetVariable(0, 0, std::vector<double>{x0, rx, 0}, 0);
    series_->SetVariable(1, 0, std::vector<double>{y0, 0, ry}, 0);
    start_ = {x0, rx, y0, ry};
  }
  void Solve() {
    for (size_t k = 0; k + 1 < kOrders; ++k) {
      ASSERT_TRUE(series_->Compute(k, branches_, held_));
      series_->SetFromDerivative(0, 0, k);
      series_->SetFromDerivative(1, 1, k);
    }
  }
  // x grows by one a second, y stays.
  bool AlongX() {
    for (size_t k = 0; k < kOrders; ++k) {
      const double one = 1;
      if (k > 0) {
        series_->SetVariable(0, k, std::span(&one, k == 1 ? 1U : 0U), 0);
        series_->SetVariable(1, k, {}, 0);
      }
      if (!series_->Compute(k, branches_, held_)) return false;
    }
    return true;
  }
  long double ValueAt(ModelView model, double s0, double s1) const {
    long double sum = 0;
    for (size_t m = 0; m < model.polynomial.size(); ++m) {
      const auto e = monomials_->Exponents(m);
      sum += model.polynomial[m] * Power(s0, e[0]) * Power(s1, e[1]);
    }
    return sum;
  }
  // `exact`: what coefficient k of the node is for the start (x, y).
  void ExpectHolds(size_t node, size_t k, const std::function<long double(long double, long double)>& exact) {
    std::mt19937_64 random(k + 1);
    for (int sample = 0; sample < 25; ++sample) {
      const double s0 = std::uniform_real_distribution<double>(-1, 1)(random);
      const double s1 = std::uniform_real_distribution<double>(-1, 1)(random);
      const long double x = start_[0] + static_cast<long double>(start_[1]) * s0;
      const long double y = start_[2] + static_cast<long double>(start_[3]) * s1;
      const ModelView model = series_->At(node, k);
      const long double value = exact(x, y);
      EXPECT_LE(std::fabs(ValueAt(model, s0, s1) - value), model.radius + 1e-17L * (1 + std::fabs(value)))
          << "order " << k;
      EXPECT_LE(series_->Range(node, k).lo, value + 1e-17L);
      EXPECT_GE(series_->Range(node, k).hi, value - 1e-17L);
    }
  }

  expr::Arena arena_;
  TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  TermId y_ = arena_.Variable(arena_.Declare("y", {}, arena_.Real()));
  Program program_;
  std::shared_ptr<Monomials> monomials_;
  std::optional<ModelSeries> series_;
  std::vector<Branch> branches_;
  std::vector<Interval> held_;
  std::array<double, 4> start_{};
};

TEST_F(ModelCoefficients, OfTheHarmonicOscillatorTurnEveryStart) {
  Use({y_, arena_.Neg(x_)});
  Start(1, 0.25, 0.5, 0.125);
  Solve();
  long double factorial = 1;
  for (size_t k = 0; k < kOrders; ++k) {
    if (k > 0) factorial *= static_cast<long double>(k);
    // x = x0 cos t + y0 sin t
    ExpectHolds(program_.variable_nodes[0], k, [&](long double x, long double y) {
      const long double sign = k % 4 < 2 ? 1 : -1;
      return sign * (k % 2 == 0 ? x : y) / factorial;
    });
  }
}

TEST_F(ModelCoefficients, OfTheLogisticEquationDependOnTheStart) {
  Use({arena_.Mul(x_, arena_.Sub(Num("1"), x_)), Num("0")});
  Start(0.375, 0.125, 0, 0);
  Solve();
  const size_t node = program_.variable_nodes[0];
  ExpectHolds(node, 1, [](long double x, long double) { return x * (1 - x); });
  ExpectHolds(node, 2, [](long double x, long double) { return x * (1 - x) * (1 - 2 * x) / 2; });
  ExpectHolds(node, 3, [](long double x, long double) { return x * (1 - x) * (1 - 6 * x + 6 * x * x) / 6; });
}

TEST_F(ModelCoefficients, OfAQuadraticBlowUpArePowersOfTheStart) {
  // x' = x^2: x = x0 / (1 - x0 t), whose coefficients have a degree of k + 1.
  Use({arena_.Mul(x_, x_), Num("0")});
  Start(0.75, 0.25, 0, 0);
  Solve();
  for (size_t k = 0; k < kOrders; ++k)
    ExpectHolds(program_.variable_nodes[0], k, [&](long double x, long double) { return Power(x, k + 1); });
}

TEST_F(ModelCoefficients, OfProductsHoldTheTruncatedTerms) {
  Use({arena_.Mul(arena_.Mul(arena_.Mul(x_, x_), arena_.Mul(x_, y_)), arena_.Mul(y_, y_))});
  Start(0.5, 0.5, 0.25, 1);
  ASSERT_TRUE(AlongX());
  ExpectHolds(program_.outputs[0], 0, [](long double x, long double y) { return x * x * x * y * y * y; });
  ExpectHolds(program_.outputs[0], 1, [](long double x, long double y) { return 3 * x * x * y * y * y; });
  EXPECT_GT(series_->At(program_.outputs[0], 0).radius, 1e-3);
}

TEST_F(ModelCoefficients, OfExponentialsAreEnclosed) {
  Use({Of(Elementary::kExp, {x_})});
  Start(0.5, 0.25, 0, 0);
  ASSERT_TRUE(AlongX());
  for (size_t k = 0; k < kOrders; ++k)
    ExpectHolds(program_.outputs[0], k, [&](long double x, long double) {
      return std::exp(x) / std::tgamma(static_cast<long double>(k) + 1);
    });
}

TEST_F(ModelCoefficients, OfSinesAndCosinesAreEnclosed) {
  Use({Of(Elementary::kSin, {x_}), Of(Elementary::kCos, {x_})});
  Start(2, 0.25, 0, 0);
  ASSERT_TRUE(AlongX());
  for (size_t k = 0; k < kOrders; ++k) {
    for (const size_t output : {0, 1}) {
      ExpectHolds(program_.outputs[output], k, [&](long double x, long double) {
        const long double cycle[] = {std::sin(x), std::cos(x), -std::sin(x), -std::cos(x)};
        return cycle[(k + output) % 4] / std::tgamma(static_cast<long double>(k) + 1);
      });
    }
  }
}

TEST_F(ModelCoefficients, OfReciprocalsAreEnclosed) {
  Use({arena_.Divide(Num("1"), x_)});
  Start(-2, 0.25, 0, 0);
  ASSERT_TRUE(AlongX());
  for (size_t k = 0; k < kOrders; ++k)
    ExpectHolds(program_.outputs[0], k,
                [&](long double x, long double) { return (k % 2 == 0 ? 1 : -1) / Power(x, k + 1); });
}

TEST_F(ModelCoefficients, OfRootsAreEnclosed) {
  Use({Of(Elementary::kSqrt, {x_})});
  Start(4, 0.5, 0, 0);
  ASSERT_TRUE(AlongX());
  long double binomial = 1;
  for (size_t k = 0; k < kOrders; ++k) {
    ExpectHolds(program_.outputs[0], k,
                [&](long double x, long double) { return binomial * std::sqrt(x) / Power(x, k); });
    binomial *= (0.5L - static_cast<long double>(k)) / static_cast<long double>(k + 1);
  }
}

TEST_F(ModelCoefficients, OfLogarithmsAreEnclosed) {
  Use({Of(Elementary::kLog, {x_})});
  Start(2, 0.25, 0, 0);
  ASSERT_TRUE(AlongX());
  ExpectHolds(program_.outputs[0], 0, [](long double x, long double) { return std::log(x); });
  for (size_t k = 1; k < kOrders; ++k)
    ExpectHolds(program_.outputs[0], k, [&](long double x, long double) {
      return (k % 2 == 1 ? 1 : -1) / (static_cast<long double>(k) * Power(x, k));
    });
}

// Both ways to write the angle of (1, x).
TEST_F(ModelCoefficients, OfArctangentsAreEnclosed) {
  Use({Of(Elementary::kAtan, {x_}), Of(Elementary::kAtan2, {x_, y_})});
  Start(0.75, 0.25, 1, 0);
  ASSERT_TRUE(AlongX());
  for (const size_t output : {0, 1}) {
    ExpectHolds(program_.outputs[output], 0, [](long double x, long double) { return std::atan(x); });
    for (size_t k = 1; k < kOrders; ++k)
      ExpectHolds(program_.outputs[output], k, [&](long double x, long double) {
        const auto n = static_cast<long double>(k);
        return Power(std::cos(std::atan(x)), k) * std::sin(n * (std::atan(x) + std::acos(-1.0L) / 2)) / n;
      });
  }
}

TEST_F(ModelCoefficients, OfAnAngleFollowBothCoordinates) {
  Use({Of(Elementary::kAtan2, {y_, x_})}, 0);
  Start(-1, 0.25, 0.75, 0.25);
  ASSERT_TRUE(series_->Compute(0, branches_, held_));
  ExpectHolds(program_.outputs[0], 0, [](long double x, long double y) { return std::atan2(y, x); });
}

TEST_F(ModelCoefficients, AreNotThereOutsideTheDomain) {
  Use({Of(Elementary::kLog, {x_}), arena_.Divide(Num("1"), y_)}, 0);
  Start(0.5, 1, 3, 1);
  EXPECT_FALSE(series_->Compute(0, branches_, held_));
  Start(3, 1, 0.5, 1);
  EXPECT_FALSE(series_->Compute(0, branches_, held_));
  Start(3, 1, 3, 1);
  EXPECT_TRUE(series_->Compute(0, branches_, held_));
}

TEST_F(ModelCoefficients, OfMapsHoldBothValuesOfAChoice) {
  Use({arena_.Ite(arena_.Le(x_, y_), arena_.Mul(x_, x_), y_)}, 0);
  Start(0.25, 1, 0.125, 0.5);
  ASSERT_TRUE(series_->Compute(0, branches_, held_));
  ExpectHolds(program_.outputs[0], 0, [](long double x, long double y) { return x <= y ? x * x : y; });
}

TEST_F(ModelCoefficients, OfAKinkFollowItsBranch) {
  Use({Of(Elementary::kAbs, {x_})});
  Start(-2, 0.5, 0, 0);
  branches_[program_.outputs[0]] = Branch::kSecond;
  ASSERT_TRUE(AlongX());
  ExpectHolds(program_.outputs[0], 0, [](long double x, long double) { return -x; });
  ExpectHolds(program_.outputs[0], 1, [](long double, long double) { return -1; });
}

TEST_F(ModelCoefficients, CarryTheRadiusOfTheStart) {
  Use({arena_.Mul(x_, x_)}, 0);
  Start(1, 0.5, 0, 0);
  series_->SetVariable(0, 0, std::vector<double>{1, 0.5, 0}, 0.125);
  ASSERT_TRUE(series_->Compute(0, branches_, held_));
  // At s = 1 the argument reaches 1.625.
  EXPECT_GE(ValueAt(series_->At(program_.outputs[0], 0), 1, 0) + series_->At(program_.outputs[0], 0).radius,
            1.625 * 1.625);
}

TEST_F(ModelCoefficients, AreForgottenAtANewBeginning) {
  Use({arena_.Mul(x_, x_)});
  Start(1, 0.5, 0, 0);
  ASSERT_TRUE(AlongX());
  series_->Begin(2, 3);
  EXPECT_EQ(series_->degree(), 2u);
  EXPECT_EQ(series_->count(), monomials_->Count(2));
  Start(2, 0.25, 0, 0);
  ASSERT_TRUE(series_->Compute(0, branches_, held_));
  ExpectHolds(program_.outputs[0], 0, [](long double x, long double) { return x * x; });
}

}  // namespace
}  // namespace rondo::reach
