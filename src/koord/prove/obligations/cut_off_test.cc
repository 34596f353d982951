// Rounds in which robots are cut off from the others, answered by Z3.
#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/prove/obligations/problem.h"
#include "koord/syntax/parser.h"
#include "solve/z3/z3_solver.h"

namespace rondo::koord {
namespace {

// A robot moves towards its target, and never beyond. `Go` sends it to 9, and remembers that in `sent`.
constexpr const char* kGo = R"(
using M:
    sensors:
        float at
    actuators:
        float to
local:
    bool sent = false
Go:
    pre: not sent
    eff:
        M.to = 9
        sent = true
assume initially: M.at == 0 and M.to == 0
assume M.rises when M.at <= M.to
    always old(M.at) <= M.at and M.at <= M.to
assume M.falls when M.at >= M.to
    always M.to <= M.at and M.at <= old(M.at)
invariant range: 0 <= M.at and M.at <= 9
invariant to: 0 <= M.to and M.to <= 9
)";

class CutOffTest : public testing::Test {
 protected:
  // Does a round in which robots are cut off keep the invariant?
  bool Keeps(const std::string& text, size_t invariant, CutOffLimits limits = {}) {
    Program program;
    diag::Diagnostics diagnostics;
    Parse(sources_, sources_.Add("test.koord", text), program, diagnostics);
    const Model model = Check(program, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.all()[0].message;
    expr::Arena arena;
    Problems problems(arena, model, {std::nullopt, false}, diagnostics);
    const Problem problem = problems.CutOff(invariant, std::nullopt, limits);
    return std::holds_alternative<solve::Unsat>(solve::z3::Z3Solver().Check(problem.query, {}, {}));
  }

  diag::SourceSet sources_;
};

TEST_F(CutOffTest, StandingStillKeepsARange) {
  const std::string fallback = "fallback M:\n    to = at\n";
  EXPECT_TRUE(Keeps(kGo + fallback, 0));
  EXPECT_TRUE(Keeps(kGo + fallback, 1));
}

// What becomes of them otherwise is assumed, not proved (`AssumedOfCutOff`).
TEST_F(CutOffTest, WithoutAFallbackActuatorsFollowAtOnce) {
  EXPECT_TRUE(Keeps(kGo, 0));
  EXPECT_TRUE(Keeps(std::string(kGo) + "invariant sent: sent implies M.to == 9\n", 2));
}

TEST_F(CutOffTest, AFallbackIsABadIdeaWhereItSaysSo) {
  EXPECT_FALSE(Keeps(std::string(kGo) + "fallback M:\n    to = 10\n", 0));
  EXPECT_FALSE(Keeps(std::string(kGo) + "fallback M:\n    to = at + 1\n", 1));
  EXPECT_TRUE(Keeps(
      std::string(kGo) + "fallback M:\n    if at < 8:\n        to = at + 1\n    else:\n        to = at\n",
      1));
}

// What the team agreed on and what the robot does come apart.
TEST_F(CutOffTest, AnEventMayNotReachItsActuators) {
  const std::string sent = "invariant sent: sent implies M.to == 9\nfallback M:\n    to = at\n";
  EXPECT_FALSE(Keeps(kGo + sent, 2));
  EXPECT_FALSE(Keeps(kGo + sent, 2, {true, false}));
}

TEST_F(CutOffTest, AnEventMayReachItsActuatorsLate) {
  // Only who is told at once stays behind the line that it has passed meanwhile.
  const std::string text = R"(
using M:
    sensors:
        float at
    actuators:
        float to
Go:
    pre: M.at <= 1
    eff:
        M.to = 2
assume M.rises when M.at <= M.to
    always old(M.at) <= M.at and M.at <= M.to
assume M.jumps when M.at > M.to
    always M.at == 99 or M.at == old(M.at)
invariant range: M.at <= 3
invariant to: M.to <= 3
fallback M:
    to = at
)";
  EXPECT_FALSE(Keeps(text, 0));
  const std::string safe = text + "invariant behind: M.at <= M.to\n";
  EXPECT_FALSE(Keeps(safe, 2));  // at 2.5 on the way to 3, `Go` comes late
  EXPECT_TRUE(Keeps(safe, 2, {true, false}));
  EXPECT_TRUE(Keeps(safe, 0, {true, false}));
}

TEST_F(CutOffTest, WhoIsCutOffLeavesUrgentEventsUndone) {
  const std::string text = R"(
using M:
    sensors:
        int level
    actuators:
        int valve
Stop:
    pre urgent: M.level > 5
    eff:
        M.valve = 0
assume M.fills when M.valve > 0
    always old(M.level) <= M.level and M.level <= old(M.level) + 4
assume M.rests when M.valve <= 0
    always M.level == old(M.level)
invariant dry: M.level <= 9
)";
  EXPECT_FALSE(Keeps(text, 0));
  EXPECT_TRUE(Keeps(text + "fallback M:\n    valve = 0\n", 0, {true, true}));
  EXPECT_FALSE(Keeps(text + "fallback M:\n    valve = 0\n", 0, {true, false}));
}

// The moment of the change is another one for each robot; what others read of a robot is one moment.
TEST_F(CutOffTest, EachRobotHasItsMoment) {
  const std::string text = R"(
using M:
    sensors:
        float at
    actuators:
        float to
Go:
    eff:
        M.to = pid
assume M.rises when M.at <= M.to
    always old(M.at) <= M.at and M.at <= M.to
assume M.falls when M.at >= M.to
    always M.to <= M.at and M.at <= old(M.at)
invariant lanes: forall i in ID: i - 0.25 <= M[i].at and M[i].at <= i + 0.25
invariant to: forall i in ID: i - 0.25 <= M[i].to and M[i].to <= i + 0.25
invariant apart: forall i in ID: forall j in ID: i != j implies abs(M[i].at - M[j].at) >= 0.5
fallback M:
    to = at
)";
  for (size_t i = 0; i < 3; ++i) EXPECT_TRUE(Keeps(text, i)) << i;
}

}  // namespace
}  // namespace rondo::koord
