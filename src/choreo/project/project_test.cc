#include "choreo/project/project.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "choreo/graph/lowered_module_test.h"

namespace rondo::choreo {
namespace {

/// A choreography of a, b and c, and its local types.
class Projected {
 public:
  explicit Projected(const std::string& steps)
      : m_("robot R {\n state x : length in [-9 m, 9 m]\n motion Idle() interruptible [0 s, inf) {}\n"
           " motion Go() noninterruptible [1 s, 1 s] {}\n}\n"
           "world W { a: R  b: R  c: R }\nchoreography C in W {\n" +
           steps + "\n}\n") {
    EXPECT_EQ(m_.graphs.size(), 1u) << m_.trouble();
    for (size_t r = 0; r < 3 && !m_.graphs.empty(); ++r)
      types_.push_back(Project(graph(), m_.module.exprs, RobotId(r), m_.diagnostics));
  }

  const LocalState& At(char robot, StateId state) const { return Type(robot).states.at(state.index()); }
  const LocalType& Type(char robot) const { return types_.at(static_cast<size_t>(robot - 'a')); }
  // All that may happen next, after these steps; choices are followed to their first alternative.
  std::vector<std::string> After(char robot, const std::vector<std::string>& steps) const {
    StateId state(0);
    for (const std::string& step : steps) {
      const auto& next = At(robot, state).next;
      const auto it = std::ranges::find_if(next, [&](const auto& t) { return Says(t.first) == step; });
      if (it == next.end()) return {"no " + step};
      state = it->second;
    }
    return Next(At(robot, state));
  }
  std::vector<std::string> Next(const LocalState& state) const {
    std::vector<std::string> result;
    for (const auto& [action, to] : state.next) result.push_back(Says(action));
    if (state.ends) result.push_back("end");
    std::ranges::sort(result);
    return result;
  }
  size_t Unclear() const {
    return static_cast<size_t>(
        std::ranges::count(m_.diagnostics.all(), diag::Kind::kChoreoUnmergeable, &diag::Diagnostic::kind));
  }
  std::string Text(char robot) const { return ToText(m_.graphs[0], m_.module.exprs, Type(robot)); }
  const Graph& graph() const { return m_.graphs[0]; }

 private:
  std::string Says(const Action& a) const { return Describe(m_.graphs[0], a); }

  LoweredModule m_;
  std::vector<LocalType> types_;
};

using Steps = std::vector<std::string>;

const char* const kTold = R"(
  choose at a {
    when a.x > 0 m { a -> b: left()  a -> c: left()  b -> c: more() }
    when a.x <= 0 m { a -> b: right()  a -> c: right() }
  })";

TEST(Projecting, EachSideOfAMessageSeesItsOwn) {
  const Projected p("a -> b: hello()");
  EXPECT_EQ(p.After('a', {}), Steps{"send b.hello"});
  EXPECT_EQ(p.After('b', {}), Steps{"receive a.hello"});
  EXPECT_EQ(p.After('a', {"send b.hello"}), Steps{"end"});
  EXPECT_EQ(p.After('b', {"receive a.hello"}), Steps{"end"});
}

TEST(Projecting, MessagesOfOthersAreNotSeen) {
  const Projected p("a -> b: hello()\n b -> c: on()");
  EXPECT_EQ(p.After('c', {}), Steps{"receive b.on"});
  EXPECT_EQ(p.After('b', {"receive a.hello"}), Steps{"send c.on"});
}

TEST(Projecting, EveryRobotMovesInAJointMotion) {
  const Projected p("{ a: Go(), b: Idle(), c: Idle() }\n a -> b: done()");
  EXPECT_EQ(p.After('a', {}), Steps{"move Go()"});
  EXPECT_EQ(p.After('c', {}), Steps{"move Idle()"});
  EXPECT_EQ(p.After('b', {"move Idle()"}), Steps{"receive a.done"});
  EXPECT_EQ(p.After('c', {"move Idle()"}), Steps{"end"});
}

TEST(Projecting, OnlyTheOwnThreadIsSeen) {
  const Projected p(
      "parallel { thread { { a: Go(), b: Idle() } a -> b: done() } thread { c: Idle() } }\n a -> c: on()");
  EXPECT_EQ(p.After('a', {}), Steps{"move Go()"});
  EXPECT_EQ(p.After('c', {}), Steps{"move Idle()"});
  EXPECT_EQ(p.After('a', {"move Go()", "send b.done"}), Steps{"send c.on"});
  EXPECT_EQ(p.After('b', {"move Idle()", "receive a.done"}), Steps{"end"});
  EXPECT_EQ(p.After('c', {"move Idle()"}), Steps{"receive a.on"});
}

TEST(Projecting, WhoChoosesHasAlternatives) {
  const Projected p(kTold);
  const LocalState& start = p.At('a', StateId(0));
  ASSERT_EQ(start.choice.size(), 2u);
  EXPECT_TRUE(start.next.empty());
  EXPECT_TRUE(start.choice[0].first.valid() && start.choice[1].first.valid());
  EXPECT_EQ(p.graph()[start.chosen].kind, NodeKind::kChoice);
  EXPECT_EQ(p.Next(p.At('a', start.choice[0].second)), Steps{"send b.left"});
  EXPECT_EQ(p.Next(p.At('a', start.choice[1].second)), Steps{"send b.right"});
}

TEST(Projecting, TheOthersWaitForEitherMessage) {
  const Projected p(kTold);
  EXPECT_EQ(p.Unclear(), 0u);
  EXPECT_EQ(p.After('b', {}), (Steps{"receive a.left", "receive a.right"}));
  EXPECT_EQ(p.After('b', {"receive a.left"}), Steps{"send c.more"});
  EXPECT_EQ(p.After('b', {"receive a.right"}), Steps{"end"});
  EXPECT_EQ(p.After('c', {"receive a.left"}), Steps{"receive b.more"});
}

TEST(Projecting, AlternativesThatLookAlikeAreOne) {
  const Projected p(R"(
    choose at a {
      when a.x > 0 m { a -> b: left()  b -> c: go() }
      when a.x <= 0 m { a -> b: right()  b -> c: go() }
    })");
  EXPECT_EQ(p.Unclear(), 0u);
  EXPECT_EQ(p.After('c', {}), Steps{"receive b.go"});
  EXPECT_EQ(p.After('c', {"receive b.go"}), Steps{"end"});
}

TEST(Projecting, WhoIsNotToldCannotEndOrGoOn) {
  const Projected p(R"(
    choose at a {
      when a.x > 0 m { a -> b: left()  b -> c: go() }
      when a.x <= 0 m { a -> b: right() }
    })");
  EXPECT_GT(p.Unclear(), 0u);
}

TEST(Projecting, WhoIsNotToldCannotChooseBetweenSteps) {
  const Projected speaks(R"(
    choose at a {
      when a.x > 0 m { a -> b: left()  c -> b: one() }
      when a.x <= 0 m { a -> b: right()  c -> b: two() }
    })");
  EXPECT_GT(speaks.Unclear(), 0u);
  const Projected hears(R"(
    choose at a {
      when a.x > 0 m { a -> b: left()  a -> c: one() }
      when a.x <= 0 m { a -> b: right()  b -> c: two() }
    })");
  EXPECT_GT(hears.Unclear(), 0u);  // one of two senders might be early
}

TEST(Projecting, LoopsComeBack) {
  const Projected p("loop { a -> b: ping()\n b -> a: pong() }");
  const StateId sent = p.At('a', StateId(0)).next.begin()->second;
  EXPECT_EQ(p.At('a', sent).next.begin()->second, StateId(0));
  EXPECT_EQ(p.Type('a').states.size(), 2u);
  EXPECT_TRUE(std::ranges::none_of(p.Type('a').states, &LocalState::ends));
}

TEST(Projecting, WhileGoesOnOrOut) {
  const Projected p(
      "while a.x > 0 m { a -> b: more()  a -> c: more() }\n a -> b: enough()  a -> c: enough()");
  const LocalState& start = p.At('a', StateId(0));
  ASSERT_EQ(start.choice.size(), 2u);
  EXPECT_TRUE(start.choice[0].first.valid());
  EXPECT_FALSE(start.choice[1].first.valid());
  EXPECT_EQ(p.After('b', {"receive a.more"}), (Steps{"receive a.enough", "receive a.more"}));
  EXPECT_EQ(p.After('b', {"receive a.enough"}), Steps{"end"});
}

TEST(Projecting, WaitingMayCompeteWithOneMotionOnly) {
  const Projected waits(R"(
    choose at a {
      when a.x > 0 m { a -> b: left()  a -> c: go() }
      when a.x <= 0 m { a -> b: right()  { a: Idle(), b: Idle(), c: Idle() } a -> c: go() }
    })");
  // The same message before and behind the motion, with the same meaning.
  EXPECT_EQ(waits.Unclear(), 0u);
  EXPECT_EQ(waits.After('c', {}), (Steps{"move Idle()", "receive a.go"}));
  const Projected holds(R"(
    choose at a {
      when a.x > 0 m { a -> b: left()  a -> c: go() }
      when a.x <= 0 m { a -> b: right()  { a: Idle(), b: Idle(), c: Go() } a -> c: go() }
    })");
  EXPECT_GT(holds.Unclear(), 0u);
}

TEST(Projecting, ActionsKnowWhereTheyComeFrom) {
  const Projected p(kTold);
  for (const auto& [action, nodes] : p.At('b', StateId(0)).nodes) {
    ASSERT_EQ(nodes.size(), 1u);
    EXPECT_EQ(p.graph()[nodes[0]].label, action.label);
  }
}

TEST(Projecting, TextHasALineForEachActionAndGuard) {
  const Projected p(kTold);
  const std::string text = p.Text('a');
  EXPECT_NE(text.find("when a.x > 0 m -> "), std::string::npos);
  EXPECT_NE(text.find("send c.right -> "), std::string::npos);
  EXPECT_NE(text.find(": end\n"), std::string::npos);
}

}  // namespace
}  // namespace rondo::choreo
