#include "reach/validated/flow/stepper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "reach/validated/flow/flow.h"

namespace rondo::reach {
namespace {

using expr::Elementary;

class Steps : public testing::Test {
 protected:
  static constexpr size_t kOrder = 10;

  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  // x' and y' are the first two functions, the others are observed; w is an input.
  void Use(const std::vector<TermId>& functions, std::vector<Interval> inputs = {}) {
    std::vector<TermId> variables{x_, y_};
    if (!inputs.empty()) variables.push_back(w_);
    auto program = Compile(arena_, variables, functions, 2);
    ASSERT_TRUE(program.ok());
    dynamics_ = {std::move(program).value(), 2, std::move(inputs)};
    monomials_ = std::make_shared<Monomials>(2);
    monomials_->Extend(3);
    stepper_.emplace(dynamics_, monomials_, kOrder, 100);
  }
  void Oscillate(const std::vector<TermId>& observed = {}) {
    std::vector<TermId> functions{y_, arena_.Neg(x_)};
    functions.insert(functions.end(), observed.begin(), observed.end());
    Use(functions);
  }
  FlowSet From(const interval::Box& box) const {
    FlowSet set = FromBox(box, *monomials_, {0, 1});
    set.Raise(*monomials_, 3);
    return set;
  }
  double Symbol() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  double TimeIn(double h) { return std::uniform_real_distribution<double>(0, h)(random_); }

  expr::Arena arena_;
  TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  TermId y_ = arena_.Variable(arena_.Declare("y", {}, arena_.Real()));
  TermId w_ = arena_.Variable(arena_.Declare("w", {}, arena_.Real()));
  Dynamics dynamics_;
  std::shared_ptr<Monomials> monomials_;
  std::optional<Stepper> stepper_;
  std::mt19937_64 random_{9};
};

void ExpectHolds(Interval enclosure, double exact) {
  const double noise = 4e-16 * (1 + std::fabs(exact));
  EXPECT_LE(enclosure.lo, exact + noise);
  EXPECT_GE(enclosure.hi, exact - noise);
}

TEST_F(Steps, EncloseEachTrajectoryAtEachTime) {
  Oscillate();
  ASSERT_TRUE(stepper_->Advance(From({{0.75, 1.25}, {-0.25, 0.25}}), 0.25, 1e-3, kOrder));
  for (int sample = 0; sample < 50; ++sample) {
    const std::vector<double> s{Symbol(), Symbol()};
    const double t = TimeIn(stepper_->h());
    const double x = 1 + 0.25 * s[0];
    const double y = 0.25 * s[1];
    ExpectHolds(stepper_->StateAt(0, s, t), x * std::cos(t) + y * std::sin(t));
    ExpectHolds(stepper_->StateAt(1, s, t), y * std::cos(t) - x * std::sin(t));
    EXPECT_LT(stepper_->StateAt(0, s, t).Width(), 1e-10);
  }
}

TEST_F(Steps, EncloseTheTubeBetweenStartAndEnd) {
  Use({arena_.Mul(x_, arena_.Sub(Num("1"), x_)), Num("0")});
  ASSERT_TRUE(stepper_->Advance(From({{0.25, 0.5}, {0, 0}}), 0.25, 1e-3, kOrder));
  for (int sample = 0; sample < 100; ++sample) {
    const double x = 0.375 + 0.125 * Symbol();
    const double t = TimeIn(stepper_->h());
    const double slope = x * (1 - x);
    ExpectHolds(stepper_->during()[0], x / (x + (1 - x) * std::exp(-t)));
    ExpectHolds(stepper_->Rate(0), slope);
  }
}

TEST_F(Steps, EndWithASetThatHoldsTheSolutions) {
  Use({arena_.Mul(x_, arena_.Sub(Num("1"), x_)), Num("0")});
  const FlowSet set = From({{0.25, 0.5}, {0, 0}});
  ASSERT_TRUE(stepper_->Advance(set, 0.25, 1e-3, kOrder));
  FlowSet next;
  stepper_->Finish(set, next);
  for (int sample = 0; sample < 100; ++sample) {
    const double s = Symbol();
    const double x = 0.375 + 0.125 * s;
    double value = 0;
    for (size_t m = 0; m < next.count; ++m)
      value += next.Polynomial(0)[m] * std::pow(s, monomials_->Exponents(m)[0]) *
               (monomials_->Exponents(m)[1] == 0 ? 1 : 0);
    EXPECT_NEAR(value, x / (x + (1 - x) * std::exp(-stepper_->h())), next.Error(0) + 1e-15);
  }
}

TEST_F(Steps, CarryErrorsOfTheStartAlong) {
  Oscillate();
  FlowSet set = From({{1, 1}, {0, 0}});
  set.slack = {0.125, 0};
  ASSERT_TRUE(stepper_->Advance(set, 0.25, 1e-3, kOrder));
  FlowSet next;
  stepper_->Finish(set, next);
  EXPECT_GE(next.Error(0), 0.125 * std::cos(stepper_->h()));
  EXPECT_GE(next.Error(1), 0.125 * std::sin(stepper_->h()));
  ExpectHolds(stepper_->during()[0], 1.125);
}

TEST_F(Steps, AreShortenedUntilTheyCanBeProved) {
  Use({arena_.Mul(x_, x_), Num("0")});
  ASSERT_TRUE(stepper_->Advance(From({{1, 1}, {0, 0}}), 2, 1e-3, kOrder));
  EXPECT_LT(stepper_->h(), 1);
}

TEST_F(Steps, NeverPassABlowUp) {
  Use({arena_.Mul(x_, x_), Num("0")});
  EXPECT_FALSE(stepper_->Advance(From({{1, 1}, {0, 0}}), 2, 1, kOrder));
}

TEST_F(Steps, NeedRatesThatAreDefined) {
  Use({arena_.Divide(Num("1"), x_), Num("0")});
  EXPECT_FALSE(stepper_->Advance(From({{-1, 1}, {0, 0}}), 0.1, 1e-6, kOrder));
}

TEST_F(Steps, CoverAllThatInputsCanDo) {
  Use({w_, x_}, {{-1, 2}});
  const FlowSet set = From({{0, 0}, {0, 0}});
  ASSERT_TRUE(stepper_->Advance(set, 0.25, 1e-3, kOrder));
  const double h = stepper_->h();
  ExpectHolds(stepper_->during()[0], -h);
  ExpectHolds(stepper_->during()[0], 2 * h);
  FlowSet next;
  stepper_->Finish(set, next);
  const Interval end = RangeOf(*monomials_, next.Polynomial(1));
  EXPECT_LE(end.lo - next.Error(1), -h * h / 2);
  EXPECT_GE(end.hi + next.Error(1), h * h);
}

TEST_F(Steps, HoldAKinkThatIsNotDecided) {
  Use({arena_.Apply(Elementary::kAbs, {x_}), Num("0")});
  ASSERT_TRUE(stepper_->Advance(From({{-0.5, 0.5}, {0, 0}}), 0.125, 1e-3, kOrder));
  EXPECT_TRUE(stepper_->HoldsKinks());
  for (int sample = 0; sample < 50; ++sample) {
    const double x = 0.5 * Symbol();
    ExpectHolds(stepper_->during()[0], x * std::exp((x > 0 ? 1 : -1) * TimeIn(stepper_->h())));
  }
}

TEST_F(Steps, FollowAKinkThatIsDecided) {
  Use({arena_.Apply(Elementary::kAbs, {x_}), Num("0")});
  ASSERT_TRUE(stepper_->Advance(From({{1, 2}, {0, 0}}), 0.125, 1e-3, kOrder));
  EXPECT_FALSE(stepper_->HoldsKinks());
  ExpectHolds(stepper_->StateAt(0, std::vector<double>{1, 0}, stepper_->h()), 2 * std::exp(stepper_->h()));
}

TEST_F(Steps, ObserveTermsDuringAnyPart) {
  Oscillate({arena_.Mul(x_, y_)});
  ASSERT_TRUE(stepper_->Advance(From({{0.9, 1.1}, {-0.1, 0.1}}), 0.25, 1e-3, kOrder));
  const double h = stepper_->h();
  for (int sample = 0; sample < 100; ++sample) {
    const double x0 = 1 + 0.1 * Symbol();
    const double y0 = 0.1 * Symbol();
    const double t = TimeIn(h);
    const double x = x0 * std::cos(t) + y0 * std::sin(t);
    const double y = y0 * std::cos(t) - x0 * std::sin(t);
    const bool late = t > h / 2;
    for (const bool tight : {false, true})
      ExpectHolds(stepper_->Observed(0, late ? h / 2 : 0, late ? h : h / 2, tight), x * y);
    ExpectHolds(stepper_->ObservedRate(0), y * y - x * x);
    ExpectHolds(stepper_->ObservedSecond(0), -4 * x * y);
  }
}

TEST_F(Steps, KnowNoRateOfWhatInputsPush) {
  Use({w_, x_, w_, y_}, {{-1, 2}});
  ASSERT_TRUE(stepper_->Advance(From({{0, 0}, {0, 0}}), 0.25, 1e-3, kOrder));
  EXPECT_EQ(stepper_->ObservedRate(0), Interval());
  EXPECT_EQ(stepper_->ObservedSecond(1), Interval());
}

TEST_F(Steps, StayBelowWhatOnlyFalls) {
  Use({arena_.Neg(x_), Num("1"), arena_.Sub(x_, Num("2")), arena_.Sub(y_, Num("2"))});
  ASSERT_TRUE(stepper_->Advance(From({{1, 2}, {1, 2}}), 0.25, 1e-3, kOrder));
  EXPECT_TRUE(stepper_->StaysBelow(0));
  EXPECT_FALSE(stepper_->StaysBelow(1));
}

class Flows : public Steps {
 protected:
  // Follows the set over these instants; false if it is lost.
  bool Follow(Flow& flow, double until) {
    while (flow.time() < until) {
      if (!flow.Step(until)) return false;
    }
    return true;
  }
};

TEST_F(Flows, ComeBackAfterATurn) {
  Oscillate();
  Flow flow(dynamics_, monomials_, {}, 7);
  flow.Start(FromBox({{0.9, 1.1}, {-0.1, 0.1}}, *monomials_, {0, 1}), 0);
  ASSERT_TRUE(Follow(flow, 2 * std::acos(-1)));
  const interval::Box now = flow.Now();
  EXPECT_TRUE(now[0].Contains(Interval{0.9 + 1e-9, 1.1 - 1e-9}));
  EXPECT_TRUE(now[1].Contains(Interval{-0.1 + 1e-9, 0.1 - 1e-9}));
  EXPECT_LT(now[0].Width(), 0.201);
}

TEST_F(Flows, EncloseTheLogisticCurve) {
  Use({arena_.Mul(x_, arena_.Sub(Num("1"), x_)), Num("0")});
  Flow flow(dynamics_, monomials_, {}, 4);
  flow.Start(FromBox({{0.1, 0.2}, {0, 0}}, *monomials_, {0, -1}), 0);
  for (const double until : {1.0, 2.0, 4.0}) {
    ASSERT_TRUE(Follow(flow, until));
    for (const double x : {0.1, 0.13, 0.2}) ExpectHolds(flow.Now()[0], x / (x + (1 - x) * std::exp(-until)));
  }
}

TEST_F(Flows, MeetTheInstantThatIsAskedFor) {
  Oscillate();
  Flow flow(dynamics_, monomials_, {}, 1);
  flow.Start(FromBox({{1, 1}, {0, 0}}, *monomials_, {-1, -1}), 0.25);
  ASSERT_TRUE(Follow(flow, 0.3));
  EXPECT_EQ(flow.time(), 0.3);
  EXPECT_GE(flow.begin(), 0.25);
  EXPECT_GE(flow.steps(), 1u);
}

TEST_F(Flows, LoseWhatBlowsUp) {
  Use({arena_.Mul(x_, x_), Num("0")});
  Flow flow(dynamics_, monomials_, {}, 2);
  flow.Start(FromBox({{1, 1}, {0, 0}}, *monomials_, {-1, -1}), 0);
  EXPECT_FALSE(Follow(flow, 2));
  EXPECT_LT(flow.time(), 1);
}

TEST_F(Flows, EncloseEveryConstantInput) {
  Use({arena_.Sub(w_, x_), Num("0")}, {{-1, 2}});
  Flow flow(dynamics_, monomials_, {}, 1);
  flow.Start(FromBox({{0, 0}, {0, 0}}, *monomials_, {-1, -1}), 0);
  ASSERT_TRUE(Follow(flow, 1));
  ExpectHolds(flow.Now()[0], -(1 - std::exp(-1)));
  ExpectHolds(flow.Now()[0], 2 * (1 - std::exp(-1)));
}

// The end of a step stands for every instant that rounds to it, and inputs push until then.
TEST_F(Flows, EncloseWhatInputsDoUntilAnInstantThatIsRounded) {
  Use({w_, Num("0")}, {{-1, 1}});
  Flow flow(dynamics_, monomials_, {}, 1e-3);
  const double from = 0x1p20;
  flow.Start(FromBox({{0, 0}, {0, 0}}, *monomials_, {-1, -1}), from);
  ASSERT_TRUE(Follow(flow, from + 0x1p-20));
  ExpectHolds(flow.Now()[0], 0x1p-20 + 0x1p-34);
}

}  // namespace
}  // namespace rondo::reach
