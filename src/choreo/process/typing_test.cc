#include "choreo/process/typing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "choreo/graph/lowered_module_test.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

const char* const kRobots = R"(
robot R {
  state x : length in [-9 m, 9 m]
  motion Idle() interruptible [0 s, inf) {}
  motion Go(d : length, T = 1 s) noninterruptible [T, T] { modifies x }
  motion Rest() interruptible [0 s, inf) {}
  motion Drift() interruptible [0 s, inf) { modifies x }
  motion Short() interruptible [0 s, 1 s] {}
}
world W { a: R  b: R  c: R }
choreography C in W {
)";

// One after the other.
const std::string kStraight = std::string(kRobots) + R"(
  { a: Go(1 m), b: Idle(), c: Idle() }
  a -> b: done(2 m)
  b -> a: ok()
}
)";

// One of two ways, and round again.
const std::string kChoice = std::string(kRobots) + R"(
  rec X {
    choose at a {
      when a.x > 1 m { a -> b: more()  a -> c: more()  continue X }
      when a.x <= 1 m { a -> b: end()  a -> c: end() }
    }
  }
}
)";

struct Outcome {
  std::vector<Kind> kinds;
  std::vector<SideCondition> open;
  bool good() const { return kinds.empty() && open.empty(); }
};

Outcome Typed(const std::string& choreography, const std::string& processes) {
  LoweredModule m(choreography + processes);
  std::vector<choreo::Typed> typed;
  for (Graph& graph : m.graphs) {
    choreo::Typed one{&graph, {}};
    for (size_t r = 0; r < graph.robots.size(); ++r)
      one.types.push_back(Project(graph, m.module.exprs, RobotId(r), m.diagnostics));
    typed.push_back(std::move(one));
  }
  EXPECT_EQ(m.diagnostics.errors(), 0u) << m.trouble();
  Outcome outcome;
  if (m.declarations != nullptr) outcome.open = CheckProcesses(m.module, typed, *m.declarations);
  outcome.kinds = m.kinds();
  return outcome;
}

// Of a process of robot a in the straight choreography.
Outcome Straight(const std::string& acts) { return Typed(kStraight, "process a in C {\n" + acts + "\n}\n"); }
Outcome Choice(const std::string& acts) { return Typed(kChoice, "process a in C {\n" + acts + "\n}\n"); }

using Kinds = std::vector<Kind>;

TEST(Typing, WhatTheTypeAsksForIsAccepted) {
  EXPECT_TRUE(Straight("Go(1 m)\n send b.done(2 m)\n receive from b { ok => {} }").good());
  EXPECT_TRUE(
      Typed(kStraight, "process b in C { receive from a while Idle() { done(d) => send a.ok() } }").good());
  EXPECT_TRUE(Typed(kStraight, "process c in C { Idle() }").good());
}

TEST(Typing, StepsInAnotherOrderAreNot) {
  EXPECT_EQ(Straight("send b.done(2 m)\n Go(1 m)\n receive from b { ok => {} }").kinds,
            Kinds{Kind::kProcessStep});
  EXPECT_EQ(Straight("Go(1 m)\n receive from b { ok => send b.done(2 m) }").kinds, Kinds{Kind::kProcessStep});
}

TEST(Typing, AProcessMayNotEndBefore) {
  EXPECT_EQ(Straight("Go(1 m)\n send b.done(2 m)").kinds, Kinds{Kind::kProcessStep});
  EXPECT_EQ(Straight("exit").kinds, Kinds{Kind::kProcessStep});
}

TEST(Typing, AProcessMayNotGoOnBehindTheEnd) {
  EXPECT_EQ(Straight("Go(1 m)\n send b.done(2 m)\n receive from b { ok => Idle() }").kinds,
            Kinds{Kind::kProcessStep});
}

TEST(Typing, MessagesGoToWhomTheyAreFor) {
  EXPECT_EQ(Straight("Go(1 m)\n send c.done(2 m)\n receive from b { ok => {} }").kinds,
            Kinds{Kind::kProcessPeer});
  EXPECT_EQ(Straight("Go(1 m)\n send b.done(2 m)\n receive from c { ok => {} }").kinds,
            Kinds{Kind::kProcessPeer});
}

TEST(Typing, MessagesHaveTheirLabels) {
  EXPECT_EQ(Straight("Go(1 m)\n send b.gone(2 m)\n receive from b { ok => {} }").kinds,
            Kinds{Kind::kProcessLabel});
}

TEST(Typing, EveryMessageThatMayComeHasACase) {
  EXPECT_EQ(Straight("Go(1 m)\n send b.done(2 m)\n receive from b { no => {} }").kinds,
            Kinds{Kind::kProcessCase});
  EXPECT_EQ(Typed(kChoice, "process b in C { rec X { receive from a { more => continue X } } }").kinds,
            Kinds{Kind::kProcessCase});
}

TEST(Typing, MoreCasesThanNeededAreAllowed) {
  EXPECT_TRUE(Straight("Go(1 m)\n send b.done(2 m)\n receive from b { ok => {} no => Go(7 m) }").good());
}

TEST(Typing, PayloadsAreThoseOfTheChoreography) {
  const auto sends = [](const std::string& payload) {
    return Straight("Go(1 m)\n send b.done(" + payload + ")\n receive from b { ok => {} }");
  };
  EXPECT_TRUE(sends("200 cm").good());
  EXPECT_EQ(sends("3 m").kinds, Kinds{Kind::kProcessPayload});
  EXPECT_EQ(sends("2 s").kinds, Kinds{Kind::kProcessPayload});
  EXPECT_EQ(sends("").kinds, Kinds{Kind::kProcessPayload});
  EXPECT_EQ(sends("2 m, 2 m").kinds, Kinds{Kind::kProcessPayload});
}

TEST(Typing, PayloadsThatDependOnTheStateAreLeftOpen) {
  const Outcome run = Straight("Go(1 m)\n send b.done(a.x)\n receive from b { ok => {} }");
  EXPECT_TRUE(run.kinds.empty());
  EXPECT_EQ(run.open.size(), 1u);
}

TEST(Typing, MotionsHaveTheirArguments) {
  const auto moves = [](const std::string& motion) {
    return Straight(motion + "\n send b.done(2 m)\n receive from b { ok => {} }");
  };
  EXPECT_TRUE(moves("Go(100 cm)").good());
  EXPECT_TRUE(moves("Go(1 m, T = 1 s)").good());
  EXPECT_EQ(moves("Go(2 m)").kinds, Kinds{Kind::kProcessArgument});
  EXPECT_EQ(moves("Go(1 m, 2 s)").kinds, Kinds{Kind::kProcessArgument});
  EXPECT_EQ(moves("Idle()").kinds, Kinds{Kind::kProcessMotion});
}

TEST(Typing, AnotherMotionMayStandForOneThatItRefines) {
  const auto c = [](const std::string& motion) {
    return Typed(kStraight, "process c in C { " + motion + " }");
  };
  EXPECT_TRUE(c("Rest()").good());
  EXPECT_EQ(c("Go(1 m)").kinds, Kinds{Kind::kProcessMotion});  // cannot be interrupted
  EXPECT_EQ(c("Short()").kinds, Kinds{Kind::kProcessMotion});  // ends too early
  EXPECT_EQ(c("Drift()").kinds, Kinds{Kind::kProcessMotion});  // changes what stays
}

TEST(Typing, WhoIsAskedToMoveMayNotOnlyWait) {
  EXPECT_EQ(Typed(kStraight, "process b in C { receive from a { done(d) => send a.ok() } }").kinds,
            Kinds{Kind::kProcessMotion});
}

TEST(Typing, WhoWaitsForAMessageStandsStill) {
  const auto waits = [](const std::string& motion) {
    return Straight("Go(1 m)\n send b.done(2 m)\n receive from b while " + motion + " { ok => {} }");
  };
  EXPECT_TRUE(waits("Idle()").good());
  EXPECT_EQ(waits("Drift()").kinds, Kinds{Kind::kProcessMotion});
  EXPECT_EQ(waits("Go(1 m)").kinds, Kinds{Kind::kProcessMotion});
}

TEST(Typing, EachAlternativeMayBeTakenUnderItsGuard) {
  EXPECT_TRUE(Choice("while x > 1 m { send b.more() send c.more() }\n send b.end()\n send c.end()").good());
  EXPECT_TRUE(Choice("rec X { if x > 1 m { send b.more() send c.more() continue X } else "
                     "{ send b.end() send c.end() } }")
                  .good());
}

TEST(Typing, GuardsThatDoNotImplyThoseOfTheChoreographyAreLeftOpen) {
  const Outcome run = Choice("while x > 0 m { send b.more() send c.more() }\n send b.end()\n send c.end()");
  EXPECT_TRUE(run.kinds.empty());
  EXPECT_EQ(run.open.size(), 2u);
}

TEST(Typing, ExchangedAlternativesAreRejected) {
  EXPECT_EQ(Choice("if x > 1 m { send b.end() send c.end() } else { send b.end() send c.end() }").kinds,
            Kinds{Kind::kProcessGuard});
}

TEST(Typing, WhatIsNoAlternativeIsRejected) {
  EXPECT_EQ(Choice("send b.other()\n send c.other()").kinds, Kinds{Kind::kProcessGuard});
  EXPECT_EQ(Choice("Idle()").kinds, Kinds{Kind::kProcessGuard});
}

TEST(Typing, BothWaysOfAConditionAreChecked) {
  EXPECT_EQ(
      Straight("if x > 0 m { Go(1 m) } else { Go(2 m) }\n send b.done(2 m)\n receive from b { ok => {} }")
          .kinds,
      Kinds{Kind::kProcessArgument});
}

TEST(Typing, TheStateIsNotAssignedTo) {
  EXPECT_EQ(Straight("x = 1 m\n Go(1 m)\n send b.done(2 m)\n receive from b { ok => {} }").kinds,
            Kinds{Kind::kProcessStep});
}

TEST(Typing, OthersStatesAreNotKnown) {
  EXPECT_EQ(Choice("while b.x > 1 m { send b.more() send c.more() }\n send b.end()\n send c.end()").kinds,
            Kinds{Kind::kProcessStep});
}

TEST(Typing, ReceivedValuesMayBeUsed) {
  EXPECT_TRUE(Typed(std::string(kRobots) + "a -> b: go(2 m)\n { a: Idle(), b: Go(2 m), c: Idle() }\n}\n",
                    "process b in C { receive from a { go(d) => Go(d) } }")
                  .good());
  EXPECT_EQ(Typed(std::string(kRobots) + "a -> b: go(2 m)\n { a: Idle(), b: Go(3 m), c: Idle() }\n}\n",
                  "process b in C { receive from a { go(d) => Go(d) } }")
                .kinds,
            Kinds{Kind::kProcessArgument});
}

TEST(Typing, EachRobotHasOneProcess) {
  EXPECT_EQ(Typed(kStraight, "process c in C { Idle() }\nprocess c in C { Idle() }").kinds,
            Kinds{Kind::kChoreoDuplicate});
}

TEST(Typing, ProcessesBelongToWhatThereIs) {
  EXPECT_EQ(Typed(kStraight, "process d in C { Idle() }").kinds, Kinds{Kind::kChoreoUndeclared});
  EXPECT_EQ(Typed(kStraight, "process c in D { Idle() }").kinds, Kinds{Kind::kChoreoUndeclared});
  EXPECT_TRUE(Typed(kStraight, "process c { Idle() }").good());
}

TEST(Typing, ConditionsNameTheirRobotAndGraph) {
  const Outcome run = Choice("while x > 0 m { send b.more() send c.more() }\n send b.end()\n send c.end()");
  for (const SideCondition& c : run.open) {
    EXPECT_EQ(c.robot, RobotId(0));
    EXPECT_NE(c.graph, nullptr);
    EXPECT_FALSE(c.at.empty());
  }
}

}  // namespace
}  // namespace rondo::choreo
