#include "solve/icp/verify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "expr/evaluate.h"

namespace rondo::solve::icp {
namespace {

using expr::Arena;
using expr::Elementary;

class Verifying : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name, expr::SortId sort) {
    return arena_.Variable(arena_.Declare(name, {}, sort));
  }
  // By name of the variables: the solution at or near a point of those that are left.
  std::optional<Solution> At(const std::vector<TermId>& formulas, const std::map<std::string, double>& near) {
    lowered_ = std::make_unique<Lowered>();
    Query query{&arena_, {}, {}};
    for (const TermId f : formulas) query.assertions.push_back({f, ""});
    Lower(query, *lowered_);
    Arena& arena = lowered_->arena;
    const Prepared prepared = Prepare(arena, lowered_->variables, lowered_->conjuncts, {});
    const Tape tape = BuildTape(arena, lowered_->variables, prepared);
    std::vector<double> point;
    for (const TapeVariable& v : tape.variables)
      point.push_back(near.at(arena.symbol(arena.symbol_of(v.term)).name));
    return Verifier(*lowered_, prepared, tape, interval::BestKernels()).Verify(point);
  }
  Rational ValueOf(const Solution& solution, TermId variable) const {
    for (const auto& [term, known] : lowered_->variables) {
      if (known.source == variable) return solution.values.at(term);
    }
    ADD_FAILURE() << "the variable does not occur";
    return {};
  }

  Arena arena_;
  std::unique_ptr<Lowered> lowered_;
  const TermId x_ = Variable("x", arena_.Real()), y_ = Variable("y", arena_.Real());
  const TermId xx_ = arena_.Mul(x_, x_), xy_ = arena_.Mul(x_, y_);
};

TEST_F(Verifying, PointsThatSatisfyTheQueryAreSolutions) {
  const auto solution = At({arena_.Eq(xy_, Number("1")), arena_.Lt(y_, x_)}, {{"x", 2}, {"y", 0.5}});
  ASSERT_TRUE(solution && solution->exact);
  EXPECT_EQ(ValueOf(*solution, x_) * ValueOf(*solution, y_), Rational(1));
}

TEST_F(Verifying, OthersAreNot) {
  EXPECT_FALSE(At({arena_.Lt(xy_, Number("1"))}, {{"x", 2}, {"y", 0.5}}));
  EXPECT_FALSE(At({arena_.Eq(xx_, Number("2"))}, {{"x", 1.5}}));
  EXPECT_FALSE(At({arena_.Lt(arena_.Mul(xx_, x_), Number("-1"))}, {{"x", -1}}));
}

TEST_F(Verifying, NumbersThatWereMeantAreFound) {
  const auto solution = At({arena_.Eq(arena_.Mul(xx_, x_), Number("0.125"))}, {{"x", 0.5 + 1e-11}});
  ASSERT_TRUE(solution && solution->exact);
  EXPECT_EQ(ValueOf(*solution, x_), Rational(1) / Rational(2));
}

TEST_F(Verifying, IrrationalSolutionsAreNear) {
  const auto solution =
      At({arena_.Eq(xx_, Number("2")), arena_.Lt(x_, Number("1.5"))}, {{"x", std::sqrt(2)}});
  ASSERT_TRUE(solution.has_value());
  EXPECT_FALSE(solution->exact);
  EXPECT_NEAR(ValueOf(*solution, x_).ToDouble(), std::sqrt(2), 1e-6);
}

TEST_F(Verifying, TheRestMustHoldAroundTheSolution) {
  EXPECT_FALSE(
      At({arena_.Eq(xx_, Number("2")), arena_.Lt(arena_.Mul(xx_, x_), Number("2"))}, {{"x", std::sqrt(2)}}));
}

TEST_F(Verifying, EliminatedVariablesHaveTheirValues) {
  const auto solution =
      At({arena_.Eq(arena_.Add(x_, y_), Number("3")), arena_.Le(arena_.Mul(xx_, y_), Number("4"))},
         {{"x", 0.25}, {"y", 0.25}});
  ASSERT_TRUE(solution && solution->exact);
  EXPECT_EQ(ValueOf(*solution, x_) + ValueOf(*solution, y_), Rational(3));
}

TEST_F(Verifying, IrrationalDefinitionsAreNotExact) {
  const auto solution =
      At({arena_.Eq(y_, arena_.Apply(Elementary::kExp, {x_})), arena_.Le(x_, Number("2"))}, {{"x", 1}});
  ASSERT_TRUE(solution.has_value());
  EXPECT_FALSE(solution->exact);
  EXPECT_NEAR(ValueOf(*solution, y_).ToDouble(), std::exp(1), 1e-9);
}

TEST_F(Verifying, PointsAtStrictBoundsMoveInside) {
  const auto solution = At(
      {arena_.Lt(Number("0"), x_), arena_.Lt(x_, Number("1")), arena_.Lt(arena_.Mul(xx_, x_), Number("5"))},
      {{"x", 1}});
  ASSERT_TRUE(solution && solution->exact);
  EXPECT_TRUE(Rational(0) < ValueOf(*solution, x_) && ValueOf(*solution, x_) < Rational(1));
}

TEST_F(Verifying, ExactSolutionsSatisfyEveryAssertion) {
  const TermId n = Variable("n", arena_.Int());
  const std::vector<TermId> all{arena_.Eq(arena_.ToReal(n), arena_.Mul(Number("2"), x_)),
                                arena_.Or(arena_.Le(Number("3"), x_), arena_.Lt(x_, y_)),
                                arena_.Not(arena_.Eq(y_, Number("0")))};
  const auto solution = At(all, {{"n", 3}, {"x", 1.5}, {"y", 4}});
  ASSERT_TRUE(solution && solution->exact);
  for (const TermId f : all) {
    const auto truth =
        expr::Evaluate(arena_, f, [&](TermId v) { return expr::Value{ValueOf(*solution, v)}; });
    EXPECT_TRUE(truth->AsBool());
  }
}

TEST_F(Verifying, WhatIsNoNumberIsNoPoint) {
  EXPECT_FALSE(At({arena_.Le(xx_, Number("1"))}, {{"x", NAN}}));
  EXPECT_FALSE(At({arena_.Le(Number("1"), xx_)}, {{"x", INFINITY}}));
}

}  // namespace
}  // namespace rondo::solve::icp
