#include "reach/validated/series/jet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rondo::reach {
namespace {

constexpr size_t kOrders = 9;

long double Factorial(size_t k) { return std::tgamma(static_cast<long double>(k) + 1); }
long double SineAt(long double x, size_t k) {
  const long double values[] = {std::sin(x), std::cos(x), -std::sin(x), -std::cos(x)};
  return values[k % 4];
}
long double Power(long double x, size_t k) { return std::pow(x, static_cast<long double>(k)); }

// g^(k)(x) / k! in closed form.
long double Coefficient(CodeOp function, long double x, size_t k) {
  const auto n = static_cast<long double>(k);
  switch (function) {
    case CodeOp::kReciprocal:
      return (k % 2 == 0 ? 1 : -1) / Power(x, k + 1);
    case CodeOp::kRoot: {
      long double binomial = 1;
      for (size_t i = 0; i < k; ++i)
        binomial *= (0.5L - static_cast<long double>(i)) / static_cast<long double>(i + 1);
      return binomial * std::sqrt(x) / Power(x, k);
    }
    case CodeOp::kExp:
      return std::exp(x) / Factorial(k);
    case CodeOp::kLog:
      return k == 0 ? std::log(x) : (k % 2 == 1 ? 1 : -1) / (n * Power(x, k));
    case CodeOp::kSine:
      return SineAt(x, k) / Factorial(k);
    case CodeOp::kCosine:
      return SineAt(x, k + 1) / Factorial(k);
    case CodeOp::kAtan: {
      const long double angle = std::atan(x);
      if (k == 0) return angle;
      return Power(std::cos(angle), k) * std::sin(n * (angle + std::acos(-1.0L) / 2)) / n;
    }
    default:
      return std::nanl("");
  }
}

void ExpectEnclosed(CodeOp function, Interval at) {
  std::vector<Interval> out(kOrders);
  ASSERT_TRUE(Jet(function, at, out));
  std::mt19937_64 random(17);
  for (int sample = 0; sample < 40; ++sample) {
    const double x = std::uniform_real_distribution<double>(at.lo, at.hi)(random);
    for (size_t k = 0; k < kOrders; ++k) {
      const long double exact = Coefficient(function, x, k);
      const long double noise = 1e-17L * (1 + std::fabs(exact));
      EXPECT_LE(out[k].lo, exact + noise) << k << " at " << x;
      EXPECT_GE(out[k].hi, exact - noise) << k << " at " << x;
    }
  }
}

TEST(JetsOnIntervals, EncloseThoseOfReciprocals) {
  ExpectEnclosed(CodeOp::kReciprocal, {0.7, 0.9});
  ExpectEnclosed(CodeOp::kReciprocal, {-3, -2});
}

TEST(JetsOnIntervals, EncloseThoseOfRoots) {
  ExpectEnclosed(CodeOp::kRoot, {0.25, 0.5});
  ExpectEnclosed(CodeOp::kRoot, {9, 16});
}

TEST(JetsOnIntervals, EncloseThoseOfExponentials) {
  ExpectEnclosed(CodeOp::kExp, {-1, 0.5});
  ExpectEnclosed(CodeOp::kExp, {3, 3.001});
}

TEST(JetsOnIntervals, EncloseThoseOfLogarithms) {
  ExpectEnclosed(CodeOp::kLog, {0.5, 1.5});
  ExpectEnclosed(CodeOp::kLog, {20, 21});
}

TEST(JetsOnIntervals, EncloseThoseOfSinesAndCosines) {
  for (const Interval at : {Interval{-0.1, 0.1}, Interval{1.4, 1.8}, Interval{100, 100.5}}) {
    ExpectEnclosed(CodeOp::kSine, at);
    ExpectEnclosed(CodeOp::kCosine, at);
  }
}

TEST(JetsOnIntervals, EncloseThoseOfArctangents) {
  ExpectEnclosed(CodeOp::kAtan, {-0.2, 0.3});
  ExpectEnclosed(CodeOp::kAtan, {1, 1.1});
  ExpectEnclosed(CodeOp::kAtan, {-6, -5.5});
}

TEST(JetsOnIntervals, AreTightAtPoints) {
  const CodeOp all[] = {CodeOp::kReciprocal, CodeOp::kRoot,   CodeOp::kExp, CodeOp::kLog,
                        CodeOp::kSine,       CodeOp::kCosine, CodeOp::kAtan};
  for (const CodeOp function : all) {
    std::vector<Interval> out(kOrders);
    ASSERT_TRUE(Jet(function, Interval::Point(1.25), out));
    for (const Interval i : out) EXPECT_LT(i.Width(), 1e-13);
  }
}

TEST(JetsOnIntervals, NeedAllOfTheArgumentInTheDomain) {
  std::vector<Interval> out(2);
  EXPECT_FALSE(Jet(CodeOp::kReciprocal, {0, 1}, out));
  EXPECT_FALSE(Jet(CodeOp::kRoot, {0, 1}, out));
  EXPECT_FALSE(Jet(CodeOp::kRoot, {-2, -1}, out));
  EXPECT_FALSE(Jet(CodeOp::kLog, {-1, 1}, out));
}

TEST(JetsOnIntervals, NeedABoundedArgument) {
  std::vector<Interval> out(2);
  EXPECT_FALSE(Jet(CodeOp::kExp, {}, out));
  EXPECT_FALSE(Jet(CodeOp::kSine, {0, std::numeric_limits<double>::infinity()}, out));
}

}  // namespace
}  // namespace rondo::reach
