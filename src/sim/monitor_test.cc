#include "sim/monitor.h"

#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"
#include "sim/ports.h"
#include "sim/recorder.h"

namespace rondo::sim {
namespace {

using koord::semantics::Team;
using koord::semantics::TeamOptions;
using koord::semantics::Word;

struct Program {
  explicit Program(const std::string& text) {
    koord::Parse(sources, sources.Add("test.koord", text), syntax, diagnostics);
    model = koord::Check(syntax, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.all()[0].message << "\n" << text;
  }
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  koord::Program syntax;
  koord::Model model;
};

const char* const kProgram =
    "param int limit = 5\n"
    "using Room:\n    sensors:\n        int heat\n    actuators:\n        int power\n"
    "local:\n    int n\n"
    "Go:\n    eff:\n        n = 1\n"
    "assume limit > 0\n"
    "assume initially: n == 0\n"
    "assume Room.cool always Room.heat <= 9\n"
    "assume Room.stays when Room.power == 0 always Room.heat == old(Room.heat)\n"
    "invariant low: forall i in ID: n[i] <= 3\n";

// Two robots; `state` is what the monitor is shown.
class Monitoring : public testing::Test {
 protected:
  void Start(size_t limit = 5) {
    TeamOptions options;
    options.robots = 2;
    options.params[0] = {limit};
    team_ = Team::Make(program_.model, options, program_.diagnostics);
    ASSERT_NE(team_, nullptr);
    state_ = team_->blank();
    monitor_ =
        std::make_unique<Monitor>(*team_, program_.diagnostics, [this](const Violation& v, bool first) {
          reports_.push_back(v.what + (first ? " first" : " again"));
        });
  }
  Word& At(const std::string& name, size_t robot) {
    for (size_t v = 0; v < program_.model.variables.size(); ++v) {
      if (program_.model.variables[v].name == name) return state_[team_->layout().Address(v, robot)];
    }
    ADD_FAILURE() << "no variable " << name;
    return state_[0];
  }
  const std::vector<Violation>& violations() const { return monitor_->violations(); }
  size_t errors() const { return program_.diagnostics.errors(); }

  Program program_{kProgram};
  std::unique_ptr<Team> team_;
  std::unique_ptr<Monitor> monitor_;
  std::vector<Word> state_;
  std::vector<std::string> reports_;
};

TEST_F(Monitoring, AGoodRunHasNoViolation) {
  Start();
  monitor_->Initially(state_);
  monitor_->Settled(1, state_);
  monitor_->During(1.5, state_, state_);
  monitor_->Summary(2);
  EXPECT_TRUE(violations().empty());
  EXPECT_EQ(errors(), 0U);
}

TEST_F(Monitoring, AnInvariantIsCheckedAtTheEndOfTheProgramTransition) {
  Start();
  At("n", 1) = 4;
  monitor_->Settled(2.5, state_);
  ASSERT_EQ(violations().size(), 1U);
  EXPECT_EQ(violations()[0].what, "invariant `low`");
  EXPECT_EQ(violations()[0].robot, -1);
  EXPECT_EQ(violations()[0].first, 2.5);
}

TEST_F(Monitoring, AViolationIsReportedOnceAndCounted) {
  Start();
  At("n", 1) = 4;
  for (const double t : {1, 2, 3}) monitor_->Settled(t, state_);
  ASSERT_EQ(violations().size(), 1U);
  EXPECT_EQ(violations()[0].count, 3U);
  EXPECT_EQ(violations()[0].first, 1);
  EXPECT_EQ(errors(), 1U);
  EXPECT_EQ(reports_, (std::vector<std::string>{"invariant `low` first", "invariant `low` again",
                                                "invariant `low` again"}));
}

TEST_F(Monitoring, APortKeepsItsAssumption) {
  Start();
  At("Room.heat", 1) = 10;
  monitor_->During(1, state_, state_);
  ASSERT_EQ(violations().size(), 1U);
  EXPECT_EQ(violations()[0].what, "assumption `Room.cool`");
  EXPECT_EQ(violations()[0].robot, 1);
}

TEST_F(Monitoring, EachRobotThatBreaksAnAssumptionIsListedAndOneIsReported) {
  Start();
  At("Room.heat", 0) = At("Room.heat", 1) = 10;
  monitor_->During(1, state_, state_);
  ASSERT_EQ(violations().size(), 2U);
  EXPECT_EQ(violations()[1].robot, 1);
  EXPECT_EQ(errors(), 1U);
}

TEST_F(Monitoring, APromiseIsAboutWhatWasSettled) {
  Start();
  const std::vector<Word> settled = state_;
  At("Room.heat", 1) = 2;
  monitor_->During(1, state_, settled);
  ASSERT_EQ(violations().size(), 1U);
  EXPECT_EQ(violations()[0].what, "assumption `Room.stays`");
  EXPECT_EQ(violations()[0].robot, 1);
}

TEST_F(Monitoring, APromiseDoesNotApplyWhereItsConditionDidNotHold) {
  Start();
  At("Room.power", 1) = 1;
  const std::vector<Word> settled = state_;
  At("Room.power", 1) = 0;
  At("Room.heat", 1) = 2;
  monitor_->During(1, state_, settled);
  EXPECT_TRUE(violations().empty());
}

TEST_F(Monitoring, InvariantsAreCheckedDuringTheEnvironmentsTurn) {
  Start();
  At("n", 0) = 4;
  monitor_->During(1, state_, state_);
  ASSERT_EQ(violations().size(), 1U);
  EXPECT_EQ(violations()[0].what, "invariant `low`");
}

TEST_F(Monitoring, TheInitialStateKeepsWhatIsAssumed) {
  Start();
  At("n", 1) = 1;
  monitor_->Initially(state_);
  ASSERT_EQ(violations().size(), 1U);
  EXPECT_EQ(violations()[0].robot, 1);
  EXPECT_EQ(program_.diagnostics.all().back().kind, diag::Kind::kKoordAssumptionBroken);
}

TEST_F(Monitoring, ParametersKeepWhatIsAssumed) {
  Start(0);
  monitor_->Initially(state_);
  ASSERT_EQ(violations().size(), 1U);
  EXPECT_EQ(violations()[0].robot, -1);
}

TEST(SummaryMonitoring, ABrokenSummaryIsReportedOnce) {
  Program program(
      "def fun f(int i) -> int\nlocal:\n    int n\nGo:\n    eff:\n        n = f(1)\n"
      "explore:\n    f(i) = 7\nsummary f(i) -> y: y < 7\n");
  const auto team = Team::Make(program.model, {}, program.diagnostics);
  ASSERT_NE(team, nullptr);
  std::vector<Word> state = team->blank();
  Monitor monitor(*team, program.diagnostics, [](const Violation&, bool) {});
  team->machine().CheckSummaries(true);
  team->machine().SetMemory(state.data());
  ASSERT_TRUE(team->machine().Run(team->events()[0].body, 0, false));
  monitor.Summary(3);
  monitor.Summary(4);
  ASSERT_EQ(monitor.violations().size(), 1U);
  EXPECT_EQ(monitor.violations()[0].what, "summary `f`");
  EXPECT_EQ(monitor.violations()[0].first, 3);
  EXPECT_EQ(monitor.violations()[0].count, 1U);
}

std::vector<FleetRobot> OneRobot() {
  FleetRobot robot;
  robot.name = "car0";
  robot.model = "car";
  robot.make = [] { return MakeBody("car"); };
  return {robot};
}

std::vector<PortRole> Roles(const std::string& sensors, const std::string& actuators, size_t mistakes = 0) {
  Program program("using M:\n    sensors:\n" + sensors + "    actuators:\n" + actuators +
                  "local:\n    int n\nGo:\n    eff:\n        n = 1\n");
  std::vector<PortRole> roles;
  diag::Diagnostics diagnostics;
  for (const Port& port : FindPorts(program.model, OneRobot(), diagnostics)) roles.push_back(port.role);
  EXPECT_EQ(diagnostics.errors(), mistakes);
  return roles;
}

TEST(Ports, AreFoundByNameAndType) {
  EXPECT_EQ(
      Roles("        pos psn\n        pos velocity\n        float heading\n        bool reached\n"
            "        List<pos, Scan> pscan\n",
            "        pos target\n        List<pos> path\n"),
      (std::vector<PortRole>{PortRole::kPosition, PortRole::kVelocity, PortRole::kHeading, PortRole::kReached,
                             PortRole::kScans, PortRole::kTarget, PortRole::kPath}));
}

TEST(Ports, APositionHasTwoNames) {
  EXPECT_EQ(Roles("        pos position\n", "        pos target\n"),
            (std::vector<PortRole>{PortRole::kPosition, PortRole::kTarget}));
}

TEST(Ports, ThatAreCalledHaveNoRole) {
  EXPECT_EQ(Roles("        PathPlanner planner\n", "        pos target\n"),
            std::vector<PortRole>{PortRole::kTarget});
}

TEST(Ports, OfAnotherTypeOrNameAreReported) {
  EXPECT_TRUE(Roles("        float psn\n", "        float target\n", 2).empty());
  EXPECT_TRUE(Roles("        pos place\n", "        pos goal\n", 2).empty());
}

TEST(Ports, ASensorIsNoActuator) {
  EXPECT_TRUE(Roles("        pos target\n", "        pos psn\n", 2).empty());
}

TEST(Recorder, TimesAreNanoseconds) {
  EXPECT_EQ(Recorder::Nanoseconds(0), 0U);
  EXPECT_EQ(Recorder::Nanoseconds(0.1), 100'000'000U);
  EXPECT_EQ(Recorder::Nanoseconds(2.0000000006), 2'000'000'001U);
}

TEST(Recorder, WithoutATraceNothingIsWritten) {
  Fleet fleet;
  Recorder recorder(nullptr, fleet);
  EXPECT_FALSE(recorder.on());
  recorder.World(fleet);
  recorder.Path(1, 0, {});
  recorder.Map(1, {});
}

}  // namespace
}  // namespace rondo::sim
