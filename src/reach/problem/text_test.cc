#include "reach/problem/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "reach/problem/centred.h"
#include "reach/problem/modes.h"
#include "reach/problem/numeric.h"

namespace rondo::reach {
namespace {

// x' = v, v' = -x from a box about (1, 0).
class Stated : public testing::Test {
 protected:
  Stated() {
    problem_.arena = &arena_;
    problem_.states = {x_, v_};
    problem_.rates = {v_, arena_.Neg(x_)};
    problem_.initial = {{0.5, 1.5}, {-0.25, 0.25}};
    problem_.assume = arena_.True();
    problem_.horizon = Rational(2);
    problem_.claims = {{"x", arena_.Le(x_, Num("3")), Rational(0), Rational(2)}};
  }
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Var(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  Trajectories Compiled() {
    auto made = Trajectories::Of(problem_);
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
  }
  // An event that sets a discrete state `m` to one where x falls to zero; then x' = 1.
  void Switch() {
    const TermId m = Var("m");
    problem_.states = {x_, m};
    problem_.rates = {arena_.Sub(arena_.Mul(Num("2"), m), Num("1")), Num("0")};
    problem_.initial = {{1, 1}, {0, 0}};
    problem_.pinned = {std::nullopt, Rational(0)};
    problem_.events = {{arena_.And(arena_.Le(x_, Num("0")), arena_.Eq(m, Num("0"))),
                        {std::nullopt, arena_.Add(m, Num("1"))}}};
  }

  expr::Arena arena_;
  TermId x_ = Var("x"), v_ = Var("v");
  Problem problem_;
};

TEST_F(Stated, TextsAreTheSameForTheSameProblem) { EXPECT_EQ(ToText(problem_), ToText(problem_)); }

TEST_F(Stated, TextsDoNotDependOnNames) {
  const std::string before = ToText(problem_);
  problem_.name = "other";
  problem_.claims[0].name = "other";
  const TermId a = Var("a"), b = Var("b");
  problem_.states = {a, b};
  problem_.rates = {b, arena_.Neg(a)};
  problem_.claims[0].formula = arena_.Le(a, Num("3"));
  EXPECT_EQ(ToText(problem_), before);
}

TEST_F(Stated, TextsTellDifferentProblemsApart) {
  problem_.inputs = {{Var("w"), {-1, 1}}};
  problem_.controller = Controller{*Rational::Parse("0.1"), {std::nullopt, Num("0")}};
  problem_.events = {{arena_.Le(x_, Num("0")), {std::nullopt, Num("1")}}};
  const std::vector<std::function<void(Problem&)>> changes{
      [](Problem&) {},
      [&](Problem& p) { p.rates[0] = arena_.Neg(v_); },
      [](Problem& p) { p.initial[0].hi = std::nextafter(1.5, 2); },
      [](Problem& p) {
        p.copy_of = {std::nullopt, 0};
      },
      [](Problem& p) { p.inputs[0].bounds.lo = -2; },
      [](Problem& p) { p.inputs.clear(); },
      [](Problem& p) { p.controller->period = *Rational::Parse("0.2"); },
      [&](Problem& p) {
        p.controller->updates = {Num("0"), std::nullopt};
      },
      [](Problem& p) { p.controller.reset(); },
      [&](Problem& p) { p.events[0].condition = arena_.Lt(x_, Num("0")); },
      [&](Problem& p) { p.events[0].updates[1] = Num("2"); },
      [&](Problem& p) { p.assume = arena_.Le(x_, v_); },
      [](Problem& p) { p.horizon = *Rational::Parse("2.0000000000000000001"); },
      [&](Problem& p) { p.claims[0].formula = arena_.Le(x_, Num("3.0000000000000000001")); },
      [](Problem& p) { p.claims[0].from = Rational(1); },
      [](Problem& p) { p.claims[0].to = Rational(1); },
      [](Problem& p) { p.claims.push_back(p.claims[0]); }};
  std::set<std::string> texts;
  for (const auto& change : changes) {
    Problem changed = problem_;
    change(changed);
    texts.insert(ToText(changed));
  }
  EXPECT_EQ(texts.size(), changes.size());
}

TEST_F(Stated, TextsKeepTheOrderOfArgumentsThatMatters) {
  problem_.rates[0] = arena_.Divide(x_, v_);
  const std::string before = ToText(problem_);
  problem_.rates[0] = arena_.Divide(v_, x_);
  EXPECT_NE(ToText(problem_), before);
}

TEST_F(Stated, CentredProblemsStartAboutZero) {
  problem_.assume = arena_.And(arena_.Le(Num("0.5"), x_), arena_.Le(x_, Num("1.5")));
  const CentredProblem centred = Centred(problem_);
  EXPECT_EQ(centred.origin, (std::vector<Rational>{Rational(1), Rational(0)}));
  EXPECT_EQ(centred.problem.initial[0], (Interval{-0.5, 0.5}));
  EXPECT_EQ(centred.problem.rates[1], arena_.Sub(Num("-1"), x_));
  EXPECT_EQ(centred.problem.claims[0].formula, arena_.Le(arena_.Add(x_, Num("1")), Num("3")));
}

TEST_F(Stated, CentredProblemsDoNotAssumeWhatEveryStartSatisfies) {
  problem_.assume = arena_.Le(arena_.Mul(x_, v_), Num("0"));
  const TermId before = Centred(problem_).problem.assume;
  EXPECT_EQ(before, problem_.assume);
  problem_.assume = arena_.And(problem_.assume, arena_.Le(v_, Num("100")));
  EXPECT_EQ(Centred(problem_).problem.assume, before);
}

TEST_F(Stated, CentredProblemsMoveWhatControllersSet) {
  problem_.assume = arena_.And(arena_.Le(Num("0.5"), x_), arena_.Le(x_, Num("1.5")));
  problem_.controller = Controller{Rational(1), {arena_.Mul(Num("2"), x_), std::nullopt}};
  // 2 (x + 1) - 1 in the new coordinates.
  EXPECT_EQ(Centred(problem_).problem.controller->updates[0], arena_.Add(arena_.Mul(Num("2"), x_), Num("1")));
}

TEST_F(Stated, ProblemsWhoseStartIsNotKnownExactlyStay) {
  const CentredProblem centred = Centred(problem_);
  EXPECT_EQ(centred.origin[0], Rational(0));
  EXPECT_EQ(centred.problem.initial, problem_.initial);
}

TEST_F(Stated, TrajectoriesOfTheOscillatorAreCosines) {
  Trajectories t = Compiled();
  double last = -1;
  EXPECT_TRUE(t.Run({{1, 0}, {}}, 0.1, [&](double at, std::span<const double> state) {
    EXPECT_GT(at, last);
    EXPECT_LE(at - last, last < 0 ? 1 : 0.1 + 1e-12);
    last = at;
    EXPECT_NEAR(state[0], std::cos(at), 1e-11);
    EXPECT_NEAR(state[1], -std::sin(at), 1e-11);
    return true;
  }));
  EXPECT_EQ(last, 2);
}

TEST_F(Stated, TrajectoriesHoldInputsForTheirPeriod) {
  problem_.rates = {Var("w"), Num("0")};
  problem_.inputs = {{problem_.rates[0], {-1, 3}}};
  Trajectories t = Compiled();
  double end = 0;
  const auto keep = [&](double, std::span<const double> state) {
    end = state[0];
    return true;
  };
  EXPECT_TRUE(t.Run({{0, 0}, {{-1}, {3}}, 0.5}, 0.2, keep));
  EXPECT_NEAR(end, -0.5 + 4.5, 1e-10);
  EXPECT_TRUE(t.Run({{0, 0}, {}}, 0.2, keep));
  EXPECT_NEAR(end, 2, 1e-10);
}

TEST_F(Stated, TrajectoriesAreSampledByTheController) {
  problem_.rates = {v_, Num("0")};
  problem_.controller = Controller{*Rational::Parse("0.5"), {std::nullopt, arena_.Neg(x_)}};
  Trajectories t = Compiled();
  double end = 0;
  EXPECT_TRUE(t.Run({{1, 7}, {}}, 0.1, [&](double, std::span<const double> state) {
    end = state[0];
    return true;
  }));
  // Each half second, x becomes x - x / 2.
  EXPECT_NEAR(end, 1.0 / 16, 1e-12);
}

TEST_F(Stated, TrajectoriesSwitchWhenAnEventHappens) {
  Switch();
  Trajectories t = Compiled();
  double end = 0;
  EXPECT_TRUE(t.Run({{1, 0}, {}}, 0.3, [&](double at, std::span<const double> state) {
    EXPECT_NEAR(state[0], std::fabs(1 - at), 1e-9);
    end = state[1];
    return true;
  }));
  EXPECT_EQ(end, 1);
}

TEST_F(Stated, TrajectoriesThatBlowUpEnd) {
  problem_.rates = {arena_.Mul(x_, x_), Num("0")};
  EXPECT_FALSE(Compiled().Run({{1, 0}, {}}, 0.1, [](double, std::span<const double>) { return true; }));
}

TEST_F(Stated, TheWorstViolationIsAtTheLargestMiss) {
  problem_.claims = {{"x", arena_.Le(v_, Num("0.5")), Rational(0), Rational(2)}};
  const Violation worst = Compiled().Worst({{-1, 0}, {}}, 0.01, 10, 1e-13, base::StopToken());
  EXPECT_NEAR(worst.miss, 0.5, 1e-4);
  EXPECT_NEAR(worst.time, std::acos(0.0), 0.011);
}

TEST_F(Stated, ClaimsAreLookedAtInTheirTimeOnly) {
  problem_.claims = {{"x", arena_.Le(x_, Num("0.5")), Rational(1), Rational(2)}};
  const Violation worst = Compiled().Worst({{1, 0}, {}}, 0.01, 10, 1e-13, base::StopToken());
  EXPECT_NEAR(worst.miss, std::cos(1) - 0.5, 1e-6);
}

TEST_F(Stated, StartsMissWhatIsAssumed) {
  problem_.assume = arena_.Le(x_, Num("1"));
  EXPECT_NEAR(Compiled().MissAssumed(std::vector<double>{1.5, 0}), 0.5, 1e-15);
  EXPECT_LE(Compiled().MissAssumed(std::vector<double>{0.5, 0}), 0);
}

TEST_F(Stated, ModesAreTheStatesThatEventsSet) {
  Switch();
  const auto modes = Modes::Of(problem_);
  ASSERT_TRUE(modes.ok());
  EXPECT_EQ(modes.value().states(), std::vector<size_t>{1});
  EXPECT_EQ(modes.value().start(), Mode{Num("0")});
  EXPECT_EQ(modes.value().ToText({Num("1")}), "m = 1");
}

TEST_F(Stated, ModesFollowOneAnother) {
  Switch();
  const auto modes = Modes::Of(problem_);
  ASSERT_TRUE(modes.ok());
  const auto after = modes.value().After({Num("4")}, 0);
  ASSERT_TRUE(after.ok());
  EXPECT_EQ(after.value(), Mode{Num("5")});
  EXPECT_EQ(modes.value().In({Num("1")}, problem_.rates[0]), Num("1"));
}

TEST_F(Stated, ModesNeedNumbersAfterEvents) {
  Switch();
  problem_.events[0].updates[1] = x_;
  const auto modes = Modes::Of(problem_);
  ASSERT_TRUE(modes.ok());
  EXPECT_FALSE(modes.value().After({Num("0")}, 0).ok());
}

TEST_F(Stated, ModesMustBeDiscrete) {
  Switch();
  Problem moves = problem_;
  moves.rates[1] = Num("1");
  EXPECT_FALSE(Modes::Of(moves).ok());
  Problem uncertain = problem_;
  uncertain.pinned.clear();
  EXPECT_FALSE(Modes::Of(uncertain).ok());
}

}  // namespace
}  // namespace rondo::reach
