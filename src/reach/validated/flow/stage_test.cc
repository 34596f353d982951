#include "reach/validated/flow/stage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reach/validated/flow/map.h"

namespace rondo::reach {
namespace {

class Staged : public testing::Test {
 protected:
  // x rises until it is one; then `m` becomes one, and x falls.
  Staged() {
    problem_.arena = &arena_;
    problem_.states = {x_, m_};
    problem_.rates = {arena_.Sub(Num("1"), arena_.Mul(Num("2"), m_)), Num("0")};
    problem_.events = {{arena_.And(arena_.Le(Num("1"), x_), arena_.Eq(m_, Num("0"))), {{}, Num("1")}}};
    problem_.initial = {{0, 0.5}, {0, 0}};
    problem_.pinned = {std::nullopt, Rational(0)};
    problem_.assume = arena_.True();
    problem_.horizon = Rational(3);
    problem_.claims = {{"low", arena_.Lt(x_, Num("2")), Rational(1), Rational(2)}};
  }
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  std::unique_ptr<Stages> Make(std::vector<TermId> asked = {}) {
    auto stages = Stages::Of(problem_, std::move(asked));
    EXPECT_TRUE(stages.ok());
    return std::move(stages).value();
  }
  Mode At(const char* m) { return {Num(m)}; }

  expr::Arena arena_;
  TermId x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
  TermId m_ = arena_.Variable(arena_.Declare("m", {}, arena_.Real()));
  Problem problem_;
};

TEST_F(Staged, KnowTheInstantsWhereClaimsChange) {
  EXPECT_EQ(Make()->instants(), (std::vector<double>{1, 2, 3}));
}

TEST_F(Staged, KnowHowOftenTheControllerActs) {
  problem_.controller = Controller{*Rational::Parse("0.5"), {Num("0"), std::nullopt}};
  const auto stages = Make();
  EXPECT_EQ(stages->samples(), 6u);
  EXPECT_EQ(stages->period(), 0.5);
}

TEST_F(Staged, HaveTheRatesOfTheirMode) {
  const auto stages = Make();
  for (const char* m : {"0", "1"}) {
    const auto stage = stages->For({At(m)});
    ASSERT_TRUE(stage.ok());
    const Program& program = stage.value()->dynamics.program;
    BoxSeries box(program, 1);
    for (size_t v = 0; v < program.variables.size(); ++v) box.SetVariable(v, 0, {0, 1});
    std::vector<Branch> branches(program.code.size(), Branch::kEither);
    std::vector<Interval> held(program.code.size());
    ASSERT_TRUE(box.Decide(branches, held));
    EXPECT_EQ(box.Of(program.outputs[0], 0), Interval::Point(*m == '0' ? 1 : -1));
  }
}

TEST_F(Staged, GuardOnlyWhatChangesTheMode) {
  const auto stages = Make();
  const auto before = stages->For({At("0")});
  const auto after = stages->For({At("1")});
  ASSERT_TRUE(before.ok() && after.ok());
  ASSERT_EQ(before.value()->guards.size(), 1u);
  EXPECT_EQ(before.value()->guards[0].after, At("1"));
  EXPECT_TRUE(before.value()->guards[0].IsComparison());
  EXPECT_TRUE(after.value()->guards.empty());
}

TEST_F(Staged, AreMadeOnce) {
  const auto stages = Make();
  EXPECT_EQ(stages->For({At("0")}).value(), stages->For({At("0")}).value());
  EXPECT_NE(stages->For({At("0")}).value(), stages->For({At("1")}).value());
}

TEST_F(Staged, AreAmbiguousWhereRatesDiffer) {
  const auto stages = Make();
  EXPECT_FALSE(stages->For({At("0")}).value()->ambiguous);
  EXPECT_TRUE(stages->For({At("0"), At("1")}).value()->ambiguous);
}

TEST_F(Staged, HaveAFactorAsAFurtherStateIfScaled) {
  const auto stages = Make();
  const auto plain = stages->For({At("0")});
  const auto scaled = stages->For({At("0")}, true);
  ASSERT_TRUE(plain.ok() && scaled.ok());
  EXPECT_EQ(scaled.value()->dynamics.states, plain.value()->dynamics.states + 1);
}

TEST_F(Staged, ObserveWhatIsAskedFor) {
  const auto stage = Make({arena_.Mul(x_, x_)})->For({At("0")});
  ASSERT_TRUE(stage.ok());
  ASSERT_EQ(stage.value()->queries.size(), 1u);
  EXPECT_LT(stage.value()->queries[0].output, stage.value()->observed.outputs.size());
}

TEST_F(Staged, KnowOppositeTerms) {
  const auto stages = Make();
  const TermId gap = arena_.Sub(x_, Num("1"));
  EXPECT_TRUE(stages->AreOpposite(gap, arena_.Sub(Num("1"), x_)));
  EXPECT_FALSE(stages->AreOpposite(gap, gap));
}

TEST_F(Staged, RejectEventsThatSetWhatMoves) {
  problem_.events[0].updates[0] = Num("0");
  EXPECT_FALSE(Stages::Of(problem_).ok());
}

// What controllers make of sets.
class Images : public Staged {
 protected:
  Images() { monomials_->Extend(2); }
  void Use(const std::vector<TermId>& functions) {
    auto program = Compile(arena_, {x_, m_, w_}, functions);
    ASSERT_TRUE(program.ok());
    program_ = std::move(program).value();
  }
  FlowSet Some() const {
    FlowSet set = FromBox({{1, 2}, {-1, 1}}, *monomials_, {0, 1});
    set.Raise(*monomials_, 2);
    return set;
  }

  TermId w_ = arena_.Variable(arena_.Declare("w", {}, arena_.Real()));
  std::shared_ptr<Monomials> monomials_ = std::make_shared<Monomials>(2);
  Program program_;
};

TEST_F(Images, OfLinearMapsAreExactUpToRounding) {
  Use({arena_.Add(x_, m_), arena_.Mul(Num("-3"), x_)});
  Map map(program_, 2, {{0, 0}}, monomials_);
  ASSERT_TRUE(map.Apply(Some()));
  EXPECT_TRUE(map.Range(0).Contains(Interval{0, 3}));
  EXPECT_LT(map.Range(0).Width(), 3 + 1e-9);
  EXPECT_TRUE(map.Range(1).Contains(Interval{-6, -3}));
}

TEST_F(Images, HoldAnyInput) {
  Use({arena_.Mul(x_, w_)});
  Map map(program_, 2, {{-1, 3}}, monomials_);
  ASSERT_TRUE(map.Apply(Some()));
  EXPECT_TRUE(map.Range(0).Contains(Interval{-2, 6}));
}

TEST_F(Images, KeepHowStatesDependOnOneAnother) {
  Use({arena_.Sub(x_, m_), m_});
  Map map(program_, 2, {{0, 0}}, monomials_);
  const FlowSet set = Some();
  FlowSet next;
  ASSERT_TRUE(map.Apply(set));
  map.Finish(set, next, 100);
  Use({arena_.Add(x_, m_)});
  Map back(program_, 2, {{0, 0}}, monomials_);
  ASSERT_TRUE(back.Apply(next));
  EXPECT_TRUE(back.Range(0).Contains(Interval{1, 2}));
  EXPECT_LT(back.Range(0).Width(), 1 + 1e-9);
}

TEST_F(Images, CarryErrors) {
  Use({arena_.Mul(Num("2"), x_), arena_.Sub(x_, m_)});
  Map map(program_, 2, {{0, 0}}, monomials_);
  FlowSet set = Some();
  set.slack = {0.25, 0};
  FlowSet next;
  ASSERT_TRUE(map.Apply(set));
  map.Finish(set, next, 100);
  EXPECT_GE(next.Error(0), 0.5);
  EXPECT_NEAR(next.Error(1), 0.25, 1e-9);
}

TEST_F(Images, NeedFunctionsThatAreDefined) {
  Use({arena_.Apply(expr::Elementary::kLog, {m_})});
  Map map(program_, 2, {{0, 0}}, monomials_);
  EXPECT_FALSE(map.Apply(Some()));
}

}  // namespace
}  // namespace rondo::reach
