#include "solve/icp/existence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solve/icp/prepare/real_variables_test.h"

namespace rondo::solve::icp {
namespace {

class Existences : public RealVariables {
 protected:
  // Bounds by variable, around a point, where all of these terms are 0.
  std::optional<std::map<TermId, interval::Interval>> Around(const std::vector<TermId>& zeros,
                                                             const std::map<TermId, double>& near) {
    Prepared prepared;
    for (const TermId z : zeros) {
      const auto literal = AsLiteral(arena_, arena_.Eq(z, Number("0")));
      prepared.ranges[literal->term].Add(kEqual, literal->bound);
    }
    const Tape tape = BuildTape(arena_, variables_, prepared);
    Existence existence(tape, interval::BestKernels());
    EXPECT_EQ(existence.equations(), zeros.size());
    std::vector<double> point;
    for (const TapeVariable& v : tape.variables) point.push_back(near.at(v.term));
    const auto box = existence.Around(point);
    if (!box) return std::nullopt;
    std::map<TermId, interval::Interval> result;
    for (size_t v = 0; v < point.size(); ++v)
      result[tape.variables[v].term] = {(*box)[2 * v], (*box)[2 * v + 1]};
    return result;
  }

  const TermId x_ = Variable("x", icp::Variable::Kind::kReal), y_ = Variable("y", icp::Variable::Kind::kReal);
  const TermId n_ = Variable("n", icp::Variable::Kind::kInt);
  const TermId xx_ = arena_.Mul(x_, x_), yy_ = arena_.Mul(y_, y_);
};

TEST_F(Existences, ARootIsEnclosed) {
  const auto box = Around({arena_.Sub(xx_, Number("2"))}, {{x_, 1.41421356237}});
  ASSERT_TRUE(box.has_value());
  const Rational lo = Rational::FromDouble(box->at(x_).lo), hi = Rational::FromDouble(box->at(x_).hi);
  EXPECT_TRUE(lo * lo < Rational(2) && Rational(2) < hi * hi);
}

TEST_F(Existences, NothingIsClaimedFarFromARoot) {
  EXPECT_FALSE(Around({arena_.Sub(xx_, Number("2"))}, {{x_, 1.5}}));
}

TEST_F(Existences, NothingIsClaimedWhereThereIsNone) {
  EXPECT_FALSE(Around({arena_.Add(xx_, Number("1e-12"))}, {{x_, 0}}));
  EXPECT_FALSE(Around({arena_.Add(arena_.Sub(xx_, y_), Number("0")), arena_.Add(y_, Number("1e-12"))},
                      {{x_, 0}, {y_, 0}}));
}

TEST_F(Existences, TouchingIsNotProved) { EXPECT_FALSE(Around({xx_}, {{x_, 0}})); }

TEST_F(Existences, SystemsAreSolvedTogether) {
  const double root = std::sqrt(0.5);
  const auto box = Around({arena_.Sub(arena_.Add(xx_, yy_), Number("1")), arena_.Sub(x_, y_)},
                          {{x_, root + 1e-10}, {y_, root - 1e-10}});
  ASSERT_TRUE(box.has_value());
  EXPECT_TRUE(box->at(x_).Contains(root) && box->at(y_).Contains(root));
}

TEST_F(Existences, WhatNeedNotMoveStays) {
  const auto box = Around({arena_.Sub(arena_.Add(xx_, yy_), Number("1"))}, {{x_, 0.6}, {y_, 0.8}});
  ASSERT_TRUE(box.has_value());
  EXPECT_NE(box->at(x_).IsPoint(), box->at(y_).IsPoint());
}

TEST_F(Existences, IntegersDoNotMove) {
  EXPECT_FALSE(Around({arena_.Sub(arena_.Mul(n_, n_), Number("2"))}, {{n_, 1.41421356237}}));
  const auto box = Around({arena_.Sub(arena_.Mul(n_, x_), Number("2"))}, {{n_, 3}, {x_, 0.666666666666}});
  ASSERT_TRUE(box.has_value());
  EXPECT_EQ(box->at(n_), interval::Interval::Point(3));
}

TEST_F(Existences, MoreEquationsThanVariablesAreNotSolved) {
  EXPECT_FALSE(
      Around({arena_.Sub(xx_, Number("1")), arena_.Sub(arena_.Mul(xx_, x_), Number("1"))}, {{x_, 1}}));
}

TEST_F(Existences, CornersAreNotProved) {
  const TermId size = arena_.Apply(expr::Elementary::kAbs, {x_});
  EXPECT_FALSE(Around({arena_.Sub(size, Number("0.5"))}, {{x_, 0.5}}));
}

TEST_F(Existences, LemmasAreNoEquations) {
  Prepared prepared;
  prepared.ranges[xx_].Add(kLess, 1);
  prepared.lemmas = {{{{Rational(1), xx_}, {Rational(-1), xx_}}, Rational(0)}};
  const Tape tape = BuildTape(arena_, variables_, prepared);
  Existence existence(tape, interval::BestKernels());
  EXPECT_EQ(existence.equations(), 0u);
  EXPECT_FALSE(existence.Around({0.5}));
}

}  // namespace
}  // namespace rondo::solve::icp
