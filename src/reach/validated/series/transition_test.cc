#include "reach/validated/series/transition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace rondo::reach {
namespace {

Interval At(double x) { return Interval::Point(x); }

Transition After(const std::vector<Interval>& rates, size_t n, double h) {
  Transition t;
  Propagate(rates, n, h, t);
  return t;
}

void ExpectHolds(const Transition& t, Eigen::Index i, Eigen::Index j, double exact) {
  const double noise = 4e-16 * (1 + std::fabs(exact));
  EXPECT_LE(std::fabs(t.centre(i, j) - exact), t.radius(i, j) + noise) << i << " " << j;
}

TEST(TransitionMatrix, OfNoRatesIsTheIdentity) {
  const Transition t = After(std::vector<Interval>(4, At(0)), 2, 3.0);
  for (Eigen::Index i = 0; i < 2; ++i) {
    for (Eigen::Index j = 0; j < 2; ++j) {
      ExpectHolds(t, i, j, i == j ? 1 : 0);
      EXPECT_LT(t.radius(i, j), 1e-14);
    }
  }
}

TEST(TransitionMatrix, OfADoubleIntegratorIsASheer) {
  const Transition t = After({At(0), At(1), At(0), At(0)}, 2, 2.5);
  ExpectHolds(t, 0, 0, 1);
  ExpectHolds(t, 0, 1, 2.5);
  ExpectHolds(t, 1, 0, 0);
  ExpectHolds(t, 1, 1, 1);
  EXPECT_LT(t.radius.maxCoeff(), 1e-11);
}

TEST(TransitionMatrix, OfALongTimeIsStillEnclosed) {
  const Transition t = After({At(0), At(-1), At(1), At(0)}, 2, 20.0);
  ExpectHolds(t, 0, 0, std::cos(20.0));
  ExpectHolds(t, 0, 1, -std::sin(20.0));
  EXPECT_LT(t.radius.maxCoeff(), 1e-5);
}

// A constant rate is one of those that are possible.
TEST(TransitionMatrix, EnclosesEveryOscillator) {
  const double h = 0.7;
  const Transition t = After({At(0), At(1), Interval{-4, -1}, At(0)}, 2, h);
  std::mt19937_64 random(3);
  for (int sample = 0; sample < 50; ++sample) {
    const double w = std::sqrt(std::uniform_real_distribution<double>(1, 4)(random));
    ExpectHolds(t, 0, 0, std::cos(w * h));
    ExpectHolds(t, 0, 1, std::sin(w * h) / w);
    ExpectHolds(t, 1, 0, -w * std::sin(w * h));
    ExpectHolds(t, 1, 1, std::cos(w * h));
  }
}

// Rates may change in time: a scalar solution is the exponential of the integral.
TEST(TransitionMatrix, EnclosesRatesThatChange) {
  const double h = 0.5;
  const Transition t = After({Interval{-1, 2}}, 1, h);
  std::mt19937_64 random(4);
  for (int sample = 0; sample < 50; ++sample) {
    double integral = 0;
    for (int piece = 0; piece < 10; ++piece)
      integral += h / 10 * std::uniform_real_distribution<double>(-1, 2)(random);
    ExpectHolds(t, 0, 0, std::exp(integral));
  }
  ExpectHolds(t, 0, 0, std::exp(-h));
  ExpectHolds(t, 0, 0, std::exp(2 * h));
}

TEST(TransitionMatrix, GrowthBoundsAllTimes) {
  const double h = 4;
  const Transition t = After({At(0), At(1), At(-1), At(0)}, 2, h);
  for (int k = 0; k <= 100; ++k) {
    const double at = h * k / 100;
    EXPECT_GE(t.growth(0, 0), std::fabs(std::cos(at)));
    EXPECT_GE(t.growth(0, 1), std::fabs(std::sin(at)));
    EXPECT_GE(t.growth(1, 0), std::fabs(std::sin(at)));
  }
}

TEST(TransitionMatrix, GrowthOfADecayIsThatOfTheStart) {
  const Transition t = After({At(-2)}, 1, 1.0);
  EXPECT_GE(t.growth(0, 0), 1);
  ExpectHolds(t, 0, 0, std::exp(-2.0));
}

TEST(TransitionMatrix, OfNothingIsEmpty) {
  const Transition t = After({}, 0, 1.0);
  EXPECT_EQ(t.centre.size(), 0);
}

}  // namespace
}  // namespace rondo::reach
