#include "solve/icp/tape/influence.h"

#include <gtest/gtest.h>

#include "expr/numeric.h"
#include "solve/icp/prepare/real_variables_test.h"
#include "solve/icp/tape/contractor.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;

class Influence : public RealVariables {
 protected:
  // The term, as it is, and behind it x + 2y, so that both variables occur.
  Tape TapeOf(TermId term) {
    Prepared prepared;
    const TermId last = arena_.Add(x_, arena_.Mul(Number("2"), y_));
    prepared.ranges[term].Add(kLess | kEqual, 0);
    prepared.disjunctions = {arena_.Le(last, Number("0"))};
    return BuildTape(arena_, variables_, prepared);
  }
  // Encloses everything over [x, x + w] * [y, y + w].
  std::vector<interval::Batch> Values(const Tape& tape, double x, double y, double w) {
    Contractor contractor(tape, interval::BestKernels());
    std::vector<double> box;
    for (const TapeVariable& v : tape.variables) {
      const double low = v.term == x_ ? x : y;
      box.insert(box.end(), {low, low + w});
    }
    for (int l = 0; l < kLanes; ++l) contractor.Load(l, box.data());
    contractor.Evaluate();
    return contractor.values();
  }
  double Score(const Tape& tape, const std::vector<double>& scores, TermId variable) {
    for (size_t v = 0; v < tape.variables.size(); ++v) {
      if (tape.variables[v].term == variable) return scores[v * kLanes];
    }
    return -1;
  }
  std::vector<double> Scores(const Tape& tape, const std::vector<Lanes>& open) {
    InfluenceMeter meter(tape, interval::BestKernels());
    std::vector<double> scores;
    meter.Measure(Values(tape, 1, 1, 0.5), open, scores);
    return scores;
  }

  const TermId x_ = Variable("x"), y_ = Variable("y");
};

TEST_F(Influence, ScoresAreSharesOfTheSlopes) {
  const Tape tape = TapeOf(arena_.Mul(x_, y_));
  const std::vector<double> scores = Scores(tape, {0, 0xff});
  EXPECT_NEAR(Score(tape, scores, x_), 1.0 / 3, 1e-12);
  EXPECT_NEAR(Score(tape, scores, y_), 2.0 / 3, 1e-12);
}

TEST_F(Influence, EachOpenComparisonGivesOneInAll) {
  const Tape tape = TapeOf(arena_.Mul(x_, Call(Elementary::kSin, y_)));
  const std::vector<double> scores = Scores(tape, {0xff, 0xff});
  EXPECT_NEAR(Score(tape, scores, x_) + Score(tape, scores, y_), 2, 1e-12);
}

TEST_F(Influence, DecidedComparisonsDoNotCount) {
  const Tape tape = TapeOf(arena_.Mul(x_, x_));
  for (const double s : Scores(tape, {0, 0})) EXPECT_EQ(s, 0);
  EXPECT_EQ(Score(tape, Scores(tape, {0xff, 0}), y_), 0);
}

TEST_F(Influence, LanesCountForThemselves) {
  const Tape tape = TapeOf(arena_.Mul(x_, y_));
  const std::vector<double> scores = Scores(tape, {0, 0x02});
  EXPECT_EQ(scores[0], 0);
  EXPECT_GT(scores[1], 0);
}

TEST_F(Influence, LemmasDoNotCount) {
  Tape tape = TapeOf(arena_.Mul(x_, y_));
  for (Threshold& t : tape.thresholds) t.lemma = true;
  for (const double s : Scores(tape, {0xff, 0xff})) EXPECT_EQ(s, 0);
}

TEST_F(Influence, GradientsEncloseDerivatives) {
  const TermId xy = arena_.Mul(x_, y_), xx = arena_.Mul(x_, x_);
  const std::vector<TermId> terms{arena_.Sub(xy, arena_.Mul(Number("3"), x_)),
                                  arena_.Mul(xx, x_),
                                  arena_.Mul(arena_.Neg(y_), xx),
                                  Call(Elementary::kSin, xy),
                                  Call(Elementary::kCos, arena_.Add(x_, xx)),
                                  Call(Elementary::kExp, xy),
                                  Call(Elementary::kLog, xy),
                                  Call(Elementary::kSqrt, arena_.Add(xx, y_)),
                                  Call(Elementary::kAtan, xy),
                                  arena_.Divide(x_, arena_.Add(y_, xx))};
  for (size_t t = 0; t < terms.size(); ++t) {
    const Tape tape = TapeOf(terms[t]);
    InfluenceMeter meter(tape, interval::BestKernels());
    std::vector<interval::Interval> gradient;
    ASSERT_TRUE(meter.Gradient(tape.nodes[tape.thresholds[0].node].a, Values(tape, 0.5, 1, 0.25), gradient))
        << t;
    for (const double x : {0.5, 0.6, 0.75}) {
      for (const double y : {1.0, 1.1, 1.25}) {
        for (size_t v = 0; v < tape.variables.size(); ++v) {
          const auto at = [&](double d) {
            const bool is_x = tape.variables[v].term == x_;
            return expr::Numeric(arena_, {{x_, is_x ? x + d : x}, {y_, is_x ? y : y + d}})(terms[t]);
          };
          const double slope = (at(1e-5) - at(-1e-5)) / 2e-5;
          EXPECT_LE(gradient[v].lo, slope + 1e-6) << t;
          EXPECT_GE(gradient[v].hi, slope - 1e-6) << t;
        }
      }
    }
  }
}

TEST_F(Influence, WhatDoesNotOccurHasNoSlope) {
  const Tape tape = TapeOf(Call(Elementary::kSin, x_));
  InfluenceMeter meter(tape, interval::BestKernels());
  std::vector<interval::Interval> gradient;
  ASSERT_TRUE(meter.Gradient(tape.nodes[tape.thresholds[0].node].a, Values(tape, 0, 0, 1), gradient));
  for (size_t v = 0; v < gradient.size(); ++v)
    EXPECT_EQ(gradient[v] == interval::Interval::Point(0), tape.variables[v].term == y_);
}

TEST_F(Influence, CornersHaveNoGradient) {
  for (const TermId t : {Call(Elementary::kAbs, x_), arena_.Apply(Elementary::kMin, {x_, y_}),
                         arena_.Apply(Elementary::kMax, {x_, y_}), arena_.Apply(Elementary::kAtan2, {x_, y_}),
                         arena_.Mul(y_, arena_.Ite(arena_.Lt(x_, y_), x_, y_)), Call(Elementary::kTan, x_)}) {
    const Tape tape = TapeOf(t);
    InfluenceMeter meter(tape, interval::BestKernels());
    std::vector<interval::Interval> gradient;
    const uint32_t node = tape.nodes[tape.thresholds[tape.thresholds.size() - 2].node].a;
    EXPECT_FALSE(meter.Gradient(node, Values(tape, -1, -1, 2), gradient));
  }
}

}  // namespace
}  // namespace rondo::solve::icp
