#include "reach/validated/series/flow_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rondo::reach {
namespace {

double Uniform(std::mt19937_64& random, double lo = -1, double hi = 1) {
  return std::uniform_real_distribution<double>(lo, hi)(random);
}

long double ValueAt(const Monomials& monomials, std::span<const double> polynomial,
                    const std::vector<double>& s) {
  long double sum = 0;
  for (size_t m = 0; m < polynomial.size(); ++m) {
    long double term = polynomial[m];
    for (size_t k = 0; k < s.size(); ++k) term *= std::pow<long double>(s[k], monomials.Exponents(m)[k]);
    sum += term;
  }
  return sum;
}

class FlowSets : public testing::Test {
 protected:
  FlowSets() { monomials_.Extend(4); }
  std::vector<double> Symbols() { return {Uniform(random_), Uniform(random_)}; }
  // Two states of this degree with coefficients at random.
  FlowSet Some(size_t degree) {
    FlowSet set = FromBox({{-1, 1}, {0, 2}}, monomials_, {0, 1});
    set.Raise(monomials_, degree);
    for (double& c : set.polynomials) c = Uniform(random_);
    return set;
  }

  Monomials monomials_{2};
  std::mt19937_64 random_{6};
};

TEST_F(FlowSets, FromBoxesHoldTheirCorners) {
  for (int round = 0; round < 100; ++round) {
    const double lo = Uniform(random_, -10, 10);
    const interval::Box box{{lo, lo + Uniform(random_, 0, 3)}, {0.1, 0.3}};
    const FlowSet set = FromBox(box, monomials_, {0, 1});
    for (size_t i = 0; i < 2; ++i) {
      EXPECT_LE(ValueAt(monomials_, set.Polynomial(i), {-1, -1}), box[i].lo);
      EXPECT_GE(ValueAt(monomials_, set.Polynomial(i), {1, 1}), box[i].hi);
    }
  }
}

TEST_F(FlowSets, SidesWithoutASymbolAreErrors) {
  const FlowSet set = FromBox({{-1, 1}, {0, 0.5}}, monomials_, {0, -1});
  EXPECT_EQ(set.slack[0], 0);
  EXPECT_GE(set.slack[1], 0.25);
  EXPECT_EQ(RangeOf(monomials_, set.Polynomial(1)).Middle(), 0.25);
}

TEST_F(FlowSets, PointsHaveNoErrors) {
  const FlowSet set = FromBox({Interval::Point(3), Interval::Point(-1)}, monomials_, {-1, -1});
  EXPECT_LT(set.Error(0), 1e-290);
  EXPECT_EQ(set.Polynomial(0)[0], 3);
}

TEST_F(FlowSets, StayTheSameWhenRaised) {
  FlowSet set = Some(2);
  const FlowSet before = set;
  set.Raise(monomials_, 4);
  EXPECT_EQ(set.count, monomials_.Count(4));
  for (int sample = 0; sample < 30; ++sample) {
    const auto s = Symbols();
    for (size_t i = 0; i < 2; ++i)
      EXPECT_EQ(ValueAt(monomials_, set.Polynomial(i), s), ValueAt(monomials_, before.Polynomial(i), s));
  }
}

TEST_F(FlowSets, LoseNothingWhenLowered) {
  const FlowSet before = Some(4);
  FlowSet set = before;
  set.Lower(monomials_, 1);
  for (int sample = 0; sample < 100; ++sample) {
    const auto s = Symbols();
    for (size_t i = 0; i < 2; ++i) {
      const long double moved =
          ValueAt(monomials_, set.Polynomial(i), s) - ValueAt(monomials_, before.Polynomial(i), s);
      EXPECT_LE(std::fabs(moved), set.Error(i));
    }
  }
}

TEST_F(FlowSets, TopIsTheSizeOfTheHighestTerms) {
  FlowSet set = Some(2);
  std::fill(set.polynomials.begin(), set.polynomials.end(), 0.0);
  set.Polynomial(0)[0] = 100;
  set.Polynomial(0)[set.count - 1] = -0.5;
  set.Polynomial(0)[set.count - 2] = 0.25;
  EXPECT_NEAR(set.Top(monomials_, 0), 0.75, 1e-11);
  EXPECT_GE(set.Top(monomials_, 0), 0.75);
}

TEST_F(FlowSets, HalvesAreTheSetOnHalfOfASymbol) {
  const FlowSet set = Some(4);
  for (const bool upper : {false, true}) {
    const FlowSet half = Half(set, monomials_, 1, upper);
    for (int sample = 0; sample < 60; ++sample) {
      const double s = Uniform(random_);
      const double r = Uniform(random_);
      for (size_t i = 0; i < 2; ++i) {
        const long double whole = ValueAt(monomials_, set.Polynomial(i), {s, (r + (upper ? 1 : -1)) / 2});
        EXPECT_LE(std::fabs(ValueAt(monomials_, half.Polynomial(i), {s, r}) - whole), half.Error(i));
      }
    }
    EXPECT_LT(half.Error(0), 1e-12);
  }
}

TEST_F(FlowSets, ErrorsCountGeneratorsAndSlack) {
  FlowSet set = Some(1);
  set.slack = {0.5, 0};
  set.AddGenerator(Eigen::Vector2d(0.25, -1));
  set.AddGenerator(Eigen::Vector2d(-0.125, 2));
  EXPECT_GE(set.Error(0), 0.875);
  EXPECT_NEAR(set.Error(0), 0.875, 1e-11);
  EXPECT_NEAR(set.Error(1), 3, 1e-11);
}

TEST_F(FlowSets, GrowByMoreGeneratorsThanThereIsRoomFor) {
  FlowSet set = Some(1);
  for (int k = 0; k < 40; ++k) set.AddGenerator(Eigen::Vector2d(1, 0.5));
  EXPECT_EQ(set.used, 40);
  EXPECT_NEAR(set.Error(0), 40, 1e-9);
  EXPECT_NEAR(set.Error(1), 20, 1e-9);
}

// The errors of the image in any direction, by sampling signs of the old ones.
void ExpectImageOfErrors(const FlowSet& before, const FlowSet& after, const Eigen::Matrix2d& centre,
                         const std::vector<double>& added, std::mt19937_64& random) {
  for (int sample = 0; sample < 200; ++sample) {
    Eigen::Vector2d e = Eigen::Vector2d::Zero();
    for (Eigen::Index g = 0; g < before.used; ++g)
      e += (random() % 2 == 0 ? 1.0 : -1.0) * before.generators.col(g);
    for (int i = 0; i < 2; ++i)
      e[i] += (random() % 2 == 0 ? 1.0 : -1.0) * before.slack[static_cast<size_t>(i)];
    const Eigen::Vector2d image = centre * e;
    for (int i = 0; i < 2; ++i) {
      const auto state = static_cast<size_t>(i);
      EXPECT_LE(std::fabs(image[i]) + added[state], after.Error(state) * (1 + 1e-14));
    }
  }
}

TEST_F(FlowSets, CarryTheirErrorsAlong) {
  for (int round = 0; round < 10; ++round) {
    FlowSet set = Some(1);
    set.slack = {0.1, 0.2};
    for (int g = 0; g < 6; ++g) set.AddGenerator(Eigen::Vector2d(Uniform(random_), Uniform(random_)));
    const FlowSet before = set;
    Eigen::Matrix2d centre;
    centre << Uniform(random_), Uniform(random_), Uniform(random_), Uniform(random_);
    const std::vector<double> added{0.01, 0.02};
    set.Transform(centre, added, 100);
    EXPECT_EQ(set.used, 8);
    ExpectImageOfErrors(before, set, centre, added, random_);
  }
}

TEST_F(FlowSets, KeepFewGeneratorsButAllErrors) {
  FlowSet set = Some(1);
  for (int g = 0; g < 30; ++g) set.AddGenerator(Eigen::Vector2d(Uniform(random_), Uniform(random_)));
  const FlowSet before = set;
  const Eigen::Matrix2d centre = Eigen::Matrix2d::Identity();
  set.Transform(centre, std::vector<double>{0, 0}, 10);
  EXPECT_LE(set.used, 10);
  ExpectImageOfErrors(before, set, centre, {0, 0}, random_);
}

TEST_F(FlowSets, RangesEncloseThePolynomials) {
  for (int round = 0; round < 20; ++round) {
    const FlowSet set = Some(4);
    const Interval range = RangeOf(monomials_, set.Polynomial(0));
    for (int sample = 0; sample < 30; ++sample) {
      const long double value = ValueAt(monomials_, set.Polynomial(0), Symbols());
      EXPECT_LE(range.lo, value);
      EXPECT_GE(range.hi, value);
    }
  }
}

TEST_F(FlowSets, RangesKnowThatSquaresAreNotNegative) {
  std::vector<double> square(monomials_.Count(2));
  for (size_t m = 0; m < square.size(); ++m) square[m] = monomials_.Exponents(m)[0] == 2 ? 1 : 0;
  const Interval range = RangeOf(monomials_, square);
  EXPECT_NEAR(range.lo, 0, 1e-11);
  EXPECT_NEAR(range.hi, 1, 1e-11);
}

}  // namespace
}  // namespace rondo::reach
