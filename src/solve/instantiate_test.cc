#include "solve/instantiate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "expr/substitute.h"

namespace rondo::solve {
namespace {

using expr::Arena;
using expr::TermId;
using Terms = std::vector<TermId>;

class Instances : public testing::Test {
 protected:
  TermId Constant(const char* name) { return arena_.Variable(arena_.Declare(name, {}, int_)); }
  TermId F(TermId t) { return arena_.Apply(f_, Terms{t}); }
  TermId Positive(TermId t) { return arena_.Lt(arena_.IntNumber(0), t); }
  TermId Plus(TermId t, int64_t n) { return arena_.Add(t, arena_.IntNumber(n)); }
  Ground Of(const Terms& formulas, const InstantiationLimits& limits = {}) {
    std::vector<Assertion> assertions;
    for (const TermId f : formulas) assertions.push_back({f, "g"});
    return Instantiate(arena_, assertions, {}, limits);
  }
  static bool Has(const Ground& ground, TermId formula) {
    return std::ranges::any_of(ground.assertions, [&](const Assertion& a) { return a.formula == formula; });
  }
  // The same, or under the condition of a name.
  bool Says(const Ground& ground, TermId formula) {
    return Has(ground, formula) || std::ranges::any_of(ground.assertions, [&](const Assertion& a) {
             const auto args = arena_.args(a.formula);
             return arena_.op(a.formula) == expr::Op::kOr && std::ranges::find(args, formula) != args.end();
           });
  }
  // The applications of f to something but `a` and `b`.
  std::set<TermId> Others(const Ground& ground) {
    std::set<TermId> found;
    std::unordered_set<TermId> seen;
    for (const Assertion& a : ground.assertions) {
      expr::VisitPostorder(arena_, a.formula, seen, [&](TermId t) {
        if (arena_.op(t) == expr::Op::kApply && t != F(a_) && t != F(b_)) found.insert(t);
      });
    }
    return found;
  }
  void ExpectGround(const Ground& ground) {
    for (const Assertion& a : ground.assertions) {
      EXPECT_FALSE(arena_.HasQuantifier(a.formula));
      EXPECT_FALSE(arena_.IsOpen(a.formula));
    }
  }

  Arena arena_;
  const expr::SortId int_ = arena_.Int();
  const expr::SymbolId f_ = arena_.Declare("f", {int_}, int_);
  const TermId a_ = Constant("a"), b_ = Constant("b"), i_ = arena_.FreshBound("i", int_);
  const TermId j_ = arena_.FreshBound("j", int_);
};

TEST_F(Instances, WithoutQuantifiersNothingIsLeftOut) {
  const Ground ground = Of({arena_.And(Positive(a_), Positive(F(b_)))});
  EXPECT_TRUE(ground.complete);
  EXPECT_TRUE(Has(ground, Positive(a_)) && Has(ground, Positive(F(b_))));
}

TEST_F(Instances, ExistentialVariablesBecomeConstants) {
  const Ground ground = Of({arena_.Exists({i_}, Positive(F(i_)))});
  ExpectGround(ground);
  EXPECT_TRUE(ground.complete);
  ASSERT_EQ(ground.assertions.size(), 1u);
  EXPECT_EQ(Others(ground).size(), 1u);
}

TEST_F(Instances, DeniedUniversalsHaveAWitness) {
  const Ground ground = Of({arena_.Not(arena_.Forall({i_}, Positive(F(i_))))});
  ExpectGround(ground);
  ASSERT_EQ(Others(ground).size(), 1u);
  EXPECT_TRUE(Has(ground, arena_.Not(Positive(*Others(ground).begin()))));
}

TEST_F(Instances, UniversalVariablesTakeWhatStandsInTheirPlace) {
  const Ground ground = Of({arena_.Forall({i_}, Positive(F(i_))), arena_.Or(Positive(a_), Positive(F(b_)))});
  ExpectGround(ground);
  EXPECT_TRUE(Has(ground, Positive(F(b_))));
  EXPECT_FALSE(Has(ground, Positive(F(a_))));
  EXPECT_FALSE(ground.complete);
}

TEST_F(Instances, DeniedExistentialsHoldOfNothing) {
  const Ground ground = Of({arena_.Not(arena_.Exists({i_}, Positive(F(i_)))), Positive(Plus(F(a_), 3))});
  EXPECT_TRUE(Says(ground, arena_.Not(Positive(F(a_)))));
}

TEST_F(Instances, OffsetsAreTakenBack) {
  const TermId step = arena_.Lt(F(i_), F(Plus(i_, 2)));
  const Ground ground = Of({arena_.Forall({i_}, step), Positive(F(a_))}, {InstantiationMode::kPlaces, 1});
  EXPECT_TRUE(Has(ground, arena_.Lt(F(a_), F(Plus(a_, 2)))));
  EXPECT_TRUE(Has(ground, arena_.Lt(F(Plus(a_, -2)), F(a_))));
}

TEST_F(Instances, ComparedNumbersAreInstances) {
  const TermId only = arena_.Or(arena_.Not(arena_.Eq(i_, b_)), Positive(F(i_)));
  EXPECT_TRUE(Has(Of({arena_.Forall({i_}, only)}), Positive(F(b_))));
}

TEST_F(Instances, ElsewhereTheFallbackCounts) {
  const TermId all = arena_.Forall({i_}, arena_.Lt(i_, b_));
  const Ground ground = Instantiate(arena_, {{all, ""}}, {{int_, {a_}}});
  EXPECT_TRUE(Has(ground, arena_.Lt(a_, b_)));
  EXPECT_TRUE(Instantiate(arena_, {{all, ""}}, {}).assertions.empty());
}

TEST_F(Instances, InstancesGiveRiseToInstances) {
  const TermId step = arena_.Lt(F(i_), F(F(i_)));
  const Ground once = Of({arena_.Forall({i_}, step), Positive(F(a_))}, {InstantiationMode::kPlaces, 1});
  const Ground twice = Of({arena_.Forall({i_}, step), Positive(F(a_))}, {InstantiationMode::kPlaces, 2});
  const TermId second = arena_.Lt(F(F(a_)), F(F(F(a_))));
  EXPECT_FALSE(Has(once, second));
  EXPECT_TRUE(Has(twice, second));
}

TEST_F(Instances, LimitsAreKept) {
  const TermId both = arena_.Lt(F(i_), arena_.Mul(arena_.IntNumber(2), F(j_)));
  const Terms formulas{arena_.Forall({i_, j_}, both),
                       arena_.Or({Positive(F(a_)), Positive(F(b_)), Positive(F(arena_.IntNumber(3)))})};
  EXPECT_EQ(Of(formulas, {InstantiationMode::kPlaces, 3}).assertions.size(), 1u + 9u);
  EXPECT_EQ(Of(formulas, {InstantiationMode::kPlaces, 3, 4}).assertions.size(), 1u + 4u);
  EXPECT_EQ(Of(formulas, {InstantiationMode::kPlaces, 3, 100, 2}).assertions.size(), 1u + 2u);
}

TEST_F(Instances, SeveralVariablesTakeWhatStandsTogether) {
  const expr::SortId robot = arena_.Opaque("Robot");
  const expr::SymbolId near = arena_.Declare("near", {robot, robot}, arena_.Bool());
  const expr::SymbolId good = arena_.Declare("good", {robot}, arena_.Bool());
  const TermId r = arena_.FreshBound("r", robot), s = arena_.FreshBound("s", robot);
  const TermId p = arena_.Variable(arena_.Declare("p", {}, robot)),
               q = arena_.Variable(arena_.Declare("q", {}, robot));
  const auto is_near = [&](TermId x, TermId y) { return arena_.Apply(near, Terms{x, y}); };
  const auto is_good = [&](TermId x) { return arena_.Apply(good, Terms{x}); };
  const TermId all = arena_.Forall({r, s}, arena_.Or(is_near(r, s), is_good(s)));
  const Ground ground = Of({all, arena_.Not(is_near(p, q))});
  EXPECT_TRUE(Has(ground, arena_.Or(is_near(p, q), is_good(q))));
  EXPECT_FALSE(Has(ground, arena_.Or(is_near(q, p), is_good(p))));
}

TEST_F(Instances, NamedQuantifiersAreImpliedBothWays) {
  const TermId c = arena_.Variable(arena_.Declare("c", {}, arena_.Bool()));
  const Ground ground = Of({arena_.Eq(c, arena_.Forall({i_}, Positive(F(i_)))), Positive(F(a_))});
  ExpectGround(ground);
  // If it fails, there is a witness; if it holds, then for a.
  ASSERT_EQ(Others(ground).size(), 1u);
  const TermId witness = Positive(*Others(ground).begin());
  EXPECT_TRUE(Says(ground, arena_.Not(witness)));
  EXPECT_TRUE(Says(ground, Positive(F(a_))));
}

TEST_F(Instances, WitnessesAreUsedAgain) {
  Witnesses witnesses;
  const std::vector<Assertion> asked{{arena_.Exists({i_}, Positive(F(i_))), ""}};
  const Ground first = Instantiate(arena_, asked, {}, {}, witnesses);
  const Ground second = Instantiate(arena_, asked, {}, {}, witnesses);
  EXPECT_EQ(first.assertions[0].formula, second.assertions[0].formula);
  EXPECT_EQ(witnesses.size(), 1u);
}

TEST_F(Instances, GroupsArePassedOn) {
  for (const Assertion& a : Of({arena_.Forall({i_}, Positive(F(i_))), Positive(F(a_))}).assertions)
    EXPECT_EQ(a.group, "g");
}

}  // namespace
}  // namespace rondo::solve
