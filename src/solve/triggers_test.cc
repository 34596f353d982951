#include "solve/triggers.h"

#include <gtest/gtest.h>

#include <set>

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::TermId;
using Terms = std::vector<TermId>;

class Triggers : public testing::Test {
 protected:
  TermId Constant(const char* name) { return arena_.Variable(arena_.Declare(name, {}, robot_)); }
  TermId P(TermId t) { return arena_.Apply(p_, Terms{t}); }
  TermId Q(TermId t) { return arena_.Apply(q_, Terms{t}); }
  TermId Near(TermId t, TermId u) { return arena_.Apply(near_, Terms{t, u}); }
  std::set<Terms> Match(const Terms& trigger, size_t limit = 100) {
    const auto found = MatchTrigger(arena_, index_, trigger, {x_, y_}, limit);
    return {found.begin(), found.end()};
  }

  Arena arena_;
  const expr::SortId robot_ = arena_.Opaque("Robot");
  const expr::SymbolId p_ = arena_.Declare("p", {robot_}, arena_.Bool());
  const expr::SymbolId q_ = arena_.Declare("q", {robot_}, arena_.Bool());
  const expr::SymbolId near_ = arena_.Declare("near", {robot_, robot_}, arena_.Bool());
  const expr::SymbolId next_ = arena_.Declare("next", {robot_}, robot_);
  const TermId x_ = arena_.FreshBound("x", robot_), y_ = arena_.FreshBound("y", robot_);
  const TermId a_ = Constant("a"), b_ = Constant("b"), c_ = Constant("c");
  PlaceIndex index_{arena_};
};

TEST_F(Triggers, OneApplicationOfAllVariablesIsEnough) {
  const auto found = FindTriggers(arena_, arena_.Or({P(x_), Near(x_, y_), Q(y_)}), {x_, y_});
  EXPECT_EQ(found, (std::vector<Terms>{{Near(x_, y_)}}));
}

TEST_F(Triggers, AllOfTheLeastSizeAreFound) {
  const auto found = FindTriggers(arena_, arena_.Or(Near(x_, y_), Near(y_, x_)), {x_, y_});
  EXPECT_EQ(found.size(), 2u);
}

TEST_F(Triggers, SeveralTogetherCoverTheVariables) {
  const auto found = FindTriggers(arena_, arena_.Or(P(x_), Q(y_)), {x_, y_});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(std::set<TermId>(found[0].begin(), found[0].end()), (std::set<TermId>{P(x_), Q(y_)}));
}

TEST_F(Triggers, WhatIsNotCoveredHasNone) {
  EXPECT_TRUE(FindTriggers(arena_, arena_.Or(P(x_), arena_.Eq(x_, y_)), {x_, y_}).empty());
}

TEST_F(Triggers, NestedArgumentsAreNoPatterns) {
  const TermId nested = Near(x_, arena_.Apply(next_, Terms{y_}));
  for (const Terms& trigger : FindTriggers(arena_, arena_.Or(nested, P(x_)), {x_, y_}))
    for (const TermId t : trigger) EXPECT_NE(t, nested);
}

TEST_F(Triggers, PatternsMatchWhatWasSeen) {
  index_.Add(arena_.Or(Near(a_, b_), Near(b_, c_)));
  EXPECT_EQ(Match({Near(x_, y_)}), (std::set<Terms>{{a_, b_}, {b_, c_}}));
  EXPECT_EQ(Match({Near(y_, x_)}), (std::set<Terms>{{b_, a_}, {c_, b_}}));
}

TEST_F(Triggers, EqualVariablesMatchEqualTerms) {
  index_.Add(arena_.Or({Near(a_, b_), P(a_), P(c_), Q(b_), Q(a_)}));
  EXPECT_EQ(Match({Near(x_, y_), P(x_), Q(y_)}), (std::set<Terms>{{a_, b_}}));
  EXPECT_TRUE(Match({Near(x_, y_), Q(x_), P(y_)}).empty());
}

TEST_F(Triggers, ClosedArgumentsMatchThemselves) {
  index_.Add(arena_.Or({Near(a_, b_), Near(c_, a_), P(c_)}));
  EXPECT_EQ(Match({Near(a_, y_), P(x_)}), (std::set<Terms>{{c_, b_}}));
}

TEST_F(Triggers, IndependentPatternsMatchInAllCombinations) {
  index_.Add(arena_.Or({P(a_), P(b_), Q(b_), Q(c_)}));
  EXPECT_EQ(Match({P(x_), Q(y_)}).size(), 4u);
}

TEST_F(Triggers, NoMoreThanTheLimitAreMatched) {
  index_.Add(arena_.Or({P(a_), P(b_), P(c_), Q(a_), Q(b_), Q(c_)}));
  EXPECT_EQ(Match({P(x_), Q(y_)}, 5).size(), 5u);
}

}  // namespace
}  // namespace rondo::solve
