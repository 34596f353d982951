// The proof obligations of small programs, answered by Z3.
#include "koord/prove/obligations/problem.h"

#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"
#include "solve/z3/z3_solver.h"

namespace rondo::koord {
namespace {

class Obligations : public testing::Test {
 protected:
  void Load(const std::string& text, std::optional<int64_t> robots = std::nullopt) {
    problems_.reset();
    program_ = {};
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    ASSERT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message;
    arena_ = std::make_unique<expr::Arena>();
    problems_.emplace(*arena_, model_, Problems::Options{robots, robots.has_value()}, diagnostics_);
  }
  /// Nothing satisfies the problem.
  bool Excluded(const Problem& problem) {
    return std::holds_alternative<solve::Unsat>(solver_.Check(problem.query, {}, {}));
  }
  bool Possible(const Problem& problem) {
    return std::holds_alternative<solve::Sat>(solver_.Check(problem.Whole(), {}, {}));
  }
  bool Inductive(size_t invariant) { return Excluded(problems_->Step(invariant, std::nullopt, false)); }
  size_t Part(Problems::Part part) const { return problems_->specification(part); }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  std::unique_ptr<expr::Arena> arena_;
  std::optional<Problems> problems_;
  solve::z3::Z3Solver solver_;
};

TEST_F(Obligations, DeclaredValuesDecideInitially) {
  const std::string tail = "E:\n    eff:\n        n = 0\ninvariant: n >= 1\n";
  Load("local:\n    int n = 1\n" + tail);
  EXPECT_TRUE(Excluded(problems_->Initially(0)));
  Load("local:\n    int n = 0\n" + tail);
  EXPECT_TRUE(Possible(problems_->Initially(0)));
  Load("local:\n    int n\n" + tail);
  EXPECT_TRUE(Possible(problems_->Initially(0)));
}

TEST_F(Obligations, InitDecidesInitially) {
  const std::string tail = "E:\n    eff:\n        n = 0\ninvariant: n == 1\n";
  Load("local:\n    int n = 0\ninit:\n    n = n + 1\n" + tail);
  EXPECT_TRUE(Excluded(problems_->Initially(0)));
  Load("local:\n    int n = 0\ninit:\n    if n > 0:\n        n = 1\n" + tail);
  EXPECT_FALSE(Excluded(problems_->Initially(0)));
}

TEST_F(Obligations, EveryRobotHasItsNumberInitially) {
  const std::string tail = "E:\n    eff:\n        x[pid] = 0\ninvariant: forall i in ID: ";
  Load("allread:\n    int x[N_sys] = pid\n" + tail + "x[i] == i\n");
  EXPECT_TRUE(Excluded(problems_->Initially(0)));
  Load("allread:\n    int x[N_sys] = pid\n" + tail + "x[i] == 0\n");
  EXPECT_FALSE(Excluded(problems_->Initially(0)));
}

TEST_F(Obligations, InitialAssumptionsSpeakOfTheInitialStateOnly) {
  Load(
      "using M:\n    sensors:\n        int at\n    actuators:\n        int to\nE:\n    eff:\n        M.to = 0\n"
      "assume initially: M.at > 0\ninvariant: M.at > 0\n");
  EXPECT_TRUE(Excluded(problems_->Initially(0)));
  EXPECT_FALSE(Inductive(0));
}

TEST_F(Obligations, WhatHoldsAlwaysHoldsAtBothEndsOfARound) {
  Load(
      "using M:\n    sensors:\n        int at\n    actuators:\n        int to\nE:\n    eff:\n        M.to = 0\n"
      "assume M always M.at > 0\ninvariant: M.at > 0\n");
  EXPECT_TRUE(Excluded(problems_->Initially(0)));
  EXPECT_TRUE(Inductive(0));
}

TEST_F(Obligations, AnInvariantHoldsAfterEveryRound) {
  const std::string head = "local:\n    int n = 0\nE:\n    pre: n < 3\n    eff:\n        n = n + 1\n";
  Load(head + "invariant: n <= 3\n");
  EXPECT_TRUE(Inductive(0));
  Load(head + "invariant: n < 3\n");
  EXPECT_FALSE(Inductive(0));
}

TEST_F(Obligations, AllInvariantsAreKnownAtTheStart) {
  const std::string head = "local:\n    int n = 0\n    int m = 0\nE:\n    eff:\n        n = m\n";
  Load(head + "invariant a: n >= 0\ninvariant b: m >= 0\n");
  EXPECT_TRUE(Inductive(0));
  Load(head + "invariant a: n >= 0\n");
  EXPECT_FALSE(Inductive(0));
}

TEST_F(Obligations, RobotsActAtTheSameTime) {
  // Two robots see `free` and enter, as in examples/koord/mutex_naive.koord.
  const std::string head =
      "allwrite:\n    bool taken = false\nlocal:\n    bool inside = false\nEnter:\n    pre: not taken\n    eff:\n";
  const std::string tail =
      "invariant one: forall i, j in ID: inside[i] and inside[j] implies i == j\n"
      "invariant known: forall i in ID: inside[i] implies taken\n";
  Load(head + "        inside = true\n        taken = true\n" + tail);
  EXPECT_FALSE(Inductive(0));
  Load(head + "        atomic:\n            inside = true\n            taken = true\n" + tail);
  EXPECT_TRUE(Inductive(0));
  EXPECT_TRUE(Inductive(1));
}

TEST_F(Obligations, TheLastWriterIsAnyRobot) {
  const std::string head = "allwrite:\n    int s = 0\nE:\n    eff:\n        s = pid\ninvariant: s ";
  Load(head + "in ID\n");
  EXPECT_TRUE(Inductive(0));
  Load(head + "== 0\n");
  EXPECT_FALSE(Inductive(0));
}

TEST_F(Obligations, AControllerAssumptionIsAPromiseForTheRound) {
  const std::string head =
      "using M:\n    sensors:\n        int at\n    actuators:\n        int to\nE:\n    eff:\n        M.to = 1\n";
  Load(head + "assume M when M.at >= 0 always M.at >= old(M.at)\ninvariant: M.at >= 0\n");
  EXPECT_TRUE(Inductive(0));
  Load(head + "assume M when M.at > 0 always M.at >= old(M.at)\ninvariant: M.at >= 0\n");
  EXPECT_FALSE(Inductive(0));
}

TEST_F(Obligations, TheConditionOfAPromiseSeesWhatTheProgramWrote) {
  Load(
      "using M:\n    sensors:\n        int at\n    actuators:\n        int to\nE:\n    pre urgent: true\n    eff:\n"
      "        M.to = 1\nassume M when M.to == 1 always M.at >= old(M.at)\ninvariant: M.at >= 0\n");
  EXPECT_TRUE(Inductive(0));
}

TEST_F(Obligations, StepsTellARoundByItsFirstAction) {
  Load(
      "local:\n    int n = 0\nGood:\n    eff:\n        n = 1\nBad:\n    eff:\n        n = -1\n"
      "invariant: forall i in ID: n[i] >= 0\n");
  ASSERT_TRUE(problems_->HasCases(0));
  EXPECT_TRUE(Excluded(problems_->Step(0, 0, false)));
  EXPECT_TRUE(Excluded(problems_->Step(0, 1, false)));
  EXPECT_FALSE(Excluded(problems_->Step(0, 2, false)));
}

TEST_F(Obligations, AReachableStepBeginsInAnInitialState) {
  Load("local:\n    int n = 5\nE:\n    eff:\n        n = n - 1\ninvariant: n >= 0\n");
  EXPECT_FALSE(Excluded(problems_->Step(0, std::nullopt, false)));
  EXPECT_TRUE(Excluded(problems_->Step(0, std::nullopt, true)));
}

TEST_F(Obligations, WhatFollowsUsesItsPremisesOnly) {
  Load(
      "local:\n    int n = 0\nE:\n    eff:\n        n = 0\ninvariant a: n >= 5\ninvariant b: n <= 9\ninvariant c: n > 3\n");
  EXPECT_TRUE(Excluded(problems_->Follows(2, {0})));
  EXPECT_FALSE(Excluded(problems_->Follows(2, {1})));
}

TEST_F(Obligations, OperationsAreDefinedWhereInvariantsHold) {
  const std::string head = "local:\n    int k = 0\n    int a[3]\nE:\n    eff:\n        a[k] = 1\ninvariant: ";
  Load(head + "k >= 0 and k < 3\n");
  EXPECT_TRUE(Excluded(problems_->Defined(1)));
  Load(head + "k >= 0 and k <= 3\n");
  EXPECT_FALSE(Excluded(problems_->Defined(1)));
}

TEST_F(Obligations, SpecificationsAreDefinedToo) {
  const std::string head = "allwrite:\n    int a[3]\n    int k = 0\nE:\n    eff:\n        k = 0\ninvariant: ";
  Load(head + "k >= 0 and k < 3 and a[k] >= 0\n");
  EXPECT_TRUE(Excluded(problems_->Defined(Part(Problems::Part::kInvariants))));
  Load(head + "k >= 0 and k < 3 implies a[k + 1] >= 0\n");
  EXPECT_FALSE(Excluded(problems_->Defined(Part(Problems::Part::kInvariants))));
}

TEST_F(Obligations, FactsAreDefinedByThemselves) {
  const std::string head = "param int p\nlocal:\n    int n\nE:\n    eff:\n        n = 0\nassume ";
  Load(head + "p != 0 and 6 / p == 2\n");
  EXPECT_TRUE(Excluded(problems_->Defined(Part(Problems::Part::kFacts))));
  Load(head + "6 / p == 2\n");
  EXPECT_FALSE(Excluded(problems_->Defined(Part(Problems::Part::kFacts))));
}

TEST_F(Obligations, AssumptionsThatContradictLeaveNoInitialState) {
  const std::string head = "param int p\nlocal:\n    int n = 3\nE:\n    eff:\n        n = 0\n";
  Load(head + "assume p > 0\nassume initially: n == 3\n");
  EXPECT_TRUE(Possible(problems_->SomeInitialState()));
  Load(head + "assume p > 0\nassume p < 0\n");
  EXPECT_TRUE(Excluded(problems_->SomeInitialState()));
  Load(head + "assume initially: n == 4\n");
  EXPECT_TRUE(Excluded(problems_->SomeInitialState()));
}

TEST_F(Obligations, AnEventThatInvariantsForbidIsNeverEnabled) {
  const std::string head = "local:\n    int n = 0\nE:\n    pre: n > 4\n    eff:\n        n = 0\ninvariant: ";
  Load(head + "n <= 5\n");
  EXPECT_TRUE(Possible(problems_->SomeEnabled(1)));
  Load(head + "n <= 4\n");
  EXPECT_TRUE(Excluded(problems_->SomeEnabled(1)));
}

TEST_F(Obligations, SummariesThatAllowNoResultAreImpossible) {
  const std::string head =
      "def fun f(int k) -> int\nlocal:\n    int n\nE:\n    eff:\n        n = f(n)\nsummary f(k) -> y: ";
  Load(head + "y > k\nsummary f(k) -> y: y < k + 2\n");
  EXPECT_TRUE(Excluded(problems_->ImpossibleSummary(0)));
  Load(head + "y > k\nsummary f(k) -> y: y < k + 1\n");
  EXPECT_TRUE(Possible(problems_->ImpossibleSummary(0)));
}

TEST_F(Obligations, SummariesAreKnownOfEveryCall) {
  const std::string head =
      "def fun f(int k) -> int\nlocal:\n    int n = 1\nE:\n    eff:\n        n = f(n)\n"
      "invariant: n > 0\nsummary f(k) -> y: ";
  Load(head + "k > 0 implies y > 0\n");
  EXPECT_TRUE(Inductive(0));
  Load(head + "k > 1 implies y > 0\n");
  EXPECT_FALSE(Inductive(0));
}

constexpr const char* kMoves =
    "using M:\n    sensors:\n        int at\n    actuators:\n        int to\nE:\n    eff:\n        M.to = 1\n";

TEST_F(Obligations, PromisesMayExcludeEachOther) {
  Load(kMoves +
       std::string("assume M.a when M.to > 0 always M.at > 5\nassume M.b when M.to > 3 always M.at < 9\n"));
  EXPECT_TRUE(Possible(problems_->SomePromise(0, true)));
  Load(kMoves +
       std::string("assume M.a when M.to > 0 always M.at > 5\nassume M.b when M.to > 0 always M.at < 5\n"));
  EXPECT_TRUE(Possible(problems_->SomePromise(0, false)));
  EXPECT_TRUE(Excluded(problems_->SomePromise(0, true)));
}

TEST_F(Obligations, APromiseNeedNotHoldAtOnce) {
  Load(kMoves + std::string("assume M when M.to > 0 always M.at > 5\n"));
  EXPECT_TRUE(Possible(problems_->PromiseNow(0)));
  Load(kMoves + std::string("assume M when M.at > 5 always M.at > 5\n"));
  EXPECT_TRUE(Excluded(problems_->PromiseNow(0)));
}

TEST_F(Obligations, AFixedTeamIsSpelledOut) {
  const std::string text =
      "allread:\n    int x[N_sys] = 0\nE:\n    eff:\n        x[pid] = N_sys\ninvariant: forall i in ID: x[i] <= 2\n";
  Load(text, 2);
  EXPECT_TRUE(Inductive(0));
  Load(text, 3);
  const Problem problem = problems_->Step(0, std::nullopt, false);
  EXPECT_TRUE(problem.complete);
  EXPECT_EQ(problem.participants.size(), 3U);
  EXPECT_TRUE(Possible(problem));
}

TEST_F(Obligations, SomebodyWhoExistedMayShowThatSomebodyExists) {
  const std::string head = "allread:\n    int x[N_sys] = 1\nE:\n    eff:\n        x[pid] = ";
  Load(head + "x[pid] + 1\ninvariant: exists i in ID: x[i] > 0\n");
  EXPECT_TRUE(Inductive(0));
  Load(head + "0\ninvariant: exists i in ID: x[i] > 0\n");
  EXPECT_FALSE(Inductive(0));
}

TEST_F(Obligations, PlacesHaveNames) {
  Load(kMoves);
  EXPECT_EQ(problems_->NameOf(1), "E");
  EXPECT_EQ(problems_->NameOf(Part(Problems::Part::kInvariants)), "specification");
  EXPECT_EQ(problems_->NameOf(Part(Problems::Part::kFacts)), "facts and summaries");
}

}  // namespace
}  // namespace rondo::koord
