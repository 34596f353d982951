// Which states one round can lead to, told by Z3 from the relation that a round is.
#include "koord/prove/obligations/round.h"

#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/prove/obligations/theory.h"
#include "koord/syntax/parser.h"
#include "solve/z3/z3_solver.h"

namespace rondo::koord {
namespace {

// A team of two robots.
class Rounds : public testing::Test {
 protected:
  enum class Environment { kAny, kStill, kMoved };

  /// The program with a formula of the start and one of the end.
  void Load(const std::string& program, const std::string& start, const std::string& end) {
    const std::string all = program + "invariant: " + start + "\ninvariant: " + end + "\n";
    program_ = {};
    Parse(sources_, sources_.Add("test.koord", all), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    ASSERT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message;
  }
  /// Is there a round from a state with `start` in which at some moment `end` holds?
  bool Possible(const std::string& program, const std::string& start, const std::string& end,
                Environment environment = Environment::kAny) {
    Load(program, start, end);
    return PossibleAs(Round::Kind::kEvents, environment);
  }
  /// Can `init` lead from `start` to `end`?
  bool PossibleInit(const std::string& program, const std::string& start, const std::string& end) {
    Load(program, start, end);
    return PossibleAs(Round::Kind::kInit, Environment::kAny);
  }
  bool PossibleAs(Round::Kind kind, Environment environment) {
    expr::Arena arena;
    Vocabulary vocabulary(arena, model_, 2);
    Executor executor(vocabulary, diagnostics_, {.expand_robots = true});
    Theory theory(vocabulary, executor);
    Round round(vocabulary, executor, kind);
    const std::vector<TermId> team{arena.IntNumber(0), arena.IntNumber(1)};
    const TermId goal = theory.Invariant(1, round.end());
    solve::Query query{&arena, round.Relate(goal, team), {}};
    query.assertions.push_back({theory.Invariant(0, round.start()), ""});
    query.assertions.push_back({goal, ""});
    if (environment == Environment::kMoved) query.assertions.push_back({round.moved(), ""});
    if (environment == Environment::kStill) query.assertions.push_back({arena.Not(round.moved()), ""});
    const solve::Answer answer = solver_.Check(query, {}, {});
    EXPECT_TRUE(std::holds_alternative<solve::Sat>(answer) || std::holds_alternative<solve::Unsat>(answer));
    return std::holds_alternative<solve::Sat>(answer);
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  solve::z3::Z3Solver solver_;
};

constexpr const char* kWriters =
    "allwrite:\n    int s\n    int t\nE:\n    eff:\n        s = 10 + pid\n        t = 10 + pid\n";

TEST_F(Rounds, NobodyHasToAct) { EXPECT_TRUE(Possible(kWriters, "s == 0", "s == 0")); }

TEST_F(Rounds, TheLastWriterOfTheOrderWins) {
  EXPECT_TRUE(Possible(kWriters, "s == 0", "s == 10"));
  EXPECT_TRUE(Possible(kWriters, "s == 0", "s == 11"));
  EXPECT_FALSE(Possible(kWriters, "s == 0", "s != 0 and s != 10 and s != 11"));
}

TEST_F(Rounds, OneOrderDecidesForAllVariables) {
  EXPECT_FALSE(Possible(kWriters, "s == t", "s != t"));
  EXPECT_TRUE(Possible(kWriters, "s != t", "s == t"));
}

TEST_F(Rounds, WhoWroteMoreDoesNotWinMore) {
  const std::string text =
      "allwrite:\n    int s = 0\n    int t = 0\n"
      "A:\n    eff:\n        s = 1\n        t = 1\nB:\n    eff:\n        s = 2\n";
  EXPECT_TRUE(Possible(text, "s == 0 and t == 0", "s == 2 and t == 1"));
  EXPECT_TRUE(Possible(text, "s == 0 and t == 0", "s == 1 and t == 1"));
  EXPECT_FALSE(Possible(text, "s == 0 and t == 0", "s == 1 and t == 0"));
}

TEST_F(Rounds, EverybodyReadsTheStart) {
  const std::string text = "allwrite:\n    int s\nE:\n    eff:\n        s = s + 1\n";
  EXPECT_TRUE(Possible(text, "s == 0", "s == 1"));
  EXPECT_FALSE(Possible(text, "s == 0", "s > 1"));
}

TEST_F(Rounds, RobotsThatReadOneAnotherSwap) {
  const std::string text = "allread:\n    int x[N_sys]\nE:\n    eff:\n        x[pid] = x[1 - pid]\n";
  EXPECT_TRUE(Possible(text, "x[0] == 4 and x[1] == 5", "x[0] == 5 and x[1] == 4"));
  EXPECT_FALSE(Possible(text, "x[0] == 4 and x[1] == 5", "x[0] == x[1] and x[0] != 4 and x[0] != 5"));
}

TEST_F(Rounds, ARobotRunsOneEventAtMost) {
  const std::string text =
      "local:\n    int n\nA:\n    eff:\n        n = n + 1\nB:\n    eff:\n        n = n + 10\n";
  for (const char* n : {"0", "1", "10"}) EXPECT_TRUE(Possible(text, "n == 0", std::string("n[1] == ") + n));
  EXPECT_FALSE(Possible(text, "n == 0", "n[1] != 0 and n[1] != 1 and n[1] != 10"));
}

TEST_F(Rounds, AnEventNeedsItsPrecondition) {
  const std::string text = "local:\n    int n\nE:\n    pre: n > 0\n    eff:\n        n = 5\n";
  EXPECT_TRUE(Possible(text, "n == 1", "n[0] == 5"));
  EXPECT_FALSE(Possible(text, "n[0] == 0 and n[1] == 1", "n[0] == 5"));
}

TEST_F(Rounds, ACellHasAWriterOfItsOwn) {
  const std::string text = "allwrite:\n    int c[2]\nE:\n    eff:\n        c[pid] = 1\n";
  EXPECT_TRUE(Possible(text, "c[0] == 0 and c[1] == 0", "c[0] == 1 and c[1] == 1"));
  EXPECT_TRUE(Possible(text, "c[0] == 0 and c[1] == 0", "c[0] == 0 and c[1] == 1"));
}

TEST_F(Rounds, AWriteOfACellLeavesTheOthers) {
  const std::string text = "allwrite:\n    int g[2][2]\nE:\n    eff:\n        g[1][0] = 1\n";
  EXPECT_TRUE(Possible(text, "g[1][0] == 0", "g[1][0] == 1"));
  EXPECT_FALSE(Possible(text, "g[1][1] == 0", "g[1][1] == 1"));
  EXPECT_FALSE(Possible(text, "g[0][0] == 0", "g[0][0] == 1"));
}

TEST_F(Rounds, AWriteOfARowWritesItsCells) {
  const std::string text =
      "allwrite:\n    int g[2][2]\nlocal:\n    int row[2]\nE:\n    eff:\n        row[0] = 7\n        row[1] = 8\n"
      "        g[1] = row\n";
  EXPECT_TRUE(Possible(text, "g[1][0] == 0 and g[1][1] == 0", "g[1][0] == 7 and g[1][1] == 8"));
  EXPECT_FALSE(Possible(text, "g[1][0] == 0 and g[1][1] == 0", "g[1][0] == 7 and g[1][1] == 0"));
  EXPECT_FALSE(Possible(text, "g[0][1] == 0", "g[0][1] == 8"));
}

TEST_F(Rounds, OneRobotAtMostTakesTheLock) {
  const std::string text = "local:\n    int n\nE:\n    eff:\n        atomic:\n            n = 1\n";
  EXPECT_TRUE(Possible(text, "n == 0", "n[0] == 1 and n[1] == 0"));
  EXPECT_TRUE(Possible(text, "n == 0", "n[0] == 0 and n[1] == 1"));
  EXPECT_FALSE(Possible(text, "n == 0", "n[0] == 1 and n[1] == 1"));
}

TEST_F(Rounds, ALockThatIsNotReachedIsNotTaken) {
  const std::string text =
      "local:\n    int n\nE:\n    eff:\n        if pid == 0:\n            atomic:\n                n = 1\n"
      "        else:\n            n = 1\n";
  EXPECT_TRUE(Possible(text, "n == 0", "n[0] == 1 and n[1] == 1"));
  const std::string returns =
      "local:\n    int n\nE:\n    eff:\n        if pid == 0:\n            n = 1\n            return\n"
      "        atomic:\n            n = 1\n";
  EXPECT_TRUE(Possible(returns, "n == 0", "n[0] == 1 and n[1] == 1"));
}

TEST_F(Rounds, EachEventHasALockOfItsOwn) {
  const std::string text =
      "local:\n    int n\nA:\n    eff:\n        atomic:\n            n = 1\n"
      "B:\n    eff:\n        atomic:\n            n = 2\n";
  EXPECT_TRUE(Possible(text, "n == 0", "n[0] == 1 and n[1] == 2"));
  EXPECT_FALSE(Possible(text, "n == 0", "n[0] == 2 and n[1] == 2"));
}

constexpr const char* kPorts =
    "using M:\n    sensors:\n        int at\n    actuators:\n        int to\nE:\n    eff:\n        M.to = M.at + 1\n";

TEST_F(Rounds, TheEnvironmentMovesSensors) {
  EXPECT_TRUE(Possible(kPorts, "M.at == 0", "M.at == 9", Environment::kMoved));
  EXPECT_FALSE(Possible(kPorts, "M.at == 0", "M.at == 9", Environment::kStill));
}

TEST_F(Rounds, ActuatorsKeepWhatTheProgramWrote) {
  EXPECT_FALSE(Possible(kPorts, "M.at == 0 and M.to == 0", "M[0].to == 9", Environment::kMoved));
  EXPECT_TRUE(Possible(kPorts, "M.at == 0 and M.to == 0", "M[0].to == 1 and M[0].at == 9"));
}

constexpr const char* kUrgent =
    "local:\n    bool b\n    int n\nA:\n    pre urgent: b\n    eff:\n        n = 1\nB:\n    eff:\n        n = 2\n";

TEST_F(Rounds, AnUrgentEventRunsBeforeTheEnvironmentMoves) {
  EXPECT_FALSE(Possible(kUrgent, "b and n == 0", "n[0] == 0", Environment::kMoved));
  EXPECT_TRUE(Possible(kUrgent, "b and n == 0", "n[0] == 0", Environment::kStill));
  EXPECT_TRUE(Possible(kUrgent, "b and n == 0", "n[0] == 1", Environment::kMoved));
  EXPECT_TRUE(Possible(kUrgent, "not b and n == 0", "n[0] == 0", Environment::kMoved));
}

TEST_F(Rounds, AnUrgentEventRunsInsteadOfOthers) {
  EXPECT_FALSE(Possible(kUrgent, "b and n == 0", "n[0] == 2"));
  EXPECT_TRUE(Possible(kUrgent, "not b and n == 0", "n[0] == 2"));
}

TEST_F(Rounds, WhoFailsToGetTheLockOfAnUrgentEventSkips) {
  const std::string text =
      "local:\n    int n\nE:\n    pre urgent: true\n    eff:\n        atomic:\n            n = 1\n";
  EXPECT_TRUE(Possible(text, "n == 0", "n[0] == 0 and n[1] == 1", Environment::kMoved));
  EXPECT_FALSE(Possible(text, "n == 0", "n[0] == 0 and n[1] == 0", Environment::kMoved));
}

TEST_F(Rounds, AChoiceIsMadeByEachRobot) {
  const std::string text = "local:\n    int n\nE:\n    eff:\n        n = any int in 3..4\n";
  EXPECT_TRUE(Possible(text, "n == 0", "n[0] == 3 and n[1] == 4"));
  EXPECT_TRUE(Possible(text, "n == 0", "n[0] == 4 and n[1] == 4"));
  EXPECT_FALSE(Possible(text, "n == 0", "n[0] == 5"));
}

TEST_F(Rounds, EveryRobotRunsInit) {
  const std::string text =
      "allwrite:\n    int s\nlocal:\n    int n\ninit:\n    n = 5 + pid\n    s = n\nE:\n    eff:\n        n = 0\n";
  EXPECT_TRUE(PossibleInit(text, "n == 0", "n[0] == 5 and n[1] == 6 and s == 5"));
  EXPECT_TRUE(PossibleInit(text, "n == 0", "s == 6"));
  EXPECT_FALSE(PossibleInit(text, "n == 0", "n[1] == 0"));
  EXPECT_FALSE(PossibleInit(text, "s == 0", "s == 0"));
}

TEST_F(Rounds, AStoppedRobotSkips) {
  Load("local:\n    int n\nE:\n    eff:\n        n = 1\n        stop\n", "n == 0", "n[0] == 1");
  expr::Arena arena;
  Vocabulary vocabulary(arena, model_, 2);
  Executor executor(vocabulary, diagnostics_, {.expand_robots = true});
  Round round(vocabulary, executor, Round::Kind::kEvents);
  const TermId zero = arena.IntNumber(0);
  const std::vector<solve::Assertion> relation = round.Relate(arena.True(), {zero, arena.IntNumber(1)});
  const auto possible = [&](bool before, bool acts, bool after) {
    solve::Query query{&arena, relation, {}};
    const auto is = [&](TermId t, bool value) { query.assertions.push_back({value ? t : arena.Not(t), ""}); };
    is(arena.Select(round.start().stopped, zero), before);
    is(round.Acts(zero, 1), acts);
    is(arena.Select(round.end().stopped, zero), after);
    return std::holds_alternative<solve::Sat>(solver_.Check(query, {}, {}));
  };
  EXPECT_TRUE(possible(false, true, true));
  EXPECT_FALSE(possible(false, true, false));
  EXPECT_FALSE(possible(true, true, true));
  EXPECT_TRUE(possible(true, false, true));
  EXPECT_FALSE(possible(true, false, false));
  EXPECT_FALSE(possible(false, false, true));
}

// A team of any size, of which a goal reads parts.
class PartsOfARound : public Rounds {
 protected:
  void Start(const std::string& program) {
    Load(program, "true", "true");
    vocabulary_.emplace(arena_, model_, std::nullopt);
    executor_.emplace(*vocabulary_, diagnostics_);
    round_.emplace(*vocabulary_, *executor_, Round::Kind::kEvents);
  }
  expr::Arena arena_;
  std::optional<Vocabulary> vocabulary_;
  std::optional<Executor> executor_;
  std::optional<Round> round_;
};

TEST_F(PartsOfARound, WhoseCellTheGoalReadsTakesPart) {
  Start("allread:\n    int x[N_sys]\nE:\n    eff:\n        x[pid] = 1\n");
  const TermId i = arena_.FreshConstant("i", arena_.Int());
  const TermId k = arena_.FreshConstant("k", arena_.Int());
  round_->Relate(arena_.Eq(arena_.Select(round_->end().value[0], i), arena_.IntNumber(1)), {}, {k});
  EXPECT_EQ(round_->participants(), (std::vector<TermId>{i, k}));
  EXPECT_EQ(round_->readers(), std::vector<TermId>{i});
}

TEST_F(PartsOfARound, SomebodyElseMayBeTheLastWriter) {
  Start("allwrite:\n    int s\nE:\n    eff:\n        s = pid\n");
  const TermId goal = arena_.Eq(round_->end().value[0], arena_.IntNumber(7));
  solve::Query query{&arena_, round_->Relate(goal, {}), {}};
  EXPECT_EQ(round_->participants().size(), 1U);
  query.assertions.push_back({goal, ""});
  query.assertions.push_back({arena_.Eq(round_->start().value[0], arena_.IntNumber(0)), ""});
  EXPECT_TRUE(std::holds_alternative<solve::Sat>(solver_.Check(query, {}, {})));
  query.assertions.push_back({arena_.Le(vocabulary_->robots(), arena_.IntNumber(7)), ""});
  EXPECT_TRUE(std::holds_alternative<solve::Unsat>(solver_.Check(query, {}, {})));
}

TEST_F(PartsOfARound, OfARobotThatDoesNotExistNothingIsKnown) {
  Start("allread:\n    int x[N_sys]\nE:\n    eff:\n        x[pid] = 1\n");
  const auto changes = [&](int64_t robot) {
    const TermId r = arena_.IntNumber(robot);
    const TermId goal = arena_.Eq(arena_.Select(round_->end().value[0], r), arena_.IntNumber(9));
    solve::Query query{&arena_, round_->Relate(goal, {}), {}};
    query.assertions.push_back({goal, ""});
    query.assertions.push_back(
        {arena_.Eq(arena_.Select(round_->start().value[0], r), arena_.IntNumber(0)), ""});
    query.assertions.push_back({arena_.Le(arena_.IntNumber(1), vocabulary_->robots()), ""});
    return std::holds_alternative<solve::Sat>(solver_.Check(query, {}, {}));
  };
  EXPECT_TRUE(changes(-1));
  EXPECT_FALSE(changes(0));
}

TEST_F(PartsOfARound, AnEventMayBeCalledLikeTheSkip) {
  Start("local:\n    int n\nskip:\n    eff:\n        n = 1\n");
  EXPECT_EQ(round_->actions(), (std::vector<std::string>{"skip", "skip"}));
  EXPECT_NE(round_->Acts(arena_.IntNumber(0), 0), round_->Acts(arena_.IntNumber(0), 1));
}

TEST_F(PartsOfARound, TheSettledMomentIsBeforeTheEnvironment) {
  Start(kPorts);
  EXPECT_EQ(round_->settled().value[0], round_->start().value[0]);
  EXPECT_EQ(round_->settled().value[1], round_->end().value[1]);
}

}  // namespace
}  // namespace rondo::koord
