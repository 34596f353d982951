#include "solve/certify/arithmetic/enclosure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rondo::solve::certify {
namespace {

Enclosure Point(double x) { return Enclosure(expr::Rational::FromDouble(x)); }

Enclosure Between(double lo, double hi) {
  Enclosure e = Point(lo);
  e.Join(Point(hi));
  return e;
}

// Is the number in the enclosure, up to the rounding of doubles?
bool Has(const Enclosure& e, double x) {
  const double slack = 1e-12 * std::fmax(1, std::fabs(x));
  return e.MayBeEqual(Between(x - slack, x + slack));
}

struct Box {
  double lo, hi;
  double Draw(std::mt19937_64& random) const {
    const auto how = random() % 8;
    if (how == 0) return lo;
    return how == 1 ? hi : lo + (hi - lo) * static_cast<double>(random() >> 11) * 0x1p-53;
  }
};

// Narrow and wide, on both sides of zero and of other places where functions turn.
Box Some(std::mt19937_64& random) {
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double middle = (unit() - 0.5) * 20, width = std::pow(10, -3 * unit()) * 4;
  const double lo = random() % 6 == 0 ? 0 : middle - width;
  return {lo, lo + 2 * width};
}

// Every value at a point of the boxes lies in the enclosure over the boxes.
TEST(Enclosures, ContainEveryValue) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 6'000; ++n) {
    const Box a = Some(random), b = Some(random);
    const Enclosure x = Between(a.lo, a.hi), y = Between(b.lo, b.hi);
    const double p = a.Draw(random), q = b.Draw(random);
    EXPECT_TRUE(Has(x + y, p + q));
    EXPECT_TRUE(Has(x - y, p - q));
    EXPECT_TRUE(Has(x * y, p * q));
    if (q != 0) {
      EXPECT_TRUE(Has(x / y, p / q)) << a.lo << " " << a.hi << " / " << b.lo << " " << b.hi;
    }
    for (const unsigned k : {1U, 2U, 3U, 4U, 7U})
      EXPECT_TRUE(Has(Power(x, k), std::pow(p, k))) << p << "^" << k;
    EXPECT_TRUE(Has(Abs(x), std::fabs(p)));
    EXPECT_TRUE(Has(Min(x, y), std::fmin(p, q)));
    EXPECT_TRUE(Has(Max(x, y), std::fmax(p, q)));
    EXPECT_TRUE(Has(Sin(x), std::sin(p))) << "sin in [" << a.lo << ", " << a.hi << "] at " << p;
    EXPECT_TRUE(Has(Cos(x), std::cos(p))) << "cos in [" << a.lo << ", " << a.hi << "] at " << p;
    EXPECT_TRUE(Has(Tan(x), std::tan(p))) << "tan in [" << a.lo << ", " << a.hi << "] at " << p;
    EXPECT_TRUE(Has(Atan2(x, y), std::atan2(p, q)))
        << "atan2 of [" << a.lo << ", " << a.hi << "], [" << b.lo << ", " << b.hi << "]";
    if (p >= 0) {
      EXPECT_TRUE(Has(Root(x, 2), std::sqrt(p)));
    }
    if (p > 0) {
      EXPECT_TRUE(Has(Log(x), std::log(p)));
    }
    if (p > 0) {
      EXPECT_TRUE(Has(RealPower(x, y), std::pow(p, q))) << p << "^" << q;
    }
  }
}

// What is left of a factor, a base or an angle has every solution.
TEST(Enclosures, KeepEverySolution) {
  std::mt19937_64 random(2);
  for (int n = 0; n < 6'000; ++n) {
    const Box a = Some(random), b = Some(random);
    const Enclosure x = Between(a.lo, a.hi), y = Between(b.lo, b.hi);
    const double p = a.Draw(random), q = b.Draw(random);
    const double width = static_cast<double>(random() % 3) * 0.1;
    const auto about = [&](double z) { return Between(z - width - 1e-9, z + 1e-9); };
    EXPECT_TRUE(Has(WhereTimes(about(p * q), y, x), p)) << p << " * " << q;
    EXPECT_TRUE(Has(WhereSin(about(std::sin(p)), x), p)) << "sin " << p;
    for (const unsigned k : {2U, 3U, 4U})
      EXPECT_TRUE(Has(WherePower(about(std::pow(p, k)), k, x), p)) << p << "^" << k;
  }
}

}  // namespace
}  // namespace rondo::solve::certify
