#include "choreo/graph/lower.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "choreo/graph/lowered_module_test.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using expr::Rational;

const char* const kRobots = R"(
robot R {
  state x : length in [-9 m, 9 m]
  motion Idle() interruptible [0 s, inf) {}
  motion Go(d : length, T = 1 s) noninterruptible [T, 2 * T] { modifies x }
}
world W { a: R  b: R  c: R }
)";

/// A choreography of a, b and c as a graph.
class Lowered {
 public:
  explicit Lowered(const std::string& steps, const std::string& before = "")
      : m_(kRobots + before + "choreography C in W {\n" + steps + "\n}\n") {
    EXPECT_NE(m_.declarations, nullptr) << m_.trouble();
  }

  bool good() const { return m_.graphs.size() == 1; }
  const Graph& graph() const { return m_.graphs.at(0); }
  std::vector<Kind> kinds() const { return m_.kinds(); }
  size_t Count(NodeKind kind) const {
    return static_cast<size_t>(std::ranges::count(graph().nodes, kind, &Node::kind));
  }
  NodeId Find(NodeKind kind) const {
    const auto it = std::ranges::find(graph().nodes, kind, &Node::kind);
    EXPECT_NE(it, graph().nodes.end());
    return NodeId(static_cast<size_t>(it - graph().nodes.begin()));
  }
  const Node& Start() const { return graph()[graph().start]; }
  const Node& Next(const Node& node, size_t i = 0) const { return graph()[node.next.at(i)]; }

 private:
  LoweredModule m_;
};

// What is reported of these steps; no graph is made.
std::vector<Kind> Reported(const std::string& steps, const std::string& before = "") {
  const Lowered lowered(steps, before);
  EXPECT_FALSE(lowered.good());
  return lowered.kinds();
}
using Kinds = std::vector<Kind>;
const std::string kAll = "{ a: Idle(), b: Idle(), c: Idle() }\n";

TEST(Lowering, StepsFollowEachOtherToTheEnd) {
  const Lowered g("a -> b: hello(2 m)\n" + kAll);
  ASSERT_TRUE(g.good());
  EXPECT_EQ(g.Start().kind, NodeKind::kMessage);
  EXPECT_EQ(g.Start().from, g.graph().Find("a"));
  EXPECT_EQ(g.Start().to, g.graph().Find("b"));
  EXPECT_EQ(g.Start().label, "hello");
  EXPECT_EQ(g.Start().payload.size(), 1u);
  EXPECT_EQ(g.Next(g.Start()).kind, NodeKind::kMotion);
  EXPECT_EQ(g.Next(g.Start()).parts.size(), 3u);
  EXPECT_EQ(g.Next(g.Next(g.Start())).kind, NodeKind::kEnd);
}

TEST(Lowering, ChoicesMeetBehindTheirAlternatives) {
  const Lowered g("choose at a { when a.x > 0 m { a -> b: l() } when a.x <= 0 m { a -> b: r() } }\n" + kAll);
  ASSERT_TRUE(g.good());
  const Node& choice = g.Start();
  ASSERT_EQ(choice.kind, NodeKind::kChoice);
  EXPECT_EQ(choice.chooser, g.graph().Find("a"));
  EXPECT_EQ(g.Next(choice, 0).label, "l");
  EXPECT_EQ(g.Next(choice, 1).label, "r");
  EXPECT_EQ(&g.Next(g.Next(choice, 0)), &g.Next(g.Next(choice, 1)));
  EXPECT_NE(choice.guard_terms.at(0), choice.guard_terms.at(1));
}

TEST(Lowering, WhileIsDecidedByWhoseStateItReads) {
  const Lowered g("while b.x > 0 m { b -> a: more() }\n" + kAll);
  ASSERT_TRUE(g.good());
  const Node& choice = g.graph()[g.Find(NodeKind::kChoice)];
  EXPECT_EQ(choice.chooser, g.graph().Find("b"));
  EXPECT_FALSE(choice.guards.at(1).valid());
  // Round again to where it begins; out to what follows.
  EXPECT_EQ(g.Next(choice, 0).next.at(0), g.graph().start);
  EXPECT_EQ(g.Next(choice, 1).kind, NodeKind::kMotion);
}

TEST(Lowering, LoopsNeverEnd) {
  const Lowered g("loop { a -> b: ping() }");
  ASSERT_TRUE(g.good());
  EXPECT_EQ(g.Next(g.Next(g.Start())).kind, NodeKind::kMerge);
  EXPECT_EQ(g.Next(g.Start()).next.at(0), g.graph().start);
}

TEST(Lowering, ContinueGoesToItsRecursion) {
  const Lowered g(
      "rec X { a -> b: l()\n rec Y { b -> a: r()\n choose at a { when a.x > 0 m { a -> b: x() continue X }"
      " when a.x <= 0 m { a -> b: y() continue Y } } } }");
  ASSERT_TRUE(g.good());
  const Node& choice = g.graph()[g.Find(NodeKind::kChoice)];
  EXPECT_EQ(g.Next(choice, 0).next.at(0), g.graph().start);
  EXPECT_EQ(g.Next(g.Next(g.Next(choice, 1))).label, "r");
}

TEST(Lowering, ThreadsDivideTheRobots) {
  const Lowered g("parallel { thread { { a: Go(1 m), b: Idle() } a -> b: l() } thread { c: Idle() } }\n" +
                  kAll);
  ASSERT_TRUE(g.good());
  const Node& fork = g.Start();
  ASSERT_EQ(fork.kind, NodeKind::kFork);
  EXPECT_EQ(fork.threads.at(0), (Scope{RobotId(0), RobotId(1)}));
  EXPECT_EQ(fork.threads.at(1), Scope{RobotId(2)});
  EXPECT_EQ(g.graph()[fork.join].kind, NodeKind::kJoin);
  EXPECT_EQ(g.Next(g.Next(fork, 1)).kind, NodeKind::kJoin);
  EXPECT_EQ(g.Next(fork, 1).scope, fork.threads.at(1));
  EXPECT_EQ(g.Next(g.graph()[fork.join]).kind, NodeKind::kMotion);
}

TEST(Lowering, EqualMotionsAreOneInstance) {
  const Lowered g(
      "{ a: Go(1 m), b: Idle(), c: Idle() }\n { a: Go(100 cm, T = 1 s), b: Idle(), c: Idle() }\n"
      "{ a: Go(2 m), b: Go(1 m), c: Idle() }");
  ASSERT_TRUE(g.good());
  // a: two; b: Idle and Go; c: Idle.
  EXPECT_EQ(g.graph().instances.size(), 5u);
}

TEST(Lowering, DurationsDependOnArguments) {
  const Lowered g("{ a: Go(1 m, 3 s), b: Idle(), c: Idle() }");
  ASSERT_TRUE(g.good());
  const Duration& go = g.Start().parts.at(0).duration;
  EXPECT_EQ(go.least, Rational(3));
  EXPECT_EQ(go.most, Rational(6));
  EXPECT_FALSE(go.interruptible);
  EXPECT_FALSE(g.Start().parts.at(1).duration.most.has_value());
}

TEST(Lowering, OptionsAreRead) {
  EXPECT_FALSE(Lowered(kAll).graph().equal_durations);
  EXPECT_TRUE(Lowered("option equal_durations\n" + kAll).graph().equal_durations);
  EXPECT_EQ(Reported("option equal_speed\n" + kAll), Kinds{Kind::kChoreoUndeclared});
}

TEST(Lowering, NamesMustBeDeclared) {
  EXPECT_EQ(Reported("a -> d: l()"), Kinds{Kind::kChoreoUndeclared});
  EXPECT_EQ(Reported("{ a: Fly(), b: Idle(), c: Idle() }"), Kinds{Kind::kChoreoUndeclared});
  EXPECT_EQ(Reported("a -> b: l()\n continue X"), Kinds{Kind::kChoreoUndeclared});
  EXPECT_EQ(Reported("a -> b: l(d: weight)"), Kinds{Kind::kChoreoUndeclared});
}

TEST(Lowering, NobodySpeaksToItself) { EXPECT_EQ(Reported("a -> a: l()"), Kinds{Kind::kChoreoSelfMessage}); }

TEST(Lowering, EveryRobotMovesOnceInAStep) {
  EXPECT_EQ(Reported("{ a: Idle(), b: Idle() }"), Kinds{Kind::kChoreoNotMoving});
  EXPECT_EQ(Reported("{ a: Idle(), b: Idle(), c: Idle(), a: Idle() }"), Kinds{Kind::kChoreoRobotTwice});
}

TEST(Lowering, EveryRobotIsInOneThread) {
  EXPECT_EQ(Reported("parallel { thread { a: Idle() } thread { b: Idle() } }"),
            Kinds{Kind::kChoreoRobotNowhere});
  const Kinds twice =
      Reported("parallel { thread { { a: Idle(), b: Idle() } } thread { { b: Idle(), c: Idle() } } }");
  EXPECT_NE(std::ranges::find(twice, Kind::kChoreoRobotTwice), twice.end());
}

TEST(Lowering, RobotsOfOtherThreadsAreOutOfScope) {
  EXPECT_EQ(Reported("parallel { thread { { a: Idle(), b: Idle() } a -> c: l() } thread { c: Idle() } }"),
            Kinds{Kind::kChoreoOutOfScope});
}

TEST(Lowering, RecursionsDoNotReachIntoThreads) {
  EXPECT_EQ(
      Reported("rec X { parallel { thread { { a: Idle(), b: Idle() } continue X } thread { c: Idle() } } }"),
      Kinds{Kind::kChoreoOutOfScope});
}

TEST(Lowering, ArgumentsFitTheirParameters) {
  EXPECT_EQ(Reported("{ a: Go(), b: Idle(), c: Idle() }"), Kinds{Kind::kChoreoArity});
  EXPECT_EQ(Reported("{ a: Idle(1 m), b: Idle(), c: Idle() }"), Kinds{Kind::kChoreoArity});
  EXPECT_EQ(Reported("{ a: Go(1 s), b: Idle(), c: Idle() }"), Kinds{Kind::kRobotUnit});
  EXPECT_EQ(Reported("{ a: Go(b.x), b: Idle(), c: Idle() }"), Kinds{Kind::kRobotType});
}

TEST(Lowering, DurationsAreNotEmpty) {
  EXPECT_EQ(Reported("{ a: Go(1 m, -1 s), b: Idle(), c: Idle() }"), Kinds{Kind::kChoreoDuration});
}

TEST(Lowering, WhoChoosesKnowsTheGuards) {
  EXPECT_EQ(Reported("choose at a { when b.x > 0 m { a -> b: l() } when b.x <= 0 m { a -> b: r() } }"),
            (Kinds{Kind::kChoreoGuardOwner, Kind::kChoreoGuardOwner}));
  EXPECT_EQ(Reported("while 1 > 0 { a -> b: l() }"), Kinds{Kind::kChoreoGuardOwner});
}

TEST(Lowering, WhoSpeaksKnowsWhatItSays) {
  EXPECT_EQ(Reported("a -> b: l(b.x)"), Kinds{Kind::kChoreoGuardOwner});
  EXPECT_TRUE(Lowered("a -> b: l(a.x)").good());
}

TEST(Lowering, BehindALoopNothingIsReached) {
  EXPECT_EQ(Lowered("loop { a -> b: l() }\n a -> b: r()").kinds(), Kinds{Kind::kChoreoUnreachable});
}

TEST(Lowering, PayloadsHaveDifferentNames) {
  EXPECT_EQ(Reported("a -> b: l(d: length, d: time)"), Kinds{Kind::kChoreoDuplicate});
}

TEST(Lowering, ScopesAreListedInWords) {
  const Lowered g(kAll);
  const Graph& graph = g.graph();
  EXPECT_EQ(graph.Names({RobotId(0)}), "`a`");
  EXPECT_EQ(graph.Names({RobotId(0), RobotId(2)}), "`a` and `c`");
  EXPECT_EQ(graph.Names({RobotId(0), RobotId(1), RobotId(2)}), "`a`, `b` and `c`");
  EXPECT_FALSE(graph.Find("d").has_value());
}

}  // namespace
}  // namespace rondo::choreo
