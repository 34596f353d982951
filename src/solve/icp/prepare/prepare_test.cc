#include "solve/icp/prepare/prepare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "expr/evaluate.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;

Range RangeOf(std::vector<std::pair<int, int>> comparisons) {
  Range range;
  for (const auto& [relation, bound] : comparisons) range.Add(static_cast<Relation>(relation), bound);
  return range;
}

TEST(Ranges, TheTighterBoundCounts) {
  const Range r =
      RangeOf({{kLess | kEqual, 3}, {kLess, 2}, {kLess | kEqual, 5}, {kGreater, 0}, {kGreater, -1}});
  EXPECT_EQ(*r.hi, Rational(2));
  EXPECT_TRUE(r.hi_strict);
  EXPECT_EQ(*r.lo, Rational(0));
}

TEST(Ranges, AStrictBoundIsTighterThanTheSameOne) {
  EXPECT_TRUE(RangeOf({{kLess | kEqual, 1}, {kLess, 1}}).hi_strict);
  EXPECT_TRUE(RangeOf({{kLess, 1}, {kLess | kEqual, 1}}).hi_strict);
  EXPECT_TRUE(RangeOf({{kGreater, 1}, {kGreater | kEqual, 1}}).lo_strict);
}

TEST(Ranges, AnEquationLeavesOneValue) {
  EXPECT_EQ(RangeOf({{kEqual, 4}}).Only(), Rational(4));
  EXPECT_FALSE(RangeOf({{kLess | kEqual, 4}}).Only().has_value());
}

TEST(Ranges, WhatHasNoMemberIsAContradiction) {
  EXPECT_TRUE(RangeOf({{kEqual, 1}, {kEqual, 2}}).IsContradiction());
  EXPECT_TRUE(RangeOf({{kGreater | kEqual, 1}, {kLess, 1}}).IsContradiction());
  EXPECT_TRUE(RangeOf({{kEqual, 1}, {kLess | kGreater, 1}}).IsContradiction());
  EXPECT_FALSE(RangeOf({{kGreater | kEqual, 1}, {kLess | kEqual, 1}}).IsContradiction());
  EXPECT_FALSE(RangeOf({{kGreater, 1}, {kLess, 2}}).IsContradiction());
  EXPECT_FALSE(RangeOf({{kGreater, 1}, {kLess | kGreater, 1}}).IsContradiction());
}

TEST(Ranges, LiteralsSayWhatWasAdded) {
  for (const Range& r : {RangeOf({{kGreater, -1}, {kLess | kEqual, 2}, {kLess | kGreater, 0}}),
                         RangeOf({{kGreater | kEqual, 0}, {kLess, 2}}), RangeOf({{kEqual, 1}}), Range()}) {
    for (int x = -3; x <= 3; ++x) {
      const bool inside = (!r.lo || Holds(x, r.lo_strict ? kGreater : kGreater | kEqual, *r.lo)) &&
                          (!r.hi || Holds(x, r.hi_strict ? kLess : kLess | kEqual, *r.hi)) &&
                          std::ranges::count(r.excluded, Rational(x)) == 0;
      bool all = true;
      for (const Literal& l : r.Literals(TermId())) all = all && Holds(x, l.relation, l.bound);
      EXPECT_EQ(all, inside) << x;
    }
  }
}

class Preparing : public testing::Test {
 protected:
  TermId Number(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Variable(const char* name, icp::Variable::Kind kind) {
    const TermId v = arena_.Variable(arena_.Declare(name, {}, arena_.Real()));
    variables_.emplace(v, icp::Variable{v, kind});
    return v;
  }
  TermId Sqrt(TermId t) { return arena_.Apply(Elementary::kSqrt, {t}); }
  TermId Squares(TermId a, TermId b) { return arena_.Add(arena_.Mul(a, a), arena_.Mul(b, b)); }
  Prepared Of(std::vector<TermId> conjuncts) { return Prepare(arena_, variables_, std::move(conjuncts), {}); }
  bool Contradict(std::vector<TermId> conjuncts) { return Of(std::move(conjuncts)).contradiction; }

  using Point = std::unordered_map<TermId, Rational>;
  std::optional<expr::Value> At(const Point& point, TermId t) const {
    return expr::Evaluate(arena_, t, [&](TermId v) -> std::optional<expr::Value> {
      const auto it = point.find(v);
      return it == point.end() ? std::nullopt : std::optional(expr::Value{it->second});
    });
  }
  bool Holds(const Point& point, const std::vector<TermId>& all) const {
    return std::ranges::all_of(all, [&](TermId f) {
      const auto truth = At(point, f);
      return truth && truth->AsBool();
    });
  }

  expr::Arena arena_;
  std::unordered_map<TermId, icp::Variable> variables_;
  const TermId x_ = Variable("x", icp::Variable::Kind::kReal), y_ = Variable("y", icp::Variable::Kind::kReal);
  const TermId z_ = Variable("z", icp::Variable::Kind::kReal), n_ = Variable("n", icp::Variable::Kind::kInt);
  const TermId zero_ = Number("0"), one_ = Number("1");
};

TEST_F(Preparing, LinearEquationsAreSolved) {
  const Prepared p =
      Of({arena_.Eq(arena_.Add(x_, y_), Number("3")), arena_.Eq(arena_.Sub(x_, y_), Number("1"))});
  ASSERT_FALSE(p.contradiction);
  const std::map<TermId, TermId> defined(p.definitions.begin(), p.definitions.end());
  EXPECT_EQ(defined.at(x_), Number("2"));
  EXPECT_EQ(defined.at(y_), Number("1"));
}

TEST_F(Preparing, EquationsThatContradictEachOtherAreFound) {
  const TermId sum = arena_.Add(x_, y_);
  EXPECT_TRUE(Contradict({arena_.Eq(sum, one_), arena_.Eq(sum, Number("2"))}));
  EXPECT_TRUE(
      Contradict({arena_.Eq(sum, Number("3")), arena_.Eq(arena_.Mul(Number("-2"), sum), Number("-7"))}));
  EXPECT_FALSE(Contradict({arena_.Eq(sum, one_), arena_.Eq(arena_.Sub(x_, y_), one_)}));
}

TEST_F(Preparing, ComparisonsOfOneTermMeet) {
  const TermId t = arena_.Add(arena_.Mul(x_, y_), z_);
  EXPECT_TRUE(Contradict({arena_.Lt(t, one_), arena_.Le(Number("2"), arena_.Mul(Number("2"), t))}));
  EXPECT_FALSE(Contradict({arena_.Le(t, one_), arena_.Le(Number("2"), arena_.Mul(Number("2"), t))}));
}

TEST_F(Preparing, BoundsOfIntegersAreIntegers) {
  const Prepared p = Of({arena_.Lt(Number("0.5"), n_), arena_.Lt(n_, Number("4"))});
  const Range& range = p.ranges.at(n_);
  EXPECT_EQ(range.lo, Rational(1));
  EXPECT_EQ(range.hi, Rational(3));
  EXPECT_FALSE(range.lo_strict || range.hi_strict);
}

TEST_F(Preparing, BetweenNeighboursIsNoInteger) {
  EXPECT_TRUE(Contradict({arena_.Lt(zero_, n_), arena_.Lt(n_, one_)}));
  EXPECT_TRUE(Contradict({arena_.Eq(arena_.Mul(Number("2"), n_), Number("3"))}));
  EXPECT_FALSE(Contradict({arena_.Lt(zero_, x_), arena_.Lt(x_, one_)}));
}

TEST_F(Preparing, ExcludedEndsOfIntegersMove) {
  const auto differs = [&](const char* n) { return arena_.Not(arena_.Eq(n_, Number(n))); };
  const std::vector<TermId> bounds{arena_.Le(zero_, n_), arena_.Le(n_, Number("2"))};
  EXPECT_TRUE(Contradict({bounds[0], bounds[1], differs("0"), differs("1"), differs("2")}));
  const Prepared p = Of({bounds[0], bounds[1], differs("0"), differs("2")});
  ASSERT_EQ(p.definitions.size(), 1u);
  EXPECT_EQ(p.definitions[0].second, one_);
}

TEST_F(Preparing, SquaresThatVanishVanishOneByOne) {
  const Prepared p = Of({arena_.Le(Squares(arena_.Sub(x_, one_), y_), zero_)});
  ASSERT_FALSE(p.contradiction);
  const std::map<TermId, TermId> defined(p.definitions.begin(), p.definitions.end());
  EXPECT_EQ(defined.at(x_), one_);
  EXPECT_EQ(defined.at(y_), zero_);
}

TEST_F(Preparing, SquaresAreNeverNegative) {
  EXPECT_TRUE(Contradict({arena_.Lt(Squares(x_, y_), zero_)}));
  EXPECT_TRUE(Contradict({arena_.Le(Squares(x_, y_), Number("-1"))}));
  EXPECT_FALSE(Contradict({arena_.Le(arena_.Sub(arena_.Mul(x_, x_), arena_.Mul(y_, y_)), Number("-1"))}));
}

TEST_F(Preparing, BoundsOfRootsAreBoundsOfTheirArguments) {
  const Prepared p = Of({arena_.Le(Sqrt(x_), Number("3"))});
  EXPECT_EQ(p.ranges.at(x_).lo, Rational(0));
  EXPECT_EQ(p.ranges.at(x_).hi, Rational(9));
  const Prepared q = Of({arena_.Lt(Number("-1"), Sqrt(x_))});
  EXPECT_EQ(q.ranges.at(x_).lo, Rational(0));
  EXPECT_FALSE(q.ranges.at(x_).hi.has_value());
}

TEST_F(Preparing, RootsAreNeverNegative) {
  EXPECT_TRUE(Contradict({arena_.Lt(Sqrt(x_), zero_)}));
  EXPECT_TRUE(Contradict({arena_.Eq(Sqrt(x_), Number("-2"))}));
  EXPECT_TRUE(Contradict({arena_.Le(Sqrt(x_), one_), arena_.Lt(x_, zero_)}));
}

TEST_F(Preparing, WhatAnEliminatedTermNeedsStays) {
  const auto lo = [&](Elementary f) {
    const Prepared p = Of({arena_.Eq(y_, arena_.Apply(f, {x_})), arena_.Le(y_, one_)});
    const auto it = p.ranges.find(x_);
    return it == p.ranges.end() ? std::nullopt : it->second.lo;
  };
  EXPECT_EQ(lo(Elementary::kLog), Rational(0));
  EXPECT_EQ(lo(Elementary::kSqrt), Rational(0));
  EXPECT_EQ(lo(Elementary::kAsin), Rational(-1));
  EXPECT_EQ(lo(Elementary::kSin), std::nullopt);
}

TEST_F(Preparing, SolutionsAreTheSameUpToDefinitions) {
  const TermId sum = arena_.Add(x_, arena_.Mul(Number("2"), y_)), xy = arena_.Mul(x_, y_);
  const TermId either = arena_.Or(arena_.Lt(x_, zero_), arena_.Eq(y_, one_));
  const std::vector<std::vector<TermId>> questions{
      {arena_.Eq(sum, Number("2")), arena_.Le(xy, zero_)},
      {arena_.Eq(arena_.Add(sum, z_), one_), arena_.Lt(zero_, xy), either},
      {arena_.Eq(z_, xy), arena_.Le(z_, one_), arena_.Not(arena_.Eq(x_, y_))},
      {arena_.Le(Squares(x_, y_), Number("2")), either, arena_.Eq(z_, arena_.Mul(x_, x_))},
      {arena_.Eq(arena_.Add(n_, arena_.Mul(Number("1/2"), x_)), y_), arena_.Le(zero_, n_), either}};
  for (const std::vector<TermId>& question : questions) {
    const Prepared p = Of(question);
    ASSERT_FALSE(p.contradiction);
    const std::vector<TermId> rest = Conjuncts(arena_, p);
    int solutions = 0;
    for (int i = 0; i < 6 * 6 * 6 * 6; ++i) {
      Point point{{x_, i % 6 - 3}, {y_, i / 6 % 6 - 3}, {z_, i / 36 % 6 - 3}, {n_, i / 216 - 3}};
      const bool fits = std::ranges::all_of(
          p.definitions, [&](const auto& d) { return At(point, d.second)->AsNumber() == point.at(d.first); });
      solutions += Holds(point, question) ? 1 : 0;
      EXPECT_EQ(Holds(point, question), fits && Holds(point, rest));
    }
    EXPECT_GT(solutions, 0);
  }
}

TEST_F(Preparing, EarlierDefinitionsAreKeptUpToDate) {
  const Prepared p = Prepare(arena_, variables_, {arena_.Eq(x_, Number("2"))}, {{z_, arena_.Add(x_, one_)}});
  const std::map<TermId, TermId> defined(p.definitions.begin(), p.definitions.end());
  EXPECT_EQ(defined.at(z_), Number("3"));
}

TEST_F(Preparing, FalseIsAContradiction) {
  EXPECT_TRUE(Contradict({arena_.Lt(x_, y_), arena_.False()}));
  EXPECT_FALSE(Contradict({arena_.True()}));
}

}  // namespace
}  // namespace rondo::solve::icp
