#include "solve/icp/tape/descent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "expr/numeric.h"
#include "expr/smtlib/smtlib.h"
#include "solve/icp/prepare/real_variables_test.h"

namespace rondo::solve::icp {
namespace {

using expr::Arena;
using expr::Elementary;

class Descents : public RealVariables {
 protected:
  Tape TapeOf(const std::vector<TermId>& formulas) {
    Prepared prepared;
    prepared.disjunctions = formulas;
    return BuildTape(arena_, variables_, prepared);
  }
  static std::vector<double> Box(const Tape& tape, double lo, double hi) {
    std::vector<double> box;
    for (size_t v = 0; v < tape.variables.size(); ++v) box.insert(box.end(), {lo, hi});
    return box;
  }
  // The first point that is found in twelve attempts.
  std::optional<std::vector<double>> Find(const Tape& tape, double lo = -10, double hi = 10) {
    Descent descent(tape, Box(tape, lo, hi));
    for (int i = 0; i < 12; ++i) {
      if (auto point = descent.Try()) return point;
    }
    return std::nullopt;
  }
  double Violation(const Tape& tape, const std::vector<double>& point, TermId formula) {
    expr::Numeric::Point at;
    for (size_t v = 0; v < point.size(); ++v) at[tape.variables[v].term] = point[v];
    return expr::Numeric(arena_, at).Violation(formula);
  }

  const TermId x_ = Variable("x", icp::Variable::Kind::kReal), y_ = Variable("y", icp::Variable::Kind::kReal);
  const TermId n_ = Variable("n", icp::Variable::Kind::kInt);
  const TermId xx_ = arena_.Mul(x_, x_), yy_ = arena_.Mul(y_, y_), xy_ = arena_.Mul(x_, y_);
};

TEST_F(Descents, WhatIsFoundSeemsToHold) {
  Arena& a = arena_;
  const TermId wave = a.Apply(Elementary::kSin, {x_});
  for (const TermId f :
       {a.And(a.Eq(a.Add(xx_, yy_), Number("4")), a.Eq(xy_, Number("1"))),
        a.And(a.Le(a.Add(xx_, yy_), Number("1")), a.Lt(Number("0.4"), xy_)),
        a.Or(a.Lt(xx_, Number("-1")), a.Eq(wave, Number("0.5"))),
        a.And(a.Eq(a.Apply(Elementary::kExp, {x_}), y_), a.Lt(Number("3"), y_)),
        a.Eq(a.Divide(x_, a.Add(yy_, Number("1"))), Number("0.5")), a.Not(a.Eq(xy_, Number("0")))}) {
    const Tape tape = TapeOf({f});
    const auto point = Find(tape);
    ASSERT_TRUE(point.has_value()) << expr::ToSmtLib(arena_, f);
    EXPECT_LE(Violation(tape, *point, f), 1e-8);
  }
}

TEST_F(Descents, PointsStayInTheBox) {
  const Tape tape = TapeOf({arena_.Le(Number("3"), arena_.Add(x_, y_))});
  Descent descent(tape, Box(tape, 1, 2));
  for (int i = 0; i < 20; ++i) {
    const auto point = descent.Try();
    if (!point) continue;
    for (const double p : *point) EXPECT_TRUE(1 <= p && p <= 2) << p;
  }
}

TEST_F(Descents, IntegersAreWhole) {
  const Tape tape = TapeOf({arena_.Lt(Number("2.5"), arena_.Add(n_, x_)), arena_.Le(x_, Number("0.25"))});
  const auto point = Find(tape);
  ASSERT_TRUE(point.has_value());
  for (size_t v = 0; v < point->size(); ++v)
    EXPECT_TRUE(!tape.variables[v].integral || std::round((*point)[v]) == (*point)[v]);
}

TEST_F(Descents, NothingIsFoundWhereNothingHolds) {
  EXPECT_FALSE(Find(TapeOf({arena_.Eq(xx_, Number("-1"))})));
  EXPECT_FALSE(Find(TapeOf({arena_.Lt(x_, Number("1")), arena_.Lt(Number("1"), x_)})));
  EXPECT_FALSE(Find(TapeOf({arena_.Le(Number("30"), arena_.Add(x_, y_))})));
}

TEST_F(Descents, TheSameQuestionGivesTheSamePoints) {
  const Tape tape = TapeOf({arena_.Eq(arena_.Add(xx_, yy_), Number("4"))});
  Descent first(tape, Box(tape, -10, 10)), second(tape, Box(tape, -10, 10));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(first.Try(), second.Try());
}

TEST_F(Descents, AttemptsBeginElsewhere) {
  const Tape tape = TapeOf({arena_.Le(x_, Number("100"))});
  Descent descent(tape, Box(tape, -10, 10));
  EXPECT_NE(descent.Try(), descent.Try());
}

TEST_F(Descents, UnboundedVariablesAreNoObstacle) {
  const Tape tape = TapeOf({arena_.Eq(xy_, Number("7")), arena_.Lt(Number("50"), x_)});
  const auto point = Find(tape, -INFINITY, INFINITY);
  ASSERT_TRUE(point.has_value());
  EXPECT_TRUE(std::isfinite((*point)[0]) && std::isfinite((*point)[1]));
}

}  // namespace
}  // namespace rondo::solve::icp
