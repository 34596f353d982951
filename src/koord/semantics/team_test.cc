#include "koord/semantics/team.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "explore/search.h"
#include "koord/check/check.h"
#include "koord/semantics/story.h"
#include "koord/syntax/parser.h"

namespace rondo::koord::semantics {
namespace {

using testing::HasSubstr;

class Loaded {
 public:
  explicit Loaded(const std::string& text) {
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics);
    model = Check(program_, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.all()[0].message << "\n" << text;
  }
  std::unique_ptr<Team> MakeTeam(TeamOptions options = {}) { return Team::Make(model, options, diagnostics); }
  // The message of the only error.
  std::string Error() const {
    EXPECT_EQ(diagnostics.errors(), 1U);
    for (const diag::Diagnostic& d : diagnostics.all()) {
      if (d.severity == diag::Severity::kError) return d.message;
    }
    return "";
  }

  diag::Diagnostics diagnostics;
  Model model;

 private:
  diag::SourceSet sources_;
  Program program_;
};

const std::string kGo = "Go:\n    eff:\n        n = 1\n";

TEST(Team, AParameterNeedsAValue) {
  Loaded loaded("param int k\nlocal:\n    int n = k\n" + kGo);
  EXPECT_EQ(loaded.MakeTeam(), nullptr);
  EXPECT_EQ(loaded.Error(), "parameter `k` has no value");
}

TEST(Team, AParameterMayUseThoseBeforeIt) {
  Loaded loaded("param int k = 3\nparam int m = k * 2\nlocal:\n    int n = m\n" + kGo);
  const auto team = loaded.MakeTeam();
  ASSERT_NE(team, nullptr);
  EXPECT_EQ(team->machine().params(), (std::vector<Word>{3, 6}));
}

TEST(Team, OptionsGoBeforeTheValuesInTheProgram) {
  Loaded loaded("param int k = 3\nlocal:\n    int n = k\n" + kGo);
  TeamOptions options;
  options.params[0] = {8};
  const auto team = loaded.MakeTeam(options);
  ASSERT_NE(team, nullptr);
  EXPECT_EQ(team->machine().params(), std::vector<Word>{8});
}

TEST(Team, AnExternalFunctionNeedsABodyOrAHost) {
  const std::string text = "def fun f(int i) -> int\nlocal:\n    int n\nGo:\n    eff:\n        n = f(1)\n";
  Loaded loaded(text);
  TeamOptions hosted;
  hosted.hosted = [](size_t) { return true; };
  EXPECT_NE(loaded.MakeTeam(hosted), nullptr);
  EXPECT_EQ(loaded.MakeTeam(), nullptr);
  EXPECT_EQ(loaded.Error(), "`f` has no body");
}

TEST(Team, AParameterWithoutAnOperationsResultIsAFault) {
  Loaded loaded("param int k = 1 / 0\nlocal:\n    int n = k\n" + kGo);
  EXPECT_EQ(loaded.MakeTeam(), nullptr);
  EXPECT_EQ(loaded.diagnostics.all().back().kind, diag::Kind::kKoordFault);
}

TEST(Team, AnArrayTakesItsLengthFromAParameter) {
  Loaded loaded("param int k = 4\nlocal:\n    int n\nallwrite:\n    int c[k]\n" + kGo);
  const auto team = loaded.MakeTeam();
  ASSERT_NE(team, nullptr);
  EXPECT_EQ(team->layout().shared_words(), 4U);
}

TEST(Team, VariablesThatStartAsZeroAreListed) {
  Loaded loaded("local:\n    int n\n    int m = 0\n    int k\ninit:\n    k = 1\n" + kGo);
  const auto team = loaded.MakeTeam();
  ASSERT_NE(team, nullptr);
  EXPECT_EQ(team->zeroed(), std::vector<size_t>{0});
}

TEST(Team, ABlankStateHasArraysOfTheirLength) {
  Loaded loaded("def adt Rec:\n    int k[2]\nlocal:\n    int n\n    Rec r\n" + kGo);
  const auto team = loaded.MakeTeam();
  ASSERT_NE(team, nullptr);
  EXPECT_EQ(team->ShowVariable(team->blank(), 1, 0), "([0, 0])");
}

TEST(Team, AFormulaOfEachRobotNamesTheFirstThatBreaksIt) {
  Loaded loaded("local:\n    int n = 0\n" + kGo + "invariant low: n < 2\n");
  TeamOptions options;
  options.robots = 3;
  const auto team = loaded.MakeTeam(options);
  std::vector<Word> state = team->blank();
  for (size_t r = 1; r < 3; ++r) state[team->layout().Address(0, r)] = 2;
  team->machine().SetMemory(state.data());
  size_t robot = 9;
  EXPECT_FALSE(team->Holds(team->invariants()[0], &robot));
  EXPECT_EQ(robot, 1U);
}

TEST(Team, AFormulaThatMeetsAnUndefinedOperationSaysSo) {
  Loaded loaded("local:\n    int n = 0\n" + kGo + "invariant div: forall i in ID: 1 / n[i] == 0\n");
  const auto team = loaded.MakeTeam();
  std::vector<Word> state = team->blank();
  team->machine().SetMemory(state.data());
  bool defined = true;
  EXPECT_TRUE(team->Holds(team->invariants()[0], nullptr, &defined));
  EXPECT_FALSE(defined);
}

TEST(Team, NamesSayWhoseVariableItIs) {
  Loaded loaded("using M:\n    sensors:\n        bool near\nallwrite:\n    int s\nlocal:\n    int n\n" + kGo);
  const auto team = loaded.MakeTeam();
  std::vector<std::string> names;
  for (size_t v = 0; v < 3; ++v) names.push_back(team->NameOf(v, 2));
  EXPECT_THAT(names, testing::UnorderedElementsAre("M[2].near", "s", "n[2]"));
}

TEST(Team, CollectingKeepsWhatStatesContain) {
  Loaded loaded("local:\n    List<int> l = [1, 2]\n    int n\nGo:\n    eff:\n        l.append(3)\n");
  const auto team = loaded.MakeTeam();
  std::vector<Word> state = team->blank();
  const std::vector<Word> kept{4, 5, 6};
  state[team->layout().Address(0, 0)] = team->heap().Intern(kept);
  team->heap().Intern(std::vector<Word>(1000, 7));
  const size_t before = team->heap().words_in_use();
  const std::span<const Word> roots[] = {state};
  team->Collect(roots);
  EXPECT_LE(team->heap().words_in_use(), before - 1000);
  EXPECT_EQ(team->ShowVariable(state, 0, 0), "[4, 5, 6]");
}

const std::string kCounter =
    "local:\n    int n = 0\nUp:\n    pre: n < 3\n    eff:\n        n = n + 1\n"
    "invariant low: forall i in ID: n[i] < 3\n";

struct Found {
  explore::SearchResult result;
  std::vector<Step> run;
  std::string property;
};

Found Explore(Team& team, SystemOptions options, bool deadlocks = false) {
  diag::Diagnostics diagnostics;
  System system(team, options, diagnostics);
  explore::SearchOptions search;
  search.deadlocks = deadlocks;
  Found found;
  found.result = explore::Search(system, search);
  found.run = system.Explain(found.result.path, found.result.broken);
  return found;
}

TEST(System, FindsTheShortestRunThatBreaksAnInvariant) {
  Loaded loaded(kCounter);
  const auto team = loaded.MakeTeam();
  const Found found = Explore(*team, {});
  EXPECT_EQ(found.result.ending, explore::Ending::kBroken);
  ASSERT_EQ(found.run.size(), 4U);
  EXPECT_EQ(found.run[3].state[team->layout().Address(0, 0)], 3U);
}

TEST(System, CountsStatesUpToRenaming) {
  Loaded loaded("local:\n    int n = 0\nUp:\n    pre: n < 3\n    eff:\n        n = n + 1\n");
  TeamOptions options;
  options.robots = 2;
  const auto team = loaded.MakeTeam(options);
  EXPECT_EQ(Explore(*team, {true, false, {}}).result.states, 16U);
  EXPECT_EQ(Explore(*team, {true, true, {}}).result.states, 10U);
}

// Handles of lists differ from heap to heap; up to renaming, states do not.
TEST(System, CountsListsUpToRenamingWithAnyNumberOfThreads) {
  Loaded loaded(
      "allread:\n    List<int> own[N_sys]\nGo:\n    eff:\n        if len(own[pid]) < 2:\n"
      "            own[pid].append(any int in 0..3)\n        else:\n            own[pid].clear()\n");
  TeamOptions options;
  options.robots = 3;
  for (const size_t threads : {1, 2, 5}) {
    SharedValues shared;
    diag::Diagnostics diagnostics;
    std::vector<std::unique_ptr<Team>> teams;
    std::vector<std::unique_ptr<System>> systems;
    std::vector<System*> pointers;
    for (size_t i = 0; i < threads; ++i) {
      teams.push_back(loaded.MakeTeam(options));
      systems.push_back(std::make_unique<System>(*teams.back(), SystemOptions{}, diagnostics, &shared));
      pointers.push_back(systems.back().get());
    }
    const auto result = explore::Search<System>(pointers, {});
    EXPECT_EQ(result.states, 1771U);
    EXPECT_EQ(result.transitions, 32510U);
    EXPECT_EQ(result.marked[0], 1771U);
  }
}

TEST(System, ATeamThatCanDoNothingIsDeadlocked) {
  Loaded loaded("local:\n    int n = 0\nUp:\n    pre: n < 3\n    eff:\n        n = n + 1\n");
  const auto team = loaded.MakeTeam();
  EXPECT_EQ(Explore(*team, {}, true).result.ending, explore::Ending::kDeadlock);
}

TEST(System, ATeamThatHasStoppedIsNot) {
  Loaded loaded("local:\n    int n = 0\nUp:\n    eff:\n        stop\n");
  const auto team = loaded.MakeTeam();
  EXPECT_EQ(Explore(*team, {}, true).result.ending, explore::Ending::kComplete);
}

TEST(System, AnOperationWithoutAResultIsFound) {
  Loaded loaded("local:\n    int n = 2\nDown:\n    eff:\n        n = n - 1 + 0 / n\n");
  const auto team = loaded.MakeTeam();
  diag::Diagnostics diagnostics;
  System system(*team, {}, diagnostics);
  const explore::SearchOptions options;
  const explore::SearchResult result = explore::Search(system, options);
  ASSERT_EQ(result.ending, explore::Ending::kBroken);
  EXPECT_EQ(system.TroubleOf(result.broken.property), Trouble::kFault);
  EXPECT_EQ(system.detail().fault, Fault::kDivision);
  EXPECT_EQ(result.path.size(), 3U);
}

TEST(System, ABrokenSummaryIsFound) {
  Loaded loaded(
      "def fun f(int i) -> int\nlocal:\n    int n = 0\nGo:\n    eff:\n        n = f(n)\n"
      "explore:\n    f(i) = min(i + 1, 2)\nsummary f(i) -> y: y <= 1\n");
  const auto team = loaded.MakeTeam();
  diag::Diagnostics diagnostics;
  System system(*team, {}, diagnostics);
  const explore::SearchOptions options;
  const explore::SearchResult result = explore::Search(system, options);
  ASSERT_EQ(result.ending, explore::Ending::kBroken);
  EXPECT_EQ(system.TroubleOf(result.broken.property), Trouble::kSummary);
}

TEST(System, AnInvariantHoldsInTheMiddleOfARoundToo) {
  // Whoever acts first is alone for a moment.
  Loaded loaded(
      "local:\n    int n = 0\nUp:\n    pre urgent: n == 0\n    eff:\n        n = 1\n"
      "invariant same: forall i, j in ID: n[i] == n[j]\n");
  TeamOptions options;
  options.robots = 2;
  const auto team = loaded.MakeTeam(options);
  const Found found = Explore(*team, {});
  EXPECT_EQ(found.result.ending, explore::Ending::kBroken);
  ASSERT_FALSE(found.run.empty());
  EXPECT_FALSE(found.run.back().complete);
}

TEST(Story, ARunIsToldRoundByRound) {
  Loaded loaded(kCounter);
  const auto team = loaded.MakeTeam();
  const std::string text = Tell(*team, Explore(*team, {}).run);
  EXPECT_THAT(text, HasSubstr("start     everything is zero"));
  EXPECT_THAT(text, HasSubstr("round 1   robot 0  Up  wrote n[0] = 1"));
  EXPECT_THAT(text, HasSubstr("round 3   robot 0  Up  wrote n[0] = 3"));
}

TEST(Story, ASavedRunIsReplayed) {
  Loaded loaded(kCounter);
  const auto team = loaded.MakeTeam();
  const nlohmann::json run = RunToJson(*team, Explore(*team, {}).run);
  EXPECT_EQ(Replay(*team, run, "invariant low"), "");
}

TEST(Story, AStateThatTheProgramCannotReachIsRefused) {
  Loaded loaded(kCounter);
  const auto team = loaded.MakeTeam();
  nlohmann::json run = RunToJson(*team, Explore(*team, {}).run);
  run[2]["state"]["n"][0] = 3;
  EXPECT_EQ(Replay(*team, run, "invariant low"), "step 2: the program cannot reach this state");
}

TEST(Story, ARunThatBreaksNothingIsRefused) {
  Loaded loaded(kCounter);
  const auto team = loaded.MakeTeam();
  nlohmann::json run = RunToJson(*team, Explore(*team, {}).run);
  run.erase(3);
  EXPECT_THAT(Replay(*team, run, "invariant low"), HasSubstr("does not break"));
}

TEST(Story, OtherEventsAreNoticed) {
  Loaded loaded(kCounter);
  const auto team = loaded.MakeTeam();
  nlohmann::json run = RunToJson(*team, Explore(*team, {}).run);
  run[1]["events"][0] = "Down";
  EXPECT_EQ(Replay(*team, run, "invariant low"), "step 1: other events lead to this state");
}

}  // namespace
}  // namespace rondo::koord::semantics
