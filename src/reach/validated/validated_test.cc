#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reach/validated/flow/map.h"
#include "reach/validated/prover.h"
#include "reach/validated/series/jet.h"
#include "reach/validated/series/transition.h"

namespace rondo::reach {

extern const Convolve kPortableConvolve;

namespace {

using expr::Elementary;

class Systems : public testing::Test {
 protected:
  TermId Var(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Of(Elementary f, std::vector<TermId> args) { return arena_.Apply(f, std::move(args)); }

  Problem Make(std::vector<TermId> states, std::vector<TermId> rates, interval::Box initial,
               const char* horizon) {
    Problem p;
    p.name = "test";
    p.arena = &arena_;
    p.states = std::move(states);
    p.rates = std::move(rates);
    p.initial = std::move(initial);
    p.assume = arena_.True();
    p.horizon = *Rational::Parse(horizon);
    return p;
  }
  void Always(Problem& p, TermId formula) { p.claims.push_back({"always", formula, Rational(0), p.horizon}); }
  Outcome Decided(const Problem& p, size_t leaves = 200) {
    ProverOptions options;
    options.most_leaves = leaves;
    auto outcome = Decide(p, options, base::StopToken());
    EXPECT_TRUE(outcome.ok());
    return std::move(outcome).value();
  }

  expr::Arena arena_;
};

TEST(Jets, EncloseTaylorCoefficients) {
  std::vector<Interval> out(6);
  ASSERT_TRUE(Jet(CodeOp::kExp, Interval::Point(0.5), out));
  double factorial = 1;
  for (size_t k = 0; k < out.size(); ++k) {
    if (k > 0) factorial *= static_cast<double>(k);
    EXPECT_TRUE(out[k].Contains(std::exp(0.5) / factorial)) << k;
    EXPECT_LT(out[k].Width(), 1e-12);
  }
  ASSERT_TRUE(Jet(CodeOp::kAtan, Interval::Point(1), out));
  // atan(1 + t) = pi/4 + t/2 - t^2/4 + t^3/12 + 0 t^4 - t^5/40 ...
  const double expected[] = {std::atan(1), 0.5, -0.25, 1.0 / 12, 0, -1.0 / 40};
  for (size_t k = 0; k < out.size(); ++k) EXPECT_NEAR(out[k].Middle(), expected[k], 1e-12) << k;
  ASSERT_TRUE(Jet(CodeOp::kRoot, Interval::Point(4), out));
  EXPECT_TRUE(out[2].Contains(-1.0 / 64));
  EXPECT_FALSE(Jet(CodeOp::kReciprocal, {-1, 1}, out));
  EXPECT_FALSE(Jet(CodeOp::kLog, {0, 1}, out));
}

TEST(MonomialTable, CountsAndPairs) {
  Monomials m(3);
  m.Extend(2);
  EXPECT_EQ(m.Count(2), 10u);
  m.Extend(4);
  EXPECT_EQ(m.Count(2), 10u);
  EXPECT_EQ(m.Count(4), 35u);
  // Every pair multiplies to its monomial.
  for (size_t k = 0; k < m.Count(4); ++k) {
    for (uint32_t p = m.pair_begin()[k]; p < m.pair_begin()[k + 1]; ++p) {
      for (size_t s = 0; s < 3; ++s)
        EXPECT_EQ(m.Exponents(m.left()[p])[s] + m.Exponents(m.right()[p])[s], m.Exponents(k)[s]);
    }
  }
  EXPECT_EQ(m.Exponents(m.Symbol(1))[1], 1);
}

TEST(Kernels, AgreeUpToRounding) {
  Monomials m(4);
  m.Extend(3);
  const size_t count = m.Count(3);
  std::mt19937_64 random(5);
  std::vector<double> a(count * 16 + 8), b(a.size()), x(count), y(count);
  for (double& v : a) v = static_cast<double>(random() % 2000) / 1000 - 1;
  for (double& v : b) v = static_cast<double>(random() % 2000) / 1000 - 1;
  const Pairs pairs{m.pair_begin().data(), m.left().data(), m.right().data()};
  for (const size_t blocks : {size_t{1}, size_t{2}}) {
    kPortableConvolve(pairs, count, a.data(), 16, b.data(), 16, blocks, x.data());
    BestConvolve()(pairs, count, a.data(), 16, b.data(), 16, blocks, y.data());
    for (size_t i = 0; i < count; ++i) EXPECT_NEAR(x[i], y[i], 1e-12);
  }
}

TEST(Transitions, EncloseRotationsAndDecay) {
  Transition t;
  const std::vector<Interval> turn{Interval::Point(0), Interval::Point(-1), Interval::Point(1),
                                   Interval::Point(0)};
  Propagate(turn, 2, 2.0, t);
  EXPECT_NEAR(t.centre(0, 0), std::cos(2.0), 1e-12);
  EXPECT_NEAR(t.centre(1, 0), std::sin(2.0), 1e-12);
  EXPECT_LT(t.radius.maxCoeff(), 1e-12);
  const std::vector<Interval> decay{{-30, -20}};
  Propagate(decay, 1, 0.5, t);
  EXPECT_LE(t.centre(0, 0) - t.radius(0, 0), std::exp(-15.0));
  EXPECT_GE(t.centre(0, 0) + t.radius(0, 0), std::exp(-10.0));
  EXPECT_GE(t.growth(0, 0), 1);
}

// Images of random points of random boxes lie in the image of the box, whatever the function does.
TEST_F(Systems, MapsEncloseImages) {
  const TermId x = Var("x"), y = Var("y");
  const std::vector<TermId> functions{
      Of(Elementary::kMax, {x, arena_.Mul(x, y)}),
      Of(Elementary::kAbs, {arena_.Sub(x, y)}),
      Of(Elementary::kAtan2, {y, arena_.Add({x, Num("3")})}),
      Of(Elementary::kMin, {Of(Elementary::kMax, {arena_.Add({x, y}), Num("-0.4")}), Num("0.3")}),
      Of(Elementary::kExp, {Of(Elementary::kSin, {arena_.Mul(x, y)})}),
      Of(Elementary::kSqrt, {arena_.Add({arena_.Mul(x, x), Num("0.5")})}),
      arena_.Ite(arena_.Lt(x, y), arena_.Mul(x, x), arena_.Add({y, Num("1")})),
      Of(Elementary::kAsin, {arena_.Mul(Num("0.4"), x)})};
  auto program = Compile(arena_, {x, y}, functions);
  ASSERT_TRUE(program.ok());
  std::mt19937_64 random(11);
  const auto uniform = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int round = 0; round < 200; ++round) {
    auto monomials = std::make_shared<Monomials>(2);
    monomials->Extend(3);
    interval::Box box;
    for (int i = 0; i < 2; ++i) {
      const double c = uniform(-1.5, 1.5);
      const double r = std::pow(10, uniform(-6, -0.3));
      box.push_back({c - r, c + r});
    }
    FlowSet set = FromBox(box, *monomials, {0, 1});
    if (round % 2 == 0) set.Raise(*monomials, 3);
    if (round % 3 == 0) set.slack[0] = 0.01;
    Map map(program.value(), 2, {}, monomials);
    ASSERT_TRUE(map.Apply(set));
    Evaluator evaluate(program.value());
    for (int k = 0; k < 50; ++k) {
      const double extra = round % 3 == 0 ? uniform(-0.01, 0.01) : 0;
      const std::vector<double> point{uniform(box[0].lo, box[0].hi) + extra, uniform(box[1].lo, box[1].hi)};
      std::vector<double> image(functions.size());
      evaluate(point, image);
      for (size_t f = 0; f < functions.size(); ++f) {
        EXPECT_LE(map.Range(f).lo - 1e-14, image[f]) << "function " << f << " round " << round;
        EXPECT_GE(map.Range(f).hi + 1e-14, image[f]) << "function " << f << " round " << round;
      }
    }
  }
}

TEST_F(Systems, ProvesAndRefutesOscillator) {
  const TermId x = Var("x"), v = Var("v");
  Problem p = Make({x, v}, {v, arena_.Neg(x)}, {{0.9, 1.1}, {-0.1, 0.1}}, "7");
  Always(p, arena_.Lt(x, Num("1.2")));
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(p)));
  p.claims.clear();
  Always(p, arena_.Lt(x, Num("1.05")));
  const Outcome outcome = Decided(p);
  const auto* refuted = std::get_if<Refuted>(&outcome);
  ASSERT_NE(refuted, nullptr);
  EXPECT_TRUE(refuted->certain);
  EXPECT_GE(refuted->violation.state[0], 1.05);
}

TEST_F(Systems, BisectsWhatIsTooWide) {
  const TermId x = Var("x"), y = Var("y");
  const TermId rate = arena_.Sub(arena_.Mul(arena_.Sub(Num("1"), arena_.Mul(x, x)), y), x);
  Problem p = Make({x, y}, {y, rate}, {{1.0, 2.0}, {2.0, 3.0}}, "6");
  Always(p, arena_.And({arena_.Lt(x, Num("2.6")), arena_.Lt(Num("-2.6"), x)}));
  const Outcome outcome = Decided(p, 400);
  const auto* proved = std::get_if<Proved>(&outcome);
  ASSERT_NE(proved, nullptr);
  EXPECT_GT(proved->leaves.size(), 1u);
}

TEST_F(Systems, InputsMayDoAnything) {
  const TermId x = Var("x"), w = Var("w");
  Problem p = Make({x}, {arena_.Add({arena_.Neg(x), w})}, {{0, 0}}, "3");
  p.inputs.push_back({w, {-0.5, 0.5}});
  Always(p, arena_.Lt(x, Num("0.55")));
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(p)));
  p.claims.clear();
  Always(p, arena_.Lt(x, Num("0.4")));  // w = 0.5 all the time reaches 0.475
  EXPECT_FALSE(std::holds_alternative<Proved>(Decided(p, 4)));
}

TEST_F(Systems, KinksAreEnclosed) {
  // x' = -|x| y, y' = 1: |x| has no derivative at 0, and x gets there only in the limit; z swings through.
  const TermId z = Var("z"), t = Var("t");
  Problem p =
      Make({z, t}, {arena_.Sub(Of(Elementary::kAbs, {z}), Num("0.5")), Num("1")}, {{0.2, 0.3}, {0, 0}}, "2");
  Always(p, arena_.And({arena_.Lt(z, Num("0.31")), arena_.Lt(Num("-1"), z)}));
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(p)));
  p.claims.clear();
  Always(p, arena_.Lt(Num("-0.2"), z));
  EXPECT_FALSE(std::holds_alternative<Proved>(Decided(p, 8)));
}

TEST_F(Systems, SampledControlIsHeld) {
  // x' = u, u = -x every 0.5 s: x halves each period.
  const TermId x = Var("x"), u = Var("u");
  Problem p = Make({x, u}, {u, Num("0")}, {{0.8, 1}, {0, 0}}, "2");
  p.controller = Controller{*Rational::Parse("0.5"), {std::nullopt, arena_.Neg(x)}};
  p.claims.push_back({"end", arena_.Le(x, Num("0.0626")), p.horizon, p.horizon});
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(p)));
  p.claims = {{"end", arena_.Le(x, Num("0.06")), p.horizon, p.horizon}};
  EXPECT_TRUE(std::holds_alternative<Refuted>(Decided(p)));
}

TEST_F(Systems, WhatStartsOnTheBoundaryAndFallsIsBelow) {
  // x' = -x - 0.1 and the claim that x <= 1, from x in [0, 1].
  const TermId x = Var("x");
  Problem p = Make({x}, {arena_.Sub(arena_.Neg(x), Num("0.1"))}, {{0, 1}}, "1");
  p.assume = arena_.And({arena_.Le(x, Num("1")), arena_.Le(Num("0"), x)});
  Always(p, arena_.Le(x, Num("1")));
  EXPECT_TRUE(std::holds_alternative<Proved>(Decided(p)));
  p.rates = {arena_.Sub(Num("0.1"), x)};
  p.claims.clear();
  Always(p, arena_.Lt(x, Num("1")));  // strict: broken at the start
  EXPECT_FALSE(std::holds_alternative<Proved>(Decided(p, 8)));
}

TEST_F(Systems, DivisionByZeroEndsTheTube) {
  const TermId x = Var("x");
  Problem p = Make({x}, {arena_.Divide(Num("-1"), x)}, {{0.9, 1}}, "2");  // reaches 0 after half a second
  Always(p, arena_.Lt(x, Num("2")));
  EXPECT_TRUE(std::holds_alternative<Undecided>(Decided(p, 4)));
}

}  // namespace
}  // namespace rondo::reach
