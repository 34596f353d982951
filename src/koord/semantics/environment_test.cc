#include "koord/semantics/environment.h"

#include <gtest/gtest.h>

#include <set>

#include "koord/check/check.h"
#include "koord/semantics/symmetry.h"
#include "koord/syntax/parser.h"

namespace rondo::koord::semantics {
namespace {

class Loaded {
 public:
  explicit Loaded(const std::string& text) {
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics);
    model = Check(program_, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.all()[0].message << "\n" << text;
  }
  std::unique_ptr<Team> MakeTeam(size_t robots) {
    return Team::Make(model, {robots, {}, {}, {}}, diagnostics);
  }
  size_t Find(const std::string& name) const {
    for (size_t v = 0; v < model.variables.size(); ++v) {
      if (model.variables[v].name == name) return v;
    }
    ADD_FAILURE() << "no variable " << name;
    return 0;
  }

  diag::Diagnostics diagnostics;
  Model model;

 private:
  diag::SourceSet sources_;
  Program program_;
};

const char* const kRoom =
    "using Room:\n    sensors:\n        bool door\n        int heat\n    actuators:\n        int power\n"
    "local:\n    int n = 0\n"
    "Go:\n    eff:\n        n = 1\n"
    "explore:\n    Room.heat in [1, 2, 3]\n";

using Senses = std::set<std::vector<int64_t>>;

// The values of `Room.heat`, by robot, to which the environment can move from a state in which they are 2.
Senses Heats(const std::string& text, size_t robots) {
  Loaded loaded(text);
  const auto team = loaded.MakeTeam(robots);
  Environment environment(*team, loaded.diagnostics);
  std::vector<Word> state = team->blank();
  const size_t heat = loaded.Find("Room.heat");
  for (size_t r = 0; r < robots; ++r) state[team->layout().Address(heat, r)] = 2;
  Senses senses;
  environment.Move(state, true, [&](std::span<const Word> moved) {
    std::vector<int64_t> values;
    for (size_t r = 0; r < robots; ++r) values.push_back(ToInt(moved[team->layout().Address(heat, r)]));
    senses.insert(std::move(values));
    return true;
  });
  return senses;
}

TEST(Environment, ASensorTakesEachDeclaredValue) { EXPECT_EQ(Heats(kRoom, 1), (Senses{{1}, {2}, {3}})); }

TEST(Environment, RobotsMoveIndependently) { EXPECT_EQ(Heats(kRoom, 2).size(), 9U); }

TEST(Environment, AssumptionsOfPortsAlwaysHold) {
  EXPECT_EQ(Heats(std::string(kRoom) + "assume Room always Room.heat <= 2\n", 2),
            (Senses{{1, 1}, {1, 2}, {2, 1}, {2, 2}}));
}

TEST(Environment, APromiseComparesWithTheEndOfTheProgramTransition) {
  EXPECT_EQ(Heats(std::string(kRoom) + "assume Room always Room.heat >= old(Room.heat)\n", 1),
            (Senses{{2}, {3}}));
}

TEST(Environment, APromiseAppliesWhereItsConditionHeld) {
  const std::string promise = "assume Room when Room.power > 0 always Room.heat == 3\n";
  EXPECT_EQ(Heats(std::string(kRoom) + promise, 1), (Senses{{1}, {2}, {3}}));
  const std::string always = "assume Room when Room.heat == 2 always Room.heat == 3\n";
  EXPECT_EQ(Heats(std::string(kRoom) + always, 1), (Senses{{3}}));
}

TEST(Environment, ARobotWithoutAnAllowedValueIsStuck) {
  Loaded loaded(std::string(kRoom) + "assume Room always Room.heat > 2 + pid\n");
  const auto team = loaded.MakeTeam(2);
  Environment environment(*team, loaded.diagnostics);
  bool visited = false;
  environment.Move(team->blank(), true, [&](std::span<const Word>) { return visited = true; });
  EXPECT_FALSE(visited);
  EXPECT_EQ(environment.stuck(), 1);
}

TEST(Environment, OnlySensorsMove) {
  Loaded loaded(kRoom);
  const auto team = loaded.MakeTeam(1);
  Environment environment(*team, loaded.diagnostics);
  std::vector<Word> state = team->blank();
  state[team->layout().Address(loaded.Find("Room.power"), 0)] = 7;
  state[team->layout().Address(loaded.Find("n"), 0)] = 8;
  size_t visits = 0;
  environment.Move(state, true, [&](std::span<const Word> moved) {
    EXPECT_EQ(moved[team->layout().Address(loaded.Find("Room.power"), 0)], 7U);
    EXPECT_EQ(moved[team->layout().Address(loaded.Find("n"), 0)], 8U);
    return ++visits > 0;
  });
  EXPECT_EQ(visits, 6U);  // three heats, and the door is open or not
}

TEST(Environment, ASensorWithoutValuesIsReported) {
  Loaded loaded(
      "using Room:\n    sensors:\n        float heat\nlocal:\n    int n\nGo:\n    eff:\n        n = 1\n");
  const auto team = loaded.MakeTeam(1);
  const Environment environment(*team, loaded.diagnostics);
  ASSERT_EQ(loaded.diagnostics.errors(), 1U);
  EXPECT_EQ(loaded.diagnostics.all()[0].kind, diag::Kind::kKoordNotExecutable);
}

// The initial values of `a` and `b` of one robot that the assumptions admit.
Senses Starts(const std::string& more) {
  Loaded loaded("local:\n    int a\n    int b\nGo:\n    eff:\n        a = 1\n" + more);
  const auto team = loaded.MakeTeam(1);
  Environment environment(*team, loaded.diagnostics);
  Senses starts;
  environment.Declared([&](std::span<const Word> state) {
    if (environment.MayBegin(state))
      starts.insert({ToInt(state[team->layout().Address(loaded.Find("a"), 0)]),
                     ToInt(state[team->layout().Address(loaded.Find("b"), 0)])});
    return true;
  });
  EXPECT_EQ(environment.fault(), Fault::kNone);
  return starts;
}

TEST(Environment, VariablesStartAsZero) { EXPECT_EQ(Starts(""), (Senses{{0, 0}})); }

TEST(Environment, VariablesStartWithEachDeclaredValue) {
  EXPECT_EQ(Starts("explore:\n    a in [1, 2]\n    b in [5, 6]\n"), (Senses{{1, 5}, {1, 6}, {2, 5}, {2, 6}}));
}

TEST(Environment, AnInitialAssumptionExcludesStates) {
  EXPECT_EQ(Starts("explore:\n    a in [1, 2]\n    b in [1, 2]\nassume initially: a < b\n"),
            (Senses{{1, 2}}));
}

TEST(Environment, AnInitialEquationGivesAValue) {
  EXPECT_EQ(Starts("explore:\n    a in [1, 2]\nassume initially: b == a + 1\n"), (Senses{{1, 2}, {2, 3}}));
}

bool Symmetric(const std::string& more) {
  const Loaded loaded("allread:\n    int x[N_sys] = 0\nlocal:\n    int n = 0\n" + more);
  return IsSymmetric(loaded.model);
}

TEST(Symmetry, RobotsThatAreOnlyComparedCanBeRenamed) {
  EXPECT_TRUE(
      Symmetric("Go:\n    pre: x[pid] == 0\n    eff:\n        x[pid] = 1\n"
                "invariant one: forall i, j in ID: x[i] == 1 and x[j] == 1 implies i == j\n"));
}

TEST(Symmetry, AProgramThatCountsWithRobotsIsNotSymmetric) {
  EXPECT_FALSE(Symmetric("Go:\n    eff:\n        n = pid\n"));
  EXPECT_FALSE(Symmetric("Go:\n    pre: pid == 0\n    eff:\n        n = 1\n"));
  EXPECT_FALSE(Symmetric("Go:\n    eff:\n        n = x[0]\n"));
  EXPECT_FALSE(Symmetric("Go:\n    eff:\n        for i = 0, N_sys:\n            n = x[i]\n"));
}

TEST(Symmetry, SpecificationsCount) {
  const std::string go = "Go:\n    eff:\n        n = 1\n";
  EXPECT_TRUE(Symmetric(go + "invariant i: forall i in ID: n[i] <= N_sys\n"));
  EXPECT_FALSE(Symmetric(go + "invariant i: forall i in ID: n[i] <= i\n"));
  EXPECT_FALSE(Symmetric(go + "invariant i: forall i, j in ID: i < j implies n[i] == 1\n"));
  EXPECT_FALSE(Symmetric(go + "assume initially: n == pid\n"));
}

TEST(Symmetry, AWholeRowHasAnOrder) {
  EXPECT_FALSE(
      Symmetric("def fun f(int[N_sys] xs) -> int:\n    return xs[0]\nGo:\n    eff:\n        n = f(x)\n"));
}

TEST(Symmetry, InitialValuesAndFunctionsCount) {
  EXPECT_FALSE(Symmetric("local:\n    int m = pid\nGo:\n    eff:\n        n = 1\n"));
  EXPECT_FALSE(Symmetric("init:\n    n = pid\nGo:\n    eff:\n        n = 1\n"));
  EXPECT_FALSE(Symmetric("def fun f() -> int:\n    return pid\nGo:\n    eff:\n        n = f()\n"));
}

}  // namespace
}  // namespace rondo::koord::semantics
