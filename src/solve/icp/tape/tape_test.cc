#include "solve/icp/tape/tape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "expr/numeric.h"
#include "solve/icp/prepare/real_variables_test.h"
#include "solve/icp/tape/contractor.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;

class Tapes : public RealVariables {
 protected:
  using RealVariables::Call;
  TermId Call(Elementary f, TermId a, TermId b) { return arena_.Apply(f, {a, b}); }
  Tape Compare(TermId term) {
    Prepared prepared;
    prepared.ranges[term].Add(kLess | kEqual, 5);
    return BuildTape(arena_, variables_, prepared);
  }
  // An enclosure of the compared term at a point.
  interval::Interval At(const Tape& tape, const expr::Numeric::Point& point) {
    Contractor contractor(tape, interval::BestKernels());
    std::vector<double> box;
    for (const TapeVariable& v : tape.variables) box.insert(box.end(), 2, point.at(v.term));
    for (int l = 0; l < kLanes; ++l) contractor.Load(l, box.data());
    contractor.Evaluate();
    return contractor.ValueOf(tape.nodes[tape.thresholds.back().node].a, 0);
  }
  std::vector<TermId> Terms() {
    const TermId xy = arena_.Mul(x_, y_), positive = arena_.Add(arena_.Mul(x_, x_), Number("0.1"));
    const TermId unit = Call(Elementary::kSin, x_);
    return {arena_.Add({x_, arena_.Mul(Number("-3"), y_), Number("0.7")}),
            arena_.Add({arena_.Neg(x_), arena_.Neg(y_), xy}),
            arena_.Mul(Number("2.5"), arena_.Mul(xy, arena_.Mul(x_, x_))),
            arena_.Mul(y_, arena_.Mul(y_, y_)),
            arena_.Divide(x_, positive),
            arena_.Ite(arena_.Lt(x_, y_), xy, arena_.Add(x_, Number("1"))),
            Call(Elementary::kSqrt, positive),
            Call(Elementary::kAbs, xy),
            Call(Elementary::kMin, x_, y_),
            Call(Elementary::kMax, x_, y_),
            Call(Elementary::kSin, xy),
            Call(Elementary::kCos, arena_.Sub(x_, y_)),
            Call(Elementary::kTan, x_),
            Call(Elementary::kAsin, unit),
            Call(Elementary::kAcos, unit),
            Call(Elementary::kAtan, xy),
            Call(Elementary::kAtan2, y_, x_),
            Call(Elementary::kExp, x_),
            Call(Elementary::kLog, positive),
            Call(Elementary::kPower, positive, y_)};
  }

  const TermId x_ = Variable("x"), y_ = Variable("y");
};

TEST_F(Tapes, ValuesAgreeWithPlainNumbers) {
  const std::vector<TermId> terms = Terms();
  for (size_t t = 0; t < terms.size(); ++t) {
    const Tape tape = Compare(terms[t]);
    for (const double x : {-1.4, -0.3, 0.6, 1.3}) {
      for (const double y : {-1.1, 0.4, 1.2}) {
        const expr::Numeric::Point point{{x_, x}, {y_, y}};
        const double value = expr::Numeric(arena_, point)(terms[t]);
        const interval::Interval range = At(tape, point);
        EXPECT_NEAR(range.lo, value, 1e-12) << "term " << t << " at " << x << " " << y;
        EXPECT_NEAR(range.hi, value, 1e-12) << "term " << t << " at " << x << " " << y;
        EXPECT_LE(range.lo, range.hi);
      }
    }
  }
}

TEST_F(Tapes, ArgumentsComeBeforeWhatUsesThem) {
  for (const TermId t : Terms()) {
    const Tape tape = Compare(t);
    for (uint32_t i = 0; i < tape.nodes.size(); ++i) {
      const Node& n = tape.nodes[i];
      EXPECT_TRUE(!IsComposite(n.op) || n.a < i);
      EXPECT_TRUE(!IsBinary(n.op) || n.b < i);
    }
  }
}

TEST_F(Tapes, EqualSubtermsAreOneNode) {
  const TermId wave = Call(Elementary::kSin, arena_.Mul(x_, y_));
  const Tape tape = Compare(arena_.Add(wave, arena_.Mul(wave, x_)));
  EXPECT_EQ(std::ranges::count(tape.nodes, NodeOp::kSin, &Node::op), 1);
  EXPECT_EQ(std::ranges::count(tape.nodes, NodeOp::kVariable, &Node::op), 2);
}

TEST_F(Tapes, RepeatedFactorsArePowers) {
  const Tape tape = Compare(arena_.Mul(arena_.Mul(x_, y_), arena_.Mul(arena_.Mul(y_, x_), y_)));
  EXPECT_EQ(std::ranges::count(tape.nodes, NodeOp::kSqr, &Node::op), 1);
  const auto power = std::ranges::find(tape.nodes, NodeOp::kPow, &Node::op);
  ASSERT_NE(power, tape.nodes.end());
  EXPECT_EQ(power->n, 3u);
  EXPECT_EQ(tape.variables[tape.nodes[power->a].a].term, y_);
}

TEST_F(Tapes, PartialFunctionsAreNoted) {
  for (const Elementary f :
       {Elementary::kSqrt, Elementary::kLog, Elementary::kAsin, Elementary::kAcos, Elementary::kTan})
    EXPECT_TRUE(Compare(Call(f, x_)).partial) << static_cast<int>(f);
  for (const Elementary f :
       {Elementary::kSin, Elementary::kCos, Elementary::kExp, Elementary::kAtan, Elementary::kAbs})
    EXPECT_FALSE(Compare(Call(f, x_)).partial) << static_cast<int>(f);
}

TEST_F(Tapes, BoundsOfVariablesAreRoundedOutwards) {
  Prepared prepared;
  const Rational third = Rational(1) / Rational(3), tenth = Rational(1) / Rational(10);
  prepared.ranges[x_].Add(kGreater | kEqual, tenth);
  prepared.ranges[x_].Add(kLess | kEqual, third);
  const interval::Interval root = BuildTape(arena_, variables_, prepared).variables.at(0).root;
  EXPECT_LE(Rational::FromDouble(root.lo), tenth);
  EXPECT_GE(Rational::FromDouble(root.hi), third);
  EXPECT_NEAR(root.lo, 0.1, 1e-15);
  EXPECT_NEAR(root.hi, 1.0 / 3, 1e-15);
}

TEST_F(Tapes, VariablesWithoutBoundsHaveTheWholeLine) {
  const Tape tape = Compare(arena_.Mul(x_, y_));
  for (const TapeVariable& v : tape.variables) EXPECT_EQ(v.root, interval::Interval());
}

TEST_F(Tapes, LemmasAreMarked) {
  Prepared prepared;
  prepared.ranges[arena_.Mul(x_, y_)].Add(kLess, 1);
  prepared.lemmas = {{{{Rational(2), x_}, {Rational(-1), y_}}, Rational(3)}};
  const Tape tape = BuildTape(arena_, variables_, prepared);
  ASSERT_EQ(tape.thresholds.size(), 2u);
  EXPECT_FALSE(tape.thresholds[0].lemma);
  EXPECT_TRUE(tape.thresholds[1].lemma);
  EXPECT_EQ(tape.thresholds[1].value, Rational(-3));
}

TEST_F(Tapes, ComparisonsWithOneNumberShareAThreshold) {
  Prepared prepared;
  const TermId xy = arena_.Mul(x_, y_), one = Number("1");
  prepared.disjunctions = {arena_.Or(arena_.Lt(xy, one), arena_.Eq(xy, one)),
                           arena_.Or(arena_.Lt(one, xy), arena_.Lt(x_, one))};
  EXPECT_EQ(BuildTape(arena_, variables_, prepared).thresholds.size(), 2u);
}

TEST(Enclosures, DoublesArePoints) {
  for (const double d : {0.0, 1.0, -0.75, 1e300, 0x1p-1000}) {
    const interval::Interval i = Enclose(Rational::FromDouble(d));
    EXPECT_EQ(i.lo, d);
    EXPECT_EQ(i.hi, d);
  }
}

TEST(Enclosures, OthersLieBetweenNeighbours) {
  for (const char* text : {"1/3", "-1/3", "0.1", "-0.7", "1e-20", "12345678901234567890.1"}) {
    const Rational value = *Rational::Parse(text);
    const interval::Interval i = Enclose(value);
    EXPECT_LT(Rational::FromDouble(i.lo), value);
    EXPECT_GT(Rational::FromDouble(i.hi), value);
    EXPECT_EQ(std::nextafter(i.lo, INFINITY), i.hi);
  }
}

TEST(Enclosures, WhatIsTooLargeReachesToInfinity) {
  const interval::Interval above = Enclose(*Rational::Parse("1e400"));
  EXPECT_TRUE(std::isfinite(above.lo));
  EXPECT_EQ(above.hi, INFINITY);
  const interval::Interval below = Enclose(*Rational::Parse("-1e400"));
  EXPECT_EQ(below.lo, -INFINITY);
  EXPECT_TRUE(std::isfinite(below.hi));
}

}  // namespace
}  // namespace rondo::solve::icp
