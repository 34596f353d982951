#include "reach/certify/models/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reach/certify/models/errors.h"
#include "reach/problem/numeric.h"

namespace rondo::reach::certify {
namespace {

using expr::Elementary;

class Functions : public testing::Test {
 protected:
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Of(Elementary f, std::vector<TermId> args) { return arena_.Apply(f, std::move(args)); }
  void Use(const std::vector<TermId>& functions) {
    auto program = Compile(arena_, {x_, y_}, functions);
    ASSERT_TRUE(program.ok());
    program_ = std::move(program).value();
  }
  double Uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  std::vector<double> ValuesAt(double x, double y) const {
    Evaluator evaluate(program_);
    std::vector<double> values(program_.outputs.size());
    evaluate(std::vector<double>{x, y}, values);
    return values;
  }
  // x = 1 + s0 / 2, y = s1 / 2, and an error of 1/8 of x.
  ReachSet Some() const {
    ReachSet set;
    set.basis = std::make_shared<const Basis>(2, 2);
    set.polynomials.assign(2, std::vector<double>(set.basis->size()));
    set.polynomials[0][0] = 1;
    set.polynomials[0][1] = set.polynomials[1][2] = 0.5;
    set.generators = Eigen::MatrixXd::Zero(2, 1);
    set.generators(0, 0) = 0.125;
    return set;
  }

  expr::Arena arena_;
  TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  TermId y_ = arena_.Variable(arena_.Declare("y", {}, arena_.Real()));
  Program program_;
  std::mt19937_64 random_{21};
};

TEST_F(Functions, SlopesObeyTheMeanValueTheorem) {
  Use({arena_.Mul(x_, Of(Elementary::kSin, {y_})), Of(Elementary::kAbs, {arena_.Sub(x_, y_)}),
       Of(Elementary::kMax, {x_, arena_.Mul(Num("2"), y_)}), Of(Elementary::kAtan2, {y_, x_}),
       Of(Elementary::kSqrt, {arena_.Add(x_, Num("1"))})});
  OnBox on;
  ASSERT_TRUE(Linearise(program_, {{0.5, 1.5}, {-1, 1}}, 5, on));
  for (int sample = 0; sample < 200; ++sample) {
    const double x = Uniform(0.5, 1.5), y = Uniform(-1, 1), u = Uniform(0.5, 1.5), v = Uniform(-1, 1);
    const auto from = ValuesAt(x, y);
    const auto to = ValuesAt(u, v);
    for (size_t f = 0; f < from.size(); ++f) {
      const Interval change =
          on.slopes[2 * f] * Interval::Point(u - x) + on.slopes[2 * f + 1] * Interval::Point(v - y);
      EXPECT_TRUE((change + Around(1e-14)).Contains(to[f] - from[f])) << f;
    }
  }
}

TEST_F(Functions, OnABoxEncloseTheirValues) {
  Use({Of(Elementary::kExp, {arena_.Mul(x_, y_)}), arena_.Ite(arena_.Le(x_, y_), x_, Num("2"))});
  OnBox on;
  ASSERT_TRUE(Linearise(program_, {{-1, 1}, {-0.5, 0.5}}, 2, on));
  for (int sample = 0; sample < 100; ++sample) {
    const auto values = ValuesAt(Uniform(-1, 1), Uniform(-0.5, 0.5));
    for (size_t f = 0; f < 2; ++f)
      EXPECT_TRUE((on.values[program_.outputs[f]] + Around(1e-15)).Contains(values[f]));
  }
}

TEST_F(Functions, ChooseABranchOnlyIfItIsCertain) {
  Use({Of(Elementary::kAbs, {x_})});
  OnBox on;
  const auto choice = [&](Interval x) {
    EXPECT_TRUE(Linearise(program_, {x, {0, 0}}, 1, on));
    return on.choices[program_.outputs[0]];
  };
  EXPECT_EQ(choice({1, 2}), Choice::kFirst);
  EXPECT_EQ(choice({-2, -1}), Choice::kSecond);
  EXPECT_EQ(choice({-1, 1}), Choice::kOpen);
}

TEST_F(Functions, HaveNoSlopesOutsideTheirDomain) {
  OnBox on;
  for (const Elementary f : {Elementary::kSqrt, Elementary::kLog}) {
    Use({Of(f, {x_})});
    EXPECT_FALSE(Linearise(program_, {{-1, 1}, {0, 0}}, 1, on));
  }
  Use({arena_.Divide(Num("1"), x_)});
  EXPECT_FALSE(Linearise(program_, {{-1, 1}, {0, 0}}, 1, on));
}

TEST_F(Functions, OfModelsAreEnclosed) {
  Use({Of(Elementary::kAbs, {y_}), Of(Elementary::kMax, {x_, arena_.Add(y_, Num("1"))}),
       arena_.Ite(arena_.Lt(x_, Num("1")), y_, x_), Of(Elementary::kTan, {y_})});
  const Basis basis(2, 3);
  const Algebra algebra(basis, 0);
  OnBox on;
  ASSERT_TRUE(Linearise(program_, {{0.5, 1.5}, {-0.5, 0.5}}, 4, on));
  std::vector<double> x(basis.size()), y(basis.size());
  x[0] = 1;
  x[1] = y[2] = 0.5;
  const auto models = Evaluate(program_, algebra, {algebra.InSymbols(x), algebra.InSymbols(y)}, on);
  ASSERT_TRUE(models);
  const std::vector<Interval> ranges = RangesOf(algebra, *models);
  for (int sample = 0; sample < 100; ++sample) {
    const double s = Uniform(-1, 1), r = Uniform(-1, 1);
    const auto values = ValuesAt(1 + s / 2, r / 2);
    for (size_t f = 0; f < 4; ++f) {
      const Model& model = (*models)[program_.outputs[f]];
      double sum = 0;
      for (size_t m = 0; m < basis.size(); ++m)
        sum += model.polynomial[m] * std::pow(s, basis.Exponents(m)[0]) * std::pow(r, basis.Exponents(m)[1]);
      EXPECT_NEAR(sum, values[f], model.error + 1e-14) << f;
      EXPECT_TRUE((ranges[program_.outputs[f]] + Around(1e-14)).Contains(values[f])) << f;
    }
  }
}

TEST_F(Functions, ImagesHoldEveryMember) {
  Use({arena_.Mul(x_, y_), Of(Elementary::kExp, {arena_.Sub(y_, x_)})});
  Image image;
  ASSERT_TRUE(image.Of(program_, Some(), {}));
  const interval::Box box = image.Set().Box();
  for (int sample = 0; sample < 200; ++sample) {
    const auto values = ValuesAt(1 + Uniform(-0.625, 0.625), Uniform(-0.5, 0.5));
    for (size_t f = 0; f < 2; ++f) {
      EXPECT_TRUE((image.Range(f) + Around(1e-15)).Contains(values[f]));
      EXPECT_TRUE((box[f] + Around(1e-15)).Contains(values[f]));
    }
  }
}

TEST_F(Functions, ImagesKeepHowStatesDependOnTheStart) {
  Use({arena_.Sub(x_, y_), y_});
  Image image;
  ASSERT_TRUE(image.Of(program_, Some(), {}));
  const ReachSet moved = image.Set();
  Use({arena_.Add(x_, y_)});
  ASSERT_TRUE(image.Of(program_, moved, {}));
  EXPECT_TRUE(image.Range(0).Contains(Interval{0.375, 1.625}));
  EXPECT_LT(image.Range(0).Width(), 1.25 + 1e-8);
}

TEST_F(Functions, SetsOfAHigherBasisStayTheSame) {
  ReachSet set = Some();
  const interval::Box before = set.Box();
  set.SetBasis(std::make_shared<const Basis>(2, 4));
  EXPECT_EQ(set.generators.cols(), 1);
  for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(set.Box()[i].Width(), before[i].Width(), 1e-9);
}

TEST_F(Functions, SetsOfALowerBasisLoseNothing) {
  ReachSet set = Some();
  for (double& c : set.polynomials[1]) c = Uniform(-1, 1);
  const std::vector<double> before = set.polynomials[1];
  double cut = 0;
  for (size_t m = 3; m < before.size(); ++m) cut += std::fabs(before[m]);
  set.SetBasis(std::make_shared<const Basis>(2, 1));
  EXPECT_EQ(set.polynomials[1].size(), 3u);
  EXPECT_GE(set.Errors()[1], cut);
}

TEST_F(Functions, ErrorsOfSetsGetColumnsOfTheirOwn) {
  ReachSet set = Some();
  set.AddErrors(Eigen::Vector2d(0, 0.5));
  EXPECT_EQ(set.generators.cols(), 2);
  EXPECT_EQ(set.generators(0, 1), 0);
  EXPECT_GE(set.Errors()[1], 0.5);
}

TEST(Distances, AreRatesTimesTime) {
  const Eigen::VectorXd far = DistanceIn(0.5, {{-3, 1}, {0, 2}});
  EXPECT_GE(far[0], 1.5);
  EXPECT_GE(far[1], 1);
  EXPECT_LT(far[0], 1.5 + 1e-9);
  EXPECT_EQ(DistanceIn(0, {{-3, 1}})[0], 0);
}

// The scalar equation e' = a e with a = centre +- radius: exp of anything in between.
TEST(GrowthOfErrors, CoversEveryRate) {
  for (const double centre : {-3.0, 0.0, 1.5}) {
    const ErrorRates rates{Eigen::MatrixXd::Constant(1, 1, centre), Eigen::MatrixXd::Constant(1, 1, 0.25)};
    ErrorFlow flow;
    ASSERT_TRUE(PropagateErrors(rates, Eigen::MatrixXd::Constant(1, 1, 0.5), {}, flow));
    EXPECT_GE(flow.generators.cwiseAbs().sum(), 0.5 * std::exp(centre + 0.25));
    EXPECT_GE(flow.most[0], 0.5 * std::max(1.0, std::exp(centre + 0.25)));
  }
}

TEST(GrowthOfErrors, CoversThePush) {
  const ErrorRates rates{Eigen::MatrixXd::Zero(1, 1), Eigen::MatrixXd::Zero(1, 1)};
  const Push push{{Eigen::VectorXd::Constant(1, 0.5), Eigen::VectorXd::Constant(1, 3)}};
  ErrorFlow flow;
  ASSERT_TRUE(PropagateErrors(rates, Eigen::MatrixXd::Zero(1, 0), push, flow));
  EXPECT_GE(flow.generators.cwiseAbs().sum(), 2.0);
  EXPECT_LT(flow.generators.cwiseAbs().sum(), 2.0 + 1e-6);
}

TEST(GrowthOfErrors, CoversOscillatorsOfAnyStiffness) {
  ErrorRates rates{Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(2, 2)};
  rates.centre << 0, 1, -2.5, 0;
  rates.radius(1, 0) = 1.5;
  ErrorFlow flow;
  ASSERT_TRUE(PropagateErrors(rates, Eigen::MatrixXd::Identity(2, 2), {}, flow));
  for (double square = 1; square <= 4; square += 0.125) {
    const double w = std::sqrt(square);
    for (double t = 0; t <= 1; t += 0.0625)
      EXPECT_GE(flow.most[0], std::fabs(std::cos(w * t)) + std::fabs(std::sin(w * t) / w));
    EXPECT_GE(flow.generators.cwiseAbs().rowwise().sum()[1],
              w * std::fabs(std::sin(w)) + std::fabs(std::cos(w)));
  }
}

TEST(GrowthOfErrors, IsNotBoundedForEnormousRates) {
  const ErrorRates rates{Eigen::MatrixXd::Constant(1, 1, 1e9), Eigen::MatrixXd::Zero(1, 1)};
  ErrorFlow flow;
  EXPECT_FALSE(PropagateErrors(rates, Eigen::MatrixXd::Ones(1, 1), {}, flow));
}

}  // namespace
}  // namespace rondo::reach::certify
