#include "choreo/prove/routes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "choreo/graph/lowered_module_test.h"

namespace rondo::choreo {
namespace {

const std::string kWorld = R"(robot R {
  state x : length in [-5 m, 5 m]
  body sphere(self, 10 cm)
  motion Idle() interruptible [0 s, inf) {}
  motion Go(to: length) noninterruptible [1 s, 1 s] { modifies x post x == to }
}
world W { a: R b: R at (2 m, 0, 0) }
choreography C in W {
  initially a.x == 0
  loop {
    choose at a {
      when a.x >= 0 { a -> b: left() { a: Go(1 m), b: Idle() } }
      when a.x < 0 {
        a -> b: right()
        parallel {
          thread region x < 1 m { a: Go(2 m) a: Go(3 m) }
          thread region x > 1 m { b: Go(4 m) }
        }
      }
    }
    { a: Go(5 m), b: Idle() }
  }
}
)";

class RoutesThroughLoops : public testing::Test {
 protected:
  // The motion of this argument.
  NodeId Going(const std::string& text) const {
    const auto& nodes = graph().nodes;
    for (size_t n = 0; n < nodes.size(); ++n) {
      for (const Part& p : nodes[n].parts) {
        if (graph().instances[p.instance].text == text) return NodeId(n);
      }
    }
    ADD_FAILURE() << text;
    return NodeId(0);
  }
  // What is gone to on the way, in order, threads one after the other.
  static std::vector<std::string> MotionsOf(const Route& route) {
    std::vector<std::string> motions;
    Follow(route, route.graph.start, motions);
    return motions;
  }
  static void Follow(const Route& route, NodeId at, std::vector<std::string>& motions) {
    const Node& n = route.graph[at];
    if (n.kind == NodeKind::kMotion) motions.push_back(route.graph.instances[n.parts[0].instance].text);
    for (const NodeId next : n.next) {
      if (route.graph[next].kind != NodeKind::kJoin) Follow(route, next, motions);
    }
    if (n.kind == NodeKind::kFork) Follow(route, n.join, motions);
  }
  const Graph& graph() const { return module_.graphs.at(0); }

  LoweredModule module_{kWorld};
};

using Texts = std::vector<std::string>;

TEST_F(RoutesThroughLoops, TakeEachAlternative) {
  ASSERT_EQ(module_.graphs.size(), 1u) << module_.trouble();
  const Routes routes = RoutesTo(graph(), Going("Go(5 m)"), 1, 100);
  ASSERT_EQ(routes.all.size(), 2u);
  EXPECT_TRUE(routes.complete);
  EXPECT_EQ(MotionsOf(routes.all[0]), (Texts{"Go(1 m)", "Go(5 m)"}));
  EXPECT_EQ(MotionsOf(routes.all[1]), (Texts{"Go(2 m)", "Go(3 m)", "Go(4 m)", "Go(5 m)"}));
  EXPECT_EQ(routes.all[1].turns.size(), 1u);
  EXPECT_EQ(routes.all[1].turns[0].what, "alternative 2 of 2");
}

TEST_F(RoutesThroughLoops, GoRoundAsOftenAsTheyMay) {
  const Routes routes = RoutesTo(graph(), Going("Go(1 m)"), 2, 100);
  ASSERT_EQ(routes.all.size(), 3u);
  EXPECT_EQ(MotionsOf(routes.all[0]), (Texts{"Go(1 m)"}));
  EXPECT_EQ(routes.all[0].rounds, 1u);
  for (const Route& route : routes.all) {
    EXPECT_EQ(MotionsOf(route).back(), "Go(1 m)");
    EXPECT_EQ(route.graph[route.target].kind, NodeKind::kMotion);
    EXPECT_EQ(route.graph[route.graph[route.target].next[0]].kind, NodeKind::kEnd);
  }
}

// What a thread does is known without the others.
TEST_F(RoutesThroughLoops, LeaveOtherThreadsOut) {
  const Routes routes = RoutesTo(graph(), Going("Go(3 m)"), 1, 100);
  ASSERT_EQ(routes.all.size(), 1u);
  EXPECT_EQ(MotionsOf(routes.all[0]), (Texts{"Go(2 m)", "Go(3 m)"}));
}

TEST_F(RoutesThroughLoops, SayThatThereAreMore) {
  const Routes routes = RoutesTo(graph(), Going("Go(5 m)"), 3, 4);
  EXPECT_EQ(routes.all.size(), 4u);
  EXPECT_FALSE(routes.complete);
}

}  // namespace
}  // namespace rondo::choreo
