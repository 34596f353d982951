#include "runs/exploration.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "workspace/koord_files.h"

namespace rondo::runs {
namespace {

// Each robot counts to three.
const std::string kCounter = "local:\n    int n = 0\nStep:\n    pre: n < 3\n    eff:\n        n = n + 1\n";

std::string Bounded(int most) {
  return kCounter + "invariant small: forall i in ID: n[i] <= " + std::to_string(most) + "\n";
}

/// A program, and what its exploration found.
struct Exploration {
  workspace::Session session;
  std::unique_ptr<workspace::LoadedKoord> koord;
  diag::Diagnostics said;
  Explored found;

  Exploration(const std::string& text, size_t robots, const ExplorationOptions& options = {}) {
    koord = workspace::LoadKoordTexts("p", text, "", session);
    EXPECT_NE(koord, nullptr) << text;
    if (koord != nullptr) found = Explore(koord->model, robots, options, said);
  }
  bool Says(diag::Kind kind) const {
    return std::ranges::find(said.all(), kind, &diag::Diagnostic::kind) != said.all().end();
  }
};

using explore::Ending;

TEST(Exploring, VisitsEveryValueOfOneCounterOnce) {
  const Exploration run(Bounded(3), 1);
  EXPECT_EQ(run.found.search.ending, Ending::kComplete);
  EXPECT_EQ(run.found.search.states, 4U);
  EXPECT_EQ(run.found.search.initial, 1U);
  EXPECT_EQ(run.found.rounds, 3U);
  EXPECT_FALSE(run.found.broken);
}

TEST(Exploring, StatesThatDifferByARenamingCountAsOne) {
  const Exploration run(Bounded(3), 2);
  EXPECT_TRUE(run.found.symmetric);
  EXPECT_EQ(run.found.search.states, 10U);  // multisets of two of four values
}

TEST(Exploring, WithoutSymmetryEveryPairOfValuesIsAState) {
  ExplorationOptions options;
  options.symmetry = false;
  const Exploration run(Bounded(3), 2, options);
  EXPECT_FALSE(run.found.symmetric);
  EXPECT_EQ(run.found.search.states, 16U);
}

TEST(Exploring, KeepingHashesOnlyVisitsAsManyStates) {
  ExplorationOptions options;
  options.compact = true;
  EXPECT_EQ(Exploration(Bounded(3), 2, options).found.search.states, 10U);
}

TEST(Exploring, ABoundOfRoundsEndsIt) {
  ExplorationOptions options;
  options.rounds = 2;
  const Exploration run(Bounded(3), 1, options);
  EXPECT_EQ(run.found.search.ending, Ending::kDepth);
  EXPECT_EQ(run.found.search.states, 3U);
}

TEST(Exploring, ALimitOfStatesEndsIt) {
  ExplorationOptions options;
  options.states = 2;
  EXPECT_EQ(Exploration(Bounded(3), 1, options).found.search.ending, Ending::kStates);
}

TEST(Exploring, ABrokenInvariantIsFoundAfterAsFewRoundsAsThereCanBe) {
  const Exploration run(Bounded(1), 1);
  EXPECT_TRUE(run.found.broken);
  EXPECT_EQ(run.found.search.ending, Ending::kBroken);
  EXPECT_EQ(run.found.property, "invariant small");
  EXPECT_EQ(run.found.search.path.size(), 3U);  // 0, 1, 2
  EXPECT_TRUE(run.Says(diag::Kind::kKoordViolated));
  EXPECT_TRUE(run.found.run.is_array());
}

TEST(Exploring, ABoundHidesWhatBreaksLater) {
  ExplorationOptions options;
  options.rounds = 1;
  EXPECT_FALSE(Exploration(Bounded(1), 1, options).found.broken);
}

TEST(Exploring, OneInvariantCanBeCheckedAlone) {
  ExplorationOptions options;
  options.only = 1;
  const std::string text = Bounded(1) + "invariant other: forall i in ID: n[i] >= 0\n";
  EXPECT_FALSE(Exploration(text, 1, options).found.broken);
  options.only = 0;
  EXPECT_TRUE(Exploration(text, 1, options).found.broken);
}

TEST(Exploring, TwoRobotsThatLookAtOnceEnterTogether) {
  const std::string text =
      "allread:\n    bool inside[N_sys] = false\nEnter:\n    pre: forall j in ID: not inside[j]\n    eff:\n"
      "        inside[pid] = true\n"
      "invariant one: forall i, j in ID: inside[i] and inside[j] implies i == j\n";
  EXPECT_FALSE(Exploration(text, 1).found.broken);
  EXPECT_TRUE(Exploration(text, 2).found.broken);
}

TEST(Exploring, AnOperationWithoutAResultBreaksTheRun) {
  const Exploration run(
      "local:\n    int n = 1\n    int m = 0\nStep:\n    eff:\n        m = 6 / n\n        n = n - 1\n", 1);
  EXPECT_TRUE(run.found.broken);
  EXPECT_EQ(run.found.property, "well-defined");
  EXPECT_TRUE(run.Says(diag::Kind::kKoordFault));
}

TEST(Exploring, ADeadlockIsReportedOnDemand) {
  EXPECT_FALSE(Exploration(kCounter, 1).found.broken);
  ExplorationOptions options;
  options.deadlocks = true;
  const Exploration run(kCounter, 1, options);
  EXPECT_EQ(run.found.property, "deadlock");
  EXPECT_EQ(run.found.search.ending, Ending::kDeadlock);
}

TEST(Exploring, AnEventThatIsNeverEnabledIsCountedAsSuch) {
  const Exploration run(kCounter + "Back:\n    pre: n == 7\n    eff:\n        n = 0\n", 1);
  ASSERT_EQ(run.found.enabled.size(), 2U);
  EXPECT_GT(run.found.enabled[0], 0U);
  EXPECT_EQ(run.found.enabled[1], 0U);
}

TEST(Exploring, AParameterNeedsAValue) {
  const std::string text =
      "param int most\nlocal:\n    int n = 0\nStep:\n    pre: n < most\n    eff:\n        n = n + 1\n";
  const Exploration without(text, 1);
  EXPECT_TRUE(without.found.unusable);
  EXPECT_TRUE(without.Says(diag::Kind::kKoordNotExecutable));
  size_t most = 0;
  while (without.koord->model.variables[most].name != "most") ++most;
  ExplorationOptions options;
  options.params[most] = {5};
  EXPECT_EQ(Exploration(text, 1, options).found.search.states, 6U);
}

TEST(Exploring, AStartThatIsExcludedIsReported) {
  const Exploration run("local:\n    int n\nStep:\n    eff:\n        n = 1\nassume initially: n > 0\n", 1);
  EXPECT_TRUE(run.found.broken);
  EXPECT_TRUE(run.Says(diag::Kind::kKoordNoInitialState));
  EXPECT_EQ(run.found.zeroed, std::vector<std::string>{"n"});
}

TEST(Exploring, RandomWalksFindWhatIsEasilyFound) {
  ExplorationOptions options;
  options.walks = 5;
  options.steps = 200;
  const Exploration good(Bounded(3), 2, options);
  EXPECT_FALSE(good.found.broken);
  EXPECT_EQ(good.found.walked, 5U);
  EXPECT_TRUE(Exploration(Bounded(1), 2, options).found.broken);
}

TEST(Exploring, WalksWithOneSeedAreTheSame) {
  ExplorationOptions options;
  options.walks = 3;
  options.seed = 9;
  EXPECT_EQ(Exploration(Bounded(1), 2, options).found.run, Exploration(Bounded(1), 2, options).found.run);
}

TEST(DeclaredTeams, AreThoseOfTheSectionForExplorations) {
  const auto sizes = [](const std::string& section) {
    workspace::Session session;
    const auto koord = workspace::LoadKoordTexts("p", kCounter + section, "", session);
    EXPECT_NE(koord, nullptr);
    diag::Diagnostics said;
    const auto result = DeclaredSizes(koord->model, said);
    return std::pair(result, said.errors());
  };
  using Sizes = std::vector<size_t>;
  EXPECT_EQ(sizes(""), std::pair(Sizes{}, size_t{0}));
  EXPECT_EQ(sizes("explore:\n    N_sys in [1, 3]\n"), std::pair(Sizes({1, 3}), size_t{0}));
  EXPECT_EQ(sizes("explore:\n    N_sys in [64]\n"), std::pair(Sizes{64}, size_t{0}));
  EXPECT_EQ(sizes("explore:\n    N_sys in [65]\n"), std::pair(Sizes{}, size_t{1}));
  EXPECT_EQ(sizes("explore:\n    N_sys in [0]\n"), std::pair(Sizes{}, size_t{1}));
}

}  // namespace
}  // namespace rondo::runs
