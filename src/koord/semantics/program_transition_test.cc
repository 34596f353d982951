#include "koord/semantics/program_transition.h"

#include <gtest/gtest.h>

#include <set>

#include "koord/check/check.h"
#include "koord/semantics/round_execution.h"
#include "koord/syntax/parser.h"

namespace rondo::koord::semantics {
namespace {

using States = std::set<std::vector<int64_t>>;

// The rounds of a program for a team, from the state in which everything is zero.
class Rounds {
 public:
  Rounds(const std::string& text, size_t robots) {
    Parse(sources_, sources_.Add("test.koord", text), program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    EXPECT_FALSE(diagnostics_.has_errors()) << diagnostics_.all()[0].message << "\n" << text;
    if (diagnostics_.has_errors()) return;
    team_ = Team::Make(model_, {robots, {}, {}, {}}, diagnostics_);
    state_ = team_->blank();
  }
  Word& At(const std::string& name, size_t robot = 0) { return state_[Address(name, robot)]; }
  int64_t Int(const std::string& name, size_t robot = 0) { return ToInt(At(name, robot)); }

  // What these variables can be at the end of one program transition in which every urgent event was run. Both
  // ways of listing them must agree.
  States Ends(const std::vector<std::pair<std::string, size_t>>& names, bool init = false) {
    ProgramTransition transition(*team_);
    if (init)
      transition.PrepareInit(state_);
    else
      transition.Prepare(state_);
    States ends;
    States orders;
    const auto collect = [&](States& into) {
      return [&](std::span<const Word> state, bool complete) {
        std::vector<int64_t> values;
        for (const auto& [name, robot] : names) values.push_back(ToInt(state[Address(name, robot)]));
        if (complete) into.insert(std::move(values));
        return true;
      };
    };
    transition.Enumerate(collect(ends));
    transition.EnumerateOrders(collect(orders));
    EXPECT_EQ(ends, orders);
    return ends;
  }
  Team& team() { return *team_; }
  std::vector<Word>& state() { return state_; }

 private:
  uint32_t Address(const std::string& name, size_t robot) const {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].name == name) return team_->layout().Address(v, robot);
    }
    ADD_FAILURE() << "no variable " << name;
    return 0;
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  std::unique_ptr<Team> team_;
  std::vector<Word> state_;
};

const char* const kCount =
    "allwrite:\n    int s = 0\n"
    "Add:\n    eff:\n        s = s + 1 + pid\n";

const char* const kAtomic =
    "allwrite:\n    int s = 0\n"
    "local:\n    int n = 0\n"
    "Add:\n    eff:\n        n = n + 1\n        atomic:\n            s = s + 1\n";

const char* const kExchange =
    "allread:\n    int x[N_sys] = 0\n"
    "Take:\n    eff:\n        x[pid] = x[1 - pid]\n";

const char* const kUrgent =
    "local:\n    int n = 0\n"
    "Must:\n    pre urgent: n == 0\n    eff:\n        n = 1\n"
    "May:\n    pre: n < 5\n    eff:\n        n = n + 10\n";

const char* const kPair =
    "allwrite:\n    int s = 0\n    int t = 0\n"
    "Both:\n    eff:\n        s = pid + 1\n        t = pid + 1\n";

TEST(ProgramTransition, OneOfTheWritersIsTheLast) {
  EXPECT_EQ(Rounds(kCount, 2).Ends({{"s", 0}}), (States{{0}, {1}, {2}}));
}

TEST(ProgramTransition, OneOrderDecidesForAllVariables) {
  EXPECT_EQ(Rounds(kPair, 2).Ends({{"s", 0}, {"t", 0}}), (States{{0, 0}, {1, 1}, {2, 2}}));
}

TEST(ProgramTransition, EveryRobotReadsTheStartOfTheRound) {
  Rounds rounds(kExchange, 2);
  rounds.At("x", 0) = 4;
  rounds.At("x", 1) = 7;
  EXPECT_EQ(rounds.Ends({{"x", 0}, {"x", 1}}), (States{{4, 7}, {7, 7}, {4, 4}, {7, 4}}));
}

TEST(ProgramTransition, OneRobotHoldsTheLock) {
  // Whoever does not get it skips: what the event did before has no effect.
  EXPECT_EQ(Rounds(kAtomic, 2).Ends({{"s", 0}, {"n", 0}, {"n", 1}}),
            (States{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}}));
}

TEST(ProgramTransition, AnUrgentEventIsRunAndExcludesOthers) {
  EXPECT_EQ(Rounds(kUrgent, 1).Ends({{"n", 0}}), (States{{1}}));
}

TEST(ProgramTransition, WithoutAnUrgentEventARobotMaySkip) {
  Rounds rounds(kUrgent, 1);
  rounds.At("n") = 2;
  EXPECT_EQ(rounds.Ends({{"n", 0}}), (States{{2}, {12}}));
}

TEST(ProgramTransition, AnUrgentEventWaitsForTheLock) {
  const std::string urgent =
      "local:\n    int n = 0\n"
      "Must:\n    pre urgent: n == 0\n    eff:\n        atomic:\n            n = 1\n";
  EXPECT_EQ(Rounds(urgent, 2).Ends({{"n", 0}, {"n", 1}}), (States{{0, 1}, {1, 0}}));
}

TEST(ProgramTransition, AStoppedRobotDoesNothing) {
  Rounds rounds(kCount, 2);
  const Layout& layout = rounds.team().layout();
  rounds.state()[layout.block(1) + layout.stopped()] = 1;
  EXPECT_EQ(rounds.Ends({{"s", 0}}), (States{{0}, {1}}));
}

TEST(ProgramTransition, StopMarksTheRobot) {
  Rounds rounds("local:\n    int n = 0\nEnd:\n    eff:\n        stop\n", 1);
  ProgramTransition transition(rounds.team());
  transition.Prepare(rounds.state());
  std::set<Word> marks;
  transition.Enumerate([&](std::span<const Word> state, bool) {
    marks.insert(state[rounds.team().layout().block(0) + rounds.team().layout().stopped()]);
    return true;
  });
  EXPECT_EQ(marks, (std::set<Word>{0, 1}));
}

TEST(ProgramTransition, AnyTakesEveryValue) {
  const std::string any =
      "local:\n    int n = 0\n    int m = 0\n"
      "Pick:\n    eff:\n        n = any int in 1..2\n        if n == 2:\n            m = any q in [5, 6]\n";
  EXPECT_EQ(Rounds(any, 1).Ends({{"n", 0}, {"m", 0}}), (States{{0, 0}, {1, 0}, {2, 5}, {2, 6}}));
}

TEST(ProgramTransition, InitIsRunByEveryRobotOnce) {
  const std::string init = std::string("init:\n    x[pid] = pid + 5\ninit:\n    x[pid] = x[pid] * 2\n");
  EXPECT_EQ(Rounds(std::string(kExchange) + init, 2).Ends({{"x", 0}, {"x", 1}}, true), (States{{10, 12}}));
}

TEST(ProgramTransition, CellsOfAnArrayDoNotConflict) {
  const std::string cells =
      "allwrite:\n    int c[2]\n    int s = 0\n"
      "Set:\n    eff:\n        c[pid] = 1 + pid\n"
      "Sum:\n    pre: c[0] + c[1] > 0\n    eff:\n        s = c[0] + 10 * c[1]\n";
  Rounds rounds(cells, 2);
  ProgramTransition transition(rounds.team());
  transition.Prepare(rounds.state());
  bool both = false;
  transition.Enumerate([&](std::span<const Word> state, bool) {
    const uint32_t at = rounds.team().layout().Address(0, 0);
    both = both || (state[at] == 1 && state[at + 1] == 2);
    return true;
  });
  EXPECT_TRUE(both);
}

TEST(ProgramTransition, AFaultNamesTheRobotAndTheEvent) {
  Rounds rounds("local:\n    int n = 0\nDivide:\n    pre: pid == 1\n    eff:\n        n = 1 / n\n", 2);
  ProgramTransition transition(rounds.team());
  transition.Prepare(rounds.state());
  size_t robot = 9;
  const Effect* failed = transition.Failed(&robot);
  ASSERT_NE(failed, nullptr);
  EXPECT_EQ(failed->fault, Fault::kDivision);
  EXPECT_EQ(robot, 1U);
}

TEST(ProgramTransition, AGuardWithoutAValueIsAFault) {
  Rounds rounds("local:\n    int n = 0\nDivide:\n    pre: 1 / n > 0\n    eff:\n        n = 1\n", 1);
  ProgramTransition transition(rounds.team());
  transition.Prepare(rounds.state());
  EXPECT_TRUE(transition.AnyEnabled());
  ASSERT_NE(transition.Failed(nullptr), nullptr);
  EXPECT_EQ(transition.Failed(nullptr)->fault, Fault::kDivision);
}

TEST(ProgramTransition, TheLastWriterIsTold) {
  Rounds rounds(kCount, 2);
  ProgramTransition transition(rounds.team());
  transition.Prepare(rounds.state());
  transition.Enumerate([&](std::span<const Word> state, bool) {
    if (transition.choice() == std::vector<int>{0, 0}) {
      EXPECT_EQ(transition.last_writers().size(), 1U);
      EXPECT_EQ(state[0], transition.last_writers()[0].robot + 1);
    } else {
      EXPECT_TRUE(transition.last_writers().empty());
    }
    return true;
  });
}

TEST(ProgramTransition, RobotsThatAreAlikeAreTriedInOneOrder) {
  Rounds rounds("local:\n    int n = 0\nUp:\n    eff:\n        n = n + 1\n", 3);
  ProgramTransition transition(rounds.team());
  transition.TreatAlike(true);
  transition.Prepare(rounds.state());
  size_t visits = 0;
  transition.Enumerate([&](std::span<const Word>, bool) { return ++visits > 0; });
  EXPECT_EQ(visits, 4U);  // how many of them act
}

TEST(ProgramTransition, EndsWhenTheVisitorHasSeenEnough) {
  Rounds rounds(kCount, 3);
  ProgramTransition transition(rounds.team());
  transition.Prepare(rounds.state());
  size_t visits = 0;
  EXPECT_FALSE(transition.Enumerate([&](std::span<const Word>, bool) { return ++visits < 2; }));
  EXPECT_EQ(visits, 2U);
}

TEST(RoundExecution, LaterRobotsWriteLast) {
  for (const std::vector<size_t>& order : {std::vector<size_t>{0, 1}, std::vector<size_t>{1, 0}}) {
    Rounds rounds(kCount, 2);
    RoundExecution round(rounds.team());
    round.Begin(rounds.state());
    for (const size_t r : order) EXPECT_EQ(round.Run(r, 0), RoundExecution::Ran::kDone);
    EXPECT_EQ(rounds.Int("s"), 0);
    round.Finish();
    EXPECT_EQ(rounds.Int("s"), static_cast<int64_t>(order[1]) + 1);
  }
}

TEST(RoundExecution, TheSecondToNeedTheLockSkips) {
  Rounds rounds(kAtomic, 2);
  RoundExecution round(rounds.team());
  for (int k = 0; k < 2; ++k) {
    round.Begin(rounds.state());
    EXPECT_EQ(round.Run(1, 0), RoundExecution::Ran::kDone);
    EXPECT_EQ(round.Run(0, 0), RoundExecution::Ran::kNoLock);
    round.Finish();
  }
  EXPECT_EQ(rounds.Int("s"), 2);
  EXPECT_EQ(rounds.Int("n", 0), 0);
  EXPECT_EQ(rounds.Int("n", 1), 2);
}

TEST(RoundExecution, UrgentEventsHideTheOthers) {
  Rounds rounds(kUrgent, 1);
  RoundExecution round(rounds.team());
  round.Begin(rounds.state());
  const auto urgent = round.Enabled(0);
  EXPECT_EQ(std::vector<uint32_t>(urgent.begin(), urgent.end()), std::vector<uint32_t>{0});
  rounds.At("n") = 2;
  round.Begin(rounds.state());
  const auto other = round.Enabled(0);
  EXPECT_EQ(std::vector<uint32_t>(other.begin(), other.end()), std::vector<uint32_t>{1});
}

TEST(RoundExecution, AStoppedRobotHasNoEvent) {
  Rounds rounds("local:\n    int n = 0\nEnd:\n    eff:\n        stop\n", 1);
  RoundExecution round(rounds.team());
  round.Begin(rounds.state());
  EXPECT_EQ(round.Enabled(0).size(), 1U);
  EXPECT_EQ(round.Run(0, 0), RoundExecution::Ran::kDone);
  round.Finish();
  round.Begin(rounds.state());
  EXPECT_TRUE(round.Enabled(0).empty());
}

TEST(RoundExecution, AnEventThatFailsWritesNothing) {
  Rounds rounds("allwrite:\n    int s = 0\nFail:\n    eff:\n        s = 1\n        s = 1 / (s - 1)\n", 1);
  RoundExecution round(rounds.team());
  round.Begin(rounds.state());
  rounds.At("s") = 0;
  EXPECT_EQ(round.Run(0, 0), RoundExecution::Ran::kFailed);
  EXPECT_EQ(round.fault(), Fault::kDivision);
  EXPECT_TRUE(round.writes().empty());
  round.Finish();
  EXPECT_EQ(rounds.Int("s"), 0);
}

}  // namespace
}  // namespace rondo::koord::semantics
