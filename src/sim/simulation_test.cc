#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <set>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"
#include "sim/network.h"

namespace rondo::sim {
namespace {

const char* const kGo =
    "using Motion:\n    sensors:\n        pos psn\n        bool reached\n    actuators:\n        pos target\n"
    "Go:\n    pre: Motion.psn.x < 1\n    eff:\n        Motion.target = pos(2, 0, 0)\n";

// Point masses two metres apart, in a row along y.
Fleet Masses(size_t count, double duration = 1) {
  Fleet fleet;
  fleet.duration = duration;
  for (size_t r = 0; r < count; ++r) {
    FleetRobot robot;
    robot.name = "r" + std::to_string(r);
    robot.model = "point_mass";
    robot.position = {0, 2.0 * static_cast<double>(r), 0};
    robot.make = [] { return MakeBody("point_mass"); };
    fleet.robots.push_back(std::move(robot));
  }
  return fleet;
}

struct Outcome {
  SimulationReport report;
  std::vector<std::string> messages;
};

Outcome Play(const std::string& text, const Fleet& fleet, SimulationOptions options = {}) {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  koord::Program program;
  koord::Parse(sources, sources.Add("test.koord", text), program, diagnostics);
  const koord::Model model = koord::Check(program, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << text;
  Outcome outcome;
  outcome.report = Simulate(model, fleet, options, nullptr, diagnostics);
  for (const diag::Diagnostic& d : diagnostics.all()) {
    if (d.severity == diag::Severity::kError) outcome.messages.push_back(d.message);
  }
  return outcome;
}

std::string Local(const std::string& body) {
  return "local:\n    int n = 0\n    stream out\nGo:\n    eff:\n" + body;
}

TEST(Simulation, LastsAsManyRoundsAsItsTimeHas) {
  const Outcome outcome = Play(kGo, Masses(1, 0.95));
  EXPECT_TRUE(outcome.report.ran);
  EXPECT_EQ(outcome.report.rounds, 10U);
  EXPECT_EQ(outcome.report.ended, Ending::kTime);
  EXPECT_NEAR(outcome.report.time, 1, 1e-9);
}

TEST(Simulation, ADurationThatIsAskedForGoesFirst) {
  SimulationOptions options;
  options.duration = 0.3;
  EXPECT_EQ(Play(kGo, Masses(1), options).report.rounds, 3U);
}

TEST(Simulation, EndsWhenEveryRobotHasStopped) {
  const Outcome outcome =
      Play(Local("        n = n + 1\n        if n == 3 + pid:\n            stop\n"), Masses(2));
  EXPECT_EQ(outcome.report.ended, Ending::kStopped);
  EXPECT_EQ(outcome.report.rounds, 4U);
  EXPECT_EQ(outcome.report.events, 7U);
}

TEST(Simulation, EndsWhenNothingMovesAndNothingCanHappen) {
  const Outcome outcome = Play(kGo, Masses(1, 60));
  EXPECT_EQ(outcome.report.ended, Ending::kQuiet);
  EXPECT_GT(outcome.report.time, 2);
  EXPECT_LT(outcome.report.time, 30);
  // Who stops on its way is still on it.
  const Outcome far = Play(
      "using Motion:\n    actuators:\n        pos target\nGo:\n    eff:\n        Motion.target = pos(3, 0, 0)\n"
      "        stop\n",
      Masses(1, 60));
  EXPECT_EQ(far.report.ended, Ending::kStopped);
  EXPECT_GT(far.report.time, 1);
}

TEST(Simulation, AnOperationWithoutAResultEndsIt) {
  const Outcome outcome = Play(Local("        n = 1 / n\n"), Masses(1));
  EXPECT_EQ(outcome.report.ended, Ending::kFailed);
  EXPECT_EQ(outcome.messages, std::vector<std::string>{"robot 0 fails at t = 0 s: the divisor is zero"});
}

TEST(Simulation, BodiesGoWhereTheProgramSays) {
  const Outcome outcome =
      Play(std::string(kGo) + "invariant behind: forall i in ID: Motion[i].psn.x < 1.5\n", Masses(1, 20));
  ASSERT_EQ(outcome.report.violations.size(), 1U);
  EXPECT_EQ(outcome.report.violations[0].what, "invariant `behind`");
  EXPECT_GT(outcome.report.violations[0].first, 0);
}

TEST(Simulation, ARobotHoldsItsPositionUntilItIsTold) {
  const Outcome outcome =
      Play(std::string(kGo) + "assume initially: Motion.target == Motion.psn\n", Masses(2, 0.1));
  EXPECT_TRUE(outcome.report.violations.empty());
}

TEST(Simulation, RobotsThatMeetCollideOnce) {
  const Outcome outcome = Play(kGo, Masses(2, 20));
  EXPECT_EQ(outcome.report.collisions, 1U);
  EXPECT_EQ(outcome.report.first_pair, "r0 and r1");
  EXPECT_LE(outcome.report.least_between_robots, 0);
}

TEST(Simulation, StreamsAreLogged) {
  EXPECT_EQ(Play(Local("        out << n\n        stop\n"), Masses(1)).report.log,
            std::vector<std::string>{"[0 s] r0: 0"});
}

TEST(Simulation, RobotsTakeTurnsWithRoundRobin) {
  // Of the first round robot 1 is the last writer; of the second, only if nobody takes turns.
  const std::string text =
      "allwrite:\n    int s = 0\nGo:\n    eff:\n        s = 10 * s + pid + 1\n"
      "invariant first: s != 22\ninvariant turns: s != 21\n";
  Fleet fleet = Masses(2, 0.2);
  const Outcome first = Play(text, fleet);
  ASSERT_EQ(first.report.violations.size(), 1U);
  EXPECT_EQ(first.report.violations[0].what, "invariant `first`");
  fleet.policy = Policy::kRoundRobin;
  const Outcome turns = Play(text, fleet);
  ASSERT_EQ(turns.report.violations.size(), 1U);
  EXPECT_EQ(turns.report.violations[0].what, "invariant `turns`");
}

TEST(Simulation, TheFleetGivesValues) {
  Fleet fleet = Masses(1, 0.1);
  fleet.params["k"] = {4, {}};
  fleet.initial["m"] = {5, {}};
  const std::string text =
      "param int k\nlocal:\n    int m\n    int n = 0\nGo:\n    eff:\n        n = k + m\n"
      "invariant sum: forall i in ID: n[i] != 9\n";
  EXPECT_EQ(Play(text, fleet).report.violations.size(), 1U);
}

TEST(Simulation, ValuesOfTheFleetMustFitTheProgram) {
  Fleet fleet = Masses(1);
  fleet.params["a"] = {1, {}};
  EXPECT_EQ(Play(Local("        n = 1\n"), fleet).messages,
            std::vector<std::string>{"the program has no parameter `a`"});
  fleet.params.clear();
  fleet.initial["n"] = {true, {}};
  EXPECT_EQ(Play("local:\n    int n\nGo:\n    eff:\n        n = 1\n", fleet).messages,
            std::vector<std::string>{"`n` must be an `int`"});
}

TEST(Simulation, ValuesOfTheFleetTakeNoPlaceOfDeclaredOnes) {
  Fleet fleet = Masses(1);
  fleet.initial["n"] = {3, {}};
  EXPECT_EQ(Play(Local("        n = 1\n"), fleet).messages,
            std::vector<std::string>{"`n` has a value already"});
  fleet.initial.clear();
  fleet.params["k"] = {3, {}};
  EXPECT_EQ(Play("param int k = 2\n" + Local("        n = k\n"), fleet).messages,
            std::vector<std::string>{"`k` has a value already"});
}

// The fleet's value comes before what an assumption would give; that the assumption does not hold is said.
TEST(Simulation, ValuesOfTheFleetComeBeforeDerivedOnes) {
  Fleet fleet = Masses(1, 0.1);
  fleet.initial["m"] = {1, {}};
  const Outcome outcome = Play(
      "local:\n    int m\nGo:\n    eff:\n        m = m\nassume initially: m == 2\n"
      "invariant one: forall i in ID: m[i] == 1\n",
      fleet);
  ASSERT_EQ(outcome.report.violations.size(), 1U);
  EXPECT_TRUE(outcome.report.violations[0].what.starts_with("assumption"));
}

TEST(Simulation, TheSameSeedGivesTheSameRun) {
  Fleet fleet = Masses(2, 2);
  fleet.skip = 0.5;
  SimulationOptions options;
  options.seed = 5;
  const std::string text = Local("        n = any int in 1..9\n        out << n\n");
  const Outcome first = Play(text, fleet, options);
  EXPECT_EQ(Play(text, fleet, options).report.log, first.report.log);
  options.seed = 6;
  EXPECT_NE(Play(text, fleet, options).report.log, first.report.log);
}

TEST(Simulation, SkippingIsAProbabilityAndNotForUrgentEvents) {
  Fleet fleet = Masses(1, 1);
  fleet.skip = 1;
  EXPECT_EQ(
      Play("local:\n    int n = 0\nGo:\n    pre: n >= 0\n    eff:\n        n = n + 1\n", fleet).report.events,
      0U);
  EXPECT_EQ(Play("local:\n    int n = 0\nGo:\n    pre urgent: n >= 0\n    eff:\n        n = n + 1\n", fleet)
                .report.events,
            10U);
}

TEST(Simulation, EndingsHaveNames) {
  EXPECT_EQ(Name(Ending::kTime), "time");
  EXPECT_EQ(Name(Ending::kQuiet), "quiet");
  EXPECT_EQ(Name(Ending::kInterrupted), "interrupted");
  EXPECT_EQ(Name(Ending::kFailed), "failed");
}

// -- over a network

const char* const kCount =
    "allwrite:\n    int total = 0\nlocal:\n    int n = 0\n    stream out\n"
    "invariant below: total <= 1000\n"
    "Add:\n    eff:\n        atomic:\n            total = total + 1\n        n = n + 1\n        out << n\n";

Outcome Over(const std::string& text, Fleet fleet, const NetworkFaults& network) {
  SimulationOptions options;
  options.network = &network;
  return Play(text, fleet, options);
}

TEST(NetworkedSimulation, ARoundIsOverBeforeTheNextOneBegins) {
  const Outcome outcome = Over(kGo, Masses(3, 1), {});
  ASSERT_TRUE(outcome.report.network);
  EXPECT_EQ(outcome.report.rounds, 9U);  // the first begins when all have said that they are there
  EXPECT_GT(outcome.report.network->datagrams, 0U);
  EXPECT_EQ(outcome.report.network->fallbacks, 0U);
  EXPECT_LT(outcome.report.network->waits.back(), 0.01);
  EXPECT_TRUE(outcome.messages.empty());
}

TEST(NetworkedSimulation, LossMakesRoundsLongerAndLosesNone) {
  NetworkFaults network;
  network.conditions.loss = 0.3;
  const Outcome outcome = Over(kCount, Masses(5, 4), network);
  EXPECT_GE(outcome.report.rounds, 30U);
  EXPECT_EQ(outcome.report.events, outcome.report.rounds);  // one robot at a time holds the lock
  EXPECT_GT(outcome.report.network->waits.back(), 0.01);
  EXPECT_TRUE(outcome.messages.empty());
}

// What a robot says counts when its round is final, once, and only if it got the lock.
TEST(NetworkedSimulation, RobotsSayWhatTheyDidAndNoMore) {
  NetworkFaults network;
  network.conditions.loss = 0.3;
  network.conditions.duplicate = 0.5;
  const Outcome outcome = Over(kCount, Masses(2, 1.2), network);
  EXPECT_EQ(outcome.report.log.size(), outcome.report.events);
  std::set<std::string> said(outcome.report.log.begin(), outcome.report.log.end());
  EXPECT_EQ(said.size(), outcome.report.log.size());
}

TEST(NetworkedSimulation, ARobotThatIsGoneIsGivenUpOrStopsAll) {
  NetworkFaults network;
  network.faults = {{cores::FaultKind::kCrash, 1'000'000'000, 3'000'000'000, 2, 0, 0}};
  Fleet fleet = Masses(3, 6);
  fleet.rounds.on_loss = runtime::rounds::OnLoss::kHalt;
  const Outcome halted = Over(kGo, fleet, network);
  EXPECT_LT(halted.report.rounds, 12U);
  EXPECT_GE(halted.report.network->fallbacks, 2U);
  fleet.rounds.on_loss = runtime::rounds::OnLoss::kEvict;
  const Outcome evicted = Over(kGo, fleet, network);
  EXPECT_GT(evicted.report.rounds, 30U);
  EXPECT_GE(evicted.report.network->epochs, 3U);  // with all, without robot 2, with all again
}

// Who hears nobody goes on to where it was sent; with a fallback, to where that says.
TEST(NetworkedSimulation, FallbacksReachTheBodies) {
  const std::string program =
      "using Motion:\n    sensors:\n        pos psn\n    actuators:\n        pos target\n"
      "Go:\n    eff:\n        Motion.target = pos(100, 0, 0)\n"
      "invariant behind: Motion.psn.x <= 8\n";
  NetworkFaults network;
  network.faults = {{cores::FaultKind::kAlone, 1'000'000'000, 20'000'000'000, 0, 0, 0}};
  Fleet fleet = Masses(2, 20);
  fleet.rounds.on_loss = runtime::rounds::OnLoss::kHalt;
  const Outcome holds = Over(program, fleet, network);
  EXPECT_FALSE(holds.report.violations.empty());
  const Outcome stops = Over(program + "fallback Motion:\n    target = psn\n", fleet, network);
  EXPECT_TRUE(stops.report.violations.empty());
  EXPECT_EQ(stops.report.network->fallbacks, 2U);
}

TEST(NetworkedSimulation, ManyRobotsAgreeOnABadRadio) {
  NetworkFaults network;
  network.conditions.loss = 0.3;
  network.conditions.most = 20'000'000;
  EXPECT_GE(Over(kGo, Masses(16, 5), network).report.rounds, 20U);
}

TEST(NetworkedSimulation, AnEventWithoutAValueIsAnError) {
  const Outcome outcome = Over(Local("        n = n + 1 / (2 - n) - 1 / (2 - n) + 1\n"), Masses(1), {});
  EXPECT_EQ(outcome.report.ended, Ending::kFailed);
  ASSERT_EQ(outcome.messages.size(), 1U);
}

}  // namespace
}  // namespace rondo::sim
