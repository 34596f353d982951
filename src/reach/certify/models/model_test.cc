#include "reach/certify/models/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>

namespace rondo::reach::certify {
namespace {

TEST(UpperBounds, CoverSumsThatAreRounded) {
  std::mt19937_64 random(1);
  double rounded = 0;
  long double exact = 0;
  for (int i = 0; i < 5000; ++i) {
    const double x = std::ldexp(static_cast<double>(random() >> 11), -static_cast<int>(random() % 80));
    rounded += x;
    exact += x;
  }
  EXPECT_GE(static_cast<long double>(Up(rounded)), exact);
  EXPECT_GT(Up(0), 0);
}

TEST(UpperBounds, GammaIsTheClassicalOne) {
  for (const double n : {1.0, 10.0, 1e6, 1e9}) EXPECT_GE(Gamma(n), n * 0x1p-53 / (1 - n * 0x1p-53));
}

TEST(UpperBounds, TheRadiusReachesBothEnds) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 200; ++round) {
    const double lo = std::uniform_real_distribution<double>(-9, 9)(random);
    const Interval i{lo, lo + std::uniform_real_distribution<double>(0, 1)(random)};
    EXPECT_LE(static_cast<long double>(i.Middle()) - Radius(i), static_cast<long double>(i.lo));
    EXPECT_GE(static_cast<long double>(i.Middle()) + Radius(i), static_cast<long double>(i.hi));
  }
  EXPECT_EQ(Radius(Interval::Point(3)), 0);
}

TEST(MonomialBasis, FindsEveryMonomial) {
  const Basis basis(3, 4);
  EXPECT_EQ(basis.size(), 35u);
  for (size_t m = 0; m < basis.size(); ++m) {
    const auto e = basis.Exponents(m);
    EXPECT_EQ(basis.Find({e.begin(), e.end()}), m);
    EXPECT_EQ(basis.DegreeOf(m), e[0] + e[1] + e[2]);
    EXPECT_EQ(basis.IsEven(m), e[0] % 2 + e[1] % 2 + e[2] % 2 == 0);
  }
  EXPECT_FALSE(basis.Find({5, 0, 0}));
}

TEST(MonomialBasis, ListsAllPairsOfFactorsOnce) {
  const Basis basis(2, 4);
  std::set<std::pair<uint32_t, uint32_t>> seen;
  size_t most = 0;
  for (size_t m = 0; m < basis.size(); ++m) {
    most = std::max(most, basis.Pairs(m).size());
    for (const auto [left, right] : basis.Pairs(m)) {
      EXPECT_TRUE(seen.emplace(left, right).second);
      for (size_t s = 0; s < 2; ++s)
        EXPECT_EQ(basis.Exponents(left)[s] + basis.Exponents(right)[s], basis.Exponents(m)[s]);
    }
  }
  // In two symbols of degree four: (4 + 4 choose 4) ordered pairs.
  EXPECT_EQ(seen.size(), 70u);
  EXPECT_EQ(basis.most_pairs(), most);
}

TEST(MonomialBasis, BeginsLikeThoseOfHigherDegrees) {
  const Basis low(3, 2);
  const Basis high(3, 5);
  for (size_t m = 0; m < low.size(); ++m)
    EXPECT_TRUE(std::ranges::equal(low.Exponents(m), high.Exponents(m))) << m;
}

TEST(MonomialBasis, DegreesStayWithinTheirNumber) {
  EXPECT_EQ(DegreeWithin(2, 6), 2u);
  EXPECT_EQ(DegreeWithin(2, 9), 2u);
  EXPECT_EQ(DegreeWithin(2, 10), 3u);
  EXPECT_EQ(DegreeWithin(100, 3), 1u);
  EXPECT_EQ(DegreeWithin(0, 50), 1u);
}

TEST(MonomialBasis, IsMadeOnce) {
  Bases bases;
  EXPECT_EQ(bases.Of(2, 3), bases.Of(2, 3));
  EXPECT_NE(bases.Of(2, 3), bases.Of(2, 4));
}

class TaylorModels : public testing::Test {
 protected:
  double Uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  // About `middle`, never further away than 1/2.
  Model Some(double middle) {
    Model m = algebra_.Constant(Interval::Point(middle));
    for (size_t i = 1; i < m.polynomial.size(); ++i)
      m.polynomial[i] = Uniform(-0.5, 0.5) / static_cast<double>(m.polynomial.size());
    algebra_.Seal(m);
    return m;
  }
  long double ValueAt(const Model& model, const std::vector<double>& s, double t) const {
    long double sum = 0;
    for (size_t m = 0; m < basis_.size(); ++m) {
      const auto e = basis_.Exponents(m);
      for (size_t p = 0; p <= algebra_.order(); ++p)
        sum += model.polynomial[m * (algebra_.order() + 1) + p] * std::pow<long double>(t, p) *
               std::pow<long double>(s[0], e[0]) * std::pow<long double>(s[1], e[1]);
    }
    return sum;
  }
  // `exact`: what the model should hold where a and b have these values.
  void ExpectHolds(const Model& model, const Model& a, const Model& b,
                   const std::function<long double(long double, long double)>& exact) {
    for (int sample = 0; sample < 60; ++sample) {
      const std::vector<double> s{Uniform(-1, 1), Uniform(-1, 1)};
      const double t = sample == 0 ? 1 : Uniform(0, 1);
      const long double value = exact(ValueAt(a, s, t), ValueAt(b, s, t));
      EXPECT_LE(std::fabs(ValueAt(model, s, t) - value), model.error + 1e-17L * (1 + std::fabs(value)));
      for (const Interval range : {algebra_.Bounds(model), algebra_.Range(model, t / 2, t)}) {
        EXPECT_LE(range.lo, value + 1e-17L);
        EXPECT_GE(range.hi, value - 1e-17L);
      }
    }
  }

  Basis basis_{2, 3};
  Algebra algebra_{basis_, 4};
  std::mt19937_64 random_{12};
};

TEST_F(TaylorModels, ContainTheProductOfTheirMembers) {
  for (int round = 0; round < 10; ++round) {
    const Model a = Some(Uniform(-2, 2));
    const Model b = Some(Uniform(-2, 2));
    ExpectHolds(algebra_.Product(a, b), a, b, [](long double x, long double y) { return x * y; });
  }
}

TEST_F(TaylorModels, ContainProductsOfErrorsToo) {
  Model a = Some(1);
  Model b = Some(-1.5);
  a.error = 0.25;
  b.error = 0.125;
  const Model product = algebra_.Product(a, b);
  for (const double da : {-0.25, 0.25}) {
    for (const double db : {-0.125, 0.125})
      ExpectHolds(product, a, b, [&](long double x, long double y) { return (x + da) * (y + db); });
  }
}

TEST_F(TaylorModels, ContainSumsOfTheirMembers) {
  const Model a = Some(1);
  const Model b = Some(2);
  const std::vector<LinearPart> parts{{0.1, 0x1p-57, 0}, {-3, 0, 1}};
  const Model sum = algebra_.Linear(parts, {0.5, 0, 0}, {a, b});
  ExpectHolds(sum, a, b, [](long double x, long double y) { return 0.5L + x / 10 - 3 * y; });
}

TEST_F(TaylorModels, AreScaledAndMoved) {
  const Model a = Some(1);
  const Model affine = algebra_.Affine(-0.75, a, {0.5, 1});
  for (const long double offset : {0.5L, 0.8L, 1.0L})
    ExpectHolds(affine, a, a, [&](long double x, long double) { return offset - 0.75L * x; });
}

TEST_F(TaylorModels, ContainEitherOfTwo) {
  const Model a = Some(1);
  const Model b = Some(1.5);
  const Model either = algebra_.Either(a, b);
  ExpectHolds(either, a, b, [](long double x, long double) { return x; });
  ExpectHolds(either, a, b, [](long double, long double y) { return y; });
}

TEST_F(TaylorModels, ContainFunctionsOfTheirMembers) {
  struct Case {
    CodeOp op;
    long double (*function)(long double);
  };
  const Case cases[] = {{CodeOp::kReciprocal, [](long double x) { return 1 / x; }},
                        {CodeOp::kRoot, [](long double x) { return std::sqrt(x); }},
                        {CodeOp::kSine, [](long double x) { return std::sin(x); }},
                        {CodeOp::kCosine, [](long double x) { return std::cos(x); }},
                        {CodeOp::kExp, [](long double x) { return std::exp(x); }},
                        {CodeOp::kLog, [](long double x) { return std::log(x); }},
                        {CodeOp::kAtan, [](long double x) { return std::atan(x); }}};
  const Model a = Some(1.25);
  for (const Case& c : cases) {
    const auto model = algebra_.Function(c.op, a);
    ASSERT_TRUE(model);
    ExpectHolds(*model, a, a, [&](long double x, long double) { return c.function(x); });
  }
}

TEST_F(TaylorModels, HaveNoFunctionsOutsideTheirDomain) {
  EXPECT_FALSE(algebra_.Function(CodeOp::kLog, algebra_.Constant({-1, 1})));
  EXPECT_FALSE(algebra_.Function(CodeOp::kRoot, algebra_.Constant({-1, 1})));
  EXPECT_FALSE(algebra_.Function(CodeOp::kReciprocal, algebra_.Constant({-1, 1})));
}

TEST_F(TaylorModels, ContainAnglesInAllQuadrants) {
  for (const double x : {-1.5, 1.5}) {
    for (const double y : {-1.0, 1.0}) {
      const Model a = Some(y);
      const Model b = Some(x);
      const auto angle = algebra_.Angle(a, b);
      ASSERT_TRUE(angle);
      ExpectHolds(*angle, a, b, [](long double at_y, long double at_x) { return std::atan2(at_y, at_x); });
    }
  }
}

TEST_F(TaylorModels, HaveNoAngleWhereItJumps) {
  EXPECT_FALSE(algebra_.Angle(algebra_.Constant({-1, 1}), algebra_.Constant({-2, -1})));
}

TEST_F(TaylorModels, OfConstantsHoldTheInterval) {
  const Model constant = algebra_.Constant({0.1, 0.7});
  EXPECT_TRUE(algebra_.Bounds(constant).Contains(Interval{0.1, 0.7}));
  EXPECT_LT(algebra_.Bounds(constant).Width(), 0.6 + 1e-9);
}

TEST_F(TaylorModels, CutOffPowersBeyondTheLimit) {
  const Model a = Some(1);
  algebra_.Limit(1);
  const Model product = algebra_.Product(a, a);
  for (size_t m = 0; m < basis_.size(); ++m) {
    for (size_t p = 2; p <= 4; ++p) EXPECT_EQ(product.polynomial[m * 5 + p], 0);
  }
}

}  // namespace
}  // namespace rondo::reach::certify
