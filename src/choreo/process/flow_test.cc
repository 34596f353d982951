#include "choreo/process/flow.h"

#include <gtest/gtest.h>

#include <optional>

#include "choreo/graph/lowered_module_test.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using Kinds = std::vector<Kind>;

class Flows : public testing::Test {
 protected:
  // The graph of a process of robot a; what is reported is kept.
  std::optional<Flow> Of(const std::string& acts) {
    m_.emplace(std::string(R"(
robot R {
  state x : length in [-9 m, 9 m]
  motion Idle() interruptible [0 s, inf) {}
}
world W { a: R  b: R }
choreography C in W { { a: Idle(), b: Idle() } }
process a in C {
)") + acts + "\n}\n");
    EXPECT_NE(m_->declarations, nullptr);
    return BuildFlow(std::get<ProcessDef>(m_->module.items.back()), m_->graphs.at(0), *m_->declarations);
  }
  Kinds Reported(const std::string& acts) {
    EXPECT_FALSE(Of(acts).has_value());
    return m_->kinds();
  }

  std::optional<LoweredModule> m_;
};

TEST_F(Flows, ActsFollowEachOther) {
  const auto flow = Of("Idle()\n send b.go()");
  ASSERT_TRUE(flow.has_value());
  const FlowNode& first = (*flow)[flow->start];
  EXPECT_EQ(first.kind, FlowKind::kMove);
  EXPECT_EQ((*flow)[first.next].kind, FlowKind::kSend);
  EXPECT_EQ((*flow)[first.next].peer, RobotId(1));
  EXPECT_EQ((*flow)[(*flow)[first.next].next].kind, FlowKind::kExit);
  EXPECT_EQ(flow->robot, RobotId(0));
}

TEST_F(Flows, ConditionsHaveTwoWays) {
  const auto flow = Of("if x > 0 m { send b.yes() } else { send b.no() }\n Idle()");
  ASSERT_TRUE(flow.has_value());
  const FlowNode& condition = (*flow)[flow->start];
  ASSERT_EQ(condition.kind, FlowKind::kIf);
  EXPECT_EQ((*flow)[condition.next].act->label.text, "yes");
  EXPECT_EQ((*flow)[condition.otherwise].act->label.text, "no");
  EXPECT_EQ((*flow)[condition.next].next, (*flow)[condition.otherwise].next);
}

TEST_F(Flows, WhileComesBackToItsCondition) {
  const auto flow = Of("while x > 0 m { Idle() }\n send b.end()");
  ASSERT_TRUE(flow.has_value());
  const FlowNode& head = (*flow)[flow->start];
  EXPECT_EQ((*flow)[head.next].next, flow->start);
  EXPECT_EQ((*flow)[head.otherwise].kind, FlowKind::kSend);
}

TEST_F(Flows, ContinueGoesToTheInnermostOfItsName) {
  const auto flow = Of("rec X { send b.outer()\n rec X { send b.inner()\n continue X } }");
  ASSERT_TRUE(flow.has_value());
  const FlowNode& outer = (*flow)[(*flow)[flow->start].next];
  const FlowId again = (*flow)[(*flow)[outer.next].next].next;
  EXPECT_EQ(again, outer.next);
}

TEST_F(Flows, NamesOfACaseAreKnownInItAndNotBehind) {
  const auto flow = Of("receive from b { go(d) => send b.on()\n no => {} }\n Idle()");
  ASSERT_TRUE(flow.has_value());
  const FlowNode& receive = (*flow)[flow->start];
  ASSERT_EQ(receive.cases.size(), 2u);
  const FlowNode& inside = (*flow)[receive.cases[0].next];
  EXPECT_EQ(inside.bindings, std::vector<const Case*>{receive.cases[0].source});
  EXPECT_TRUE((*flow)[inside.next].bindings.empty());
  EXPECT_EQ(receive.cases[1].next, inside.next);
}

TEST_F(Flows, LoopsThatDoNothingAreReported) {
  EXPECT_EQ(Reported("loop { if x > 0 m { Idle() } else { n = 1 } }"), Kinds{Kind::kChoreoUnguarded});
}

TEST_F(Flows, BehindTheEndNothingIsReached) {
  EXPECT_TRUE(Of("exit\n Idle()").has_value());
  ASSERT_EQ(m_->diagnostics.all().size(), 1u);
  EXPECT_EQ(m_->diagnostics.all()[0].kind, Kind::kChoreoUnreachable);
}

TEST_F(Flows, RobotsMustExist) { EXPECT_EQ(Reported("send c.go()"), Kinds{Kind::kChoreoUndeclared}); }

TEST_F(Flows, RecursionsMustExist) {
  EXPECT_EQ(Reported("Idle()\n continue X"), Kinds{Kind::kChoreoUndeclared});
}

TEST_F(Flows, EachMessageHasOneCase) {
  EXPECT_EQ(Reported("receive from b { go => {} go => Idle() }"), Kinds{Kind::kChoreoDuplicate});
}

TEST_F(Flows, ReceivedNamesAreNotAssignedTo) {
  EXPECT_EQ(Reported("receive from b { go(d) => {} }\n d = 1 m"), Kinds{Kind::kChoreoDuplicate});
}

TEST_F(Flows, NamesHaveAValueOnEveryWay) {
  EXPECT_EQ(Reported("if x > 0 m { n = 1 } else { Idle() }\n if n > 0 { Idle() } else { send b.no() }"),
            Kinds{Kind::kChoreoUndeclared});
}

TEST_F(Flows, NamesMayBeReadWhereEveryWayAssigns) {
  EXPECT_TRUE(Of("if x > 0 m { n = 1 } else { n = 2 }\n if n > 1 { Idle() } else { send b.no() }"));
}

}  // namespace
}  // namespace rondo::choreo
