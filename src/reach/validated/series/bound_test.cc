#include "reach/validated/series/bound.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace rondo::reach {
namespace {

using interval::Interval;

// Non-negative numbers of all sizes, with full mantissas.
std::vector<double> Numbers(size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<double> numbers(count);
  for (double& x : numbers)
    x = std::ldexp(static_cast<double>(random() >> 11) * 0x1p-53, static_cast<int>(random() % 60) - 30);
  return numbers;
}

TEST(Bound, AboveIsNoLessThanTheExactSum) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    double rounded = 0;
    long double exact = 0;
    for (const double x : Numbers(2000, seed)) {
      rounded += x;
      exact += x;
    }
    EXPECT_GE(static_cast<long double>(Above(rounded)), exact) << seed;
  }
}

TEST(Bound, BelowIsNoMoreThanTheExactSum) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    double rounded = 0;
    long double exact = 0;
    for (const double x : Numbers(2000, seed)) {
      rounded += x;
      exact += x;
    }
    EXPECT_LE(static_cast<long double>(Below(rounded)), exact) << seed;
  }
}

TEST(Bound, AboveHoldsForProductsThatUnderflow) {
  const double product = 0x1p-600 * 0x1p-600;
  EXPECT_EQ(product, 0);
  EXPECT_GT(Above(product), 0);
}

TEST(Bound, BelowIsNeverNegative) {
  EXPECT_EQ(Below(0), 0);
  EXPECT_EQ(Below(0x1p-1040), 0);
}

TEST(Bound, BothAreClose) {
  EXPECT_LT(Above(1.0), 1 + 1e-11);
  EXPECT_GT(Below(1.0), 1 - 1e-11);
}

TEST(Bound, MagnitudeIsTheLargestDistanceFromZero) {
  EXPECT_EQ(Magnitude({-3, 2}), 3);
  EXPECT_EQ(Magnitude({1, 2}), 2);
  EXPECT_EQ(Magnitude({-5, -4}), 5);
}

TEST(Bound, TheRadiusIsAtLeastHalfTheWidth) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 200; ++round) {
    const double lo = std::uniform_real_distribution<double>(-1, 1)(random);
    const double hi = lo + std::uniform_real_distribution<double>(0, 1)(random);
    EXPECT_GE(static_cast<long double>(RadiusOf({lo, hi})), (static_cast<long double>(hi) - lo) / 2);
  }
}

TEST(Bound, AroundIsSymmetric) {
  EXPECT_EQ(Around(0.25), (Interval{-0.25, 0.25}));
  EXPECT_EQ(Around(0), (Interval{0, 0}));
}

TEST(Bound, CentredCoversTheInterval) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 200; ++round) {
    const double lo = std::uniform_real_distribution<double>(-1e3, 1e3)(random);
    const double hi = lo + std::ldexp(1.0, static_cast<int>(random() % 40) - 30);
    const auto [middle, error] = Centred({lo, hi});
    EXPECT_GE(middle, lo);
    EXPECT_LE(middle, hi);
    EXPECT_LE(static_cast<long double>(middle) - error, static_cast<long double>(lo));
    EXPECT_GE(static_cast<long double>(middle) + error, static_cast<long double>(hi));
  }
}

TEST(Bound, RoundingsCoverASumThatIsRoundedOften) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    double rounded = 0;
    long double exact = 0;
    long double size = 0;
    size_t sign = 0;
    for (const double x : Numbers(500, seed)) {
      const double term = sign++ % 2 == 0 ? x : -x;
      rounded += term;
      exact += term;
      size += x;
    }
    EXPECT_LE(std::fabs(rounded - exact), Roundings(500) * size) << seed;
  }
}

}  // namespace
}  // namespace rondo::reach
