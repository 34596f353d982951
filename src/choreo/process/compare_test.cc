#include "choreo/process/compare.h"

#include <gtest/gtest.h>

#include "choreo/graph/lowered_module_test.h"

namespace rondo::choreo {
namespace {

class Comparing : public testing::Test {
 protected:
  Comparing()
      : m_(R"(
robot R {
  state x : length in [-9 m, 9 m]
  motion Idle() interruptible [0 s, inf) {}
}
world W { a: R  b: R }
choreography C in W { { a: Idle(), b: Idle() } }
process a in C { Idle() }
)") {
    process_ = std::get<ProcessDef>(m_.module.items.back());
    Begin();
  }
  void Begin() {
    flow_ = BuildFlow(process_, m_.graphs.at(0), *m_.declarations);
    compare_ = std::make_unique<Compare>(*flow_, m_.graphs[0], *m_.declarations);
  }
  expr::TermId Variable(const char* name) {
    return m_.arena.Variable(m_.arena.Declare(name, {}, m_.arena.Bool()));
  }

  LoweredModule m_;
  ProcessDef process_;
  std::optional<Flow> flow_;
  std::unique_ptr<Compare> compare_;
  const expr::TermId p_ = Variable("p"), q_ = Variable("q");
};

TEST_F(Comparing, LabelsAreEqualLetterByLetter) {
  EXPECT_TRUE(compare_->SameLabel("done", "done"));
  EXPECT_FALSE(compare_->SameLabel("done", "Done"));
  EXPECT_FALSE(compare_->SameLabel("done", "msg_done"));
}

TEST_F(Comparing, LooseLabelsMayDifferInCaseAndPrefix) {
  process_.loose_names = true;
  Begin();
  EXPECT_TRUE(compare_->SameLabel("OK", "ok"));
  EXPECT_TRUE(compare_->SameLabel("OK", "msg_ok"));
  EXPECT_FALSE(compare_->SameLabel("OK", "okay"));
  EXPECT_FALSE(compare_->SameLabel("OK", "m_ok"));
}

TEST_F(Comparing, WhatIsPlainlyTrueIsNotNeeded) {
  compare_->Need({}, "", p_, m_.arena.True(), {});
  compare_->Need({}, "", p_, p_, {});
  compare_->Need({}, "", m_.arena.False(), q_, {});
  compare_->Need({}, "", m_.arena.And(p_, q_), q_, {});
  EXPECT_EQ(compare_->conditions(), 0u);
}

TEST_F(Comparing, TheRestIsNeeded) {
  compare_->Need({}, "why", p_, q_, {NodeId(1)}, true);
  compare_->Need({}, "", m_.arena.Or(p_, q_), q_, {});
  const auto conditions = compare_->TakeConditions();
  ASSERT_EQ(conditions.size(), 2u);
  EXPECT_EQ(conditions[0].what, "why");
  EXPECT_EQ(conditions[0].hypothesis, p_);
  EXPECT_EQ(conditions[0].goal, q_);
  EXPECT_TRUE(conditions[0].moving);
  EXPECT_EQ(conditions[0].robot, RobotId(0));
}

TEST_F(Comparing, ConditionsOfAFailedAttemptAreForgotten) {
  compare_->Need({}, "first", p_, q_, {});
  const size_t mark = compare_->conditions();
  compare_->Need({}, "second", q_, p_, {});
  compare_->Forget(mark);
  ASSERT_EQ(compare_->conditions(), 1u);
  EXPECT_EQ(compare_->TakeConditions()[0].what, "first");
}

TEST_F(Comparing, OnlyWhatFailsEverywhereIsRefuted) {
  EXPECT_TRUE(compare_->Refuted(p_, m_.arena.False()));
  EXPECT_TRUE(compare_->Refuted(m_.arena.Not(p_), p_));
  EXPECT_FALSE(compare_->Refuted(m_.arena.False(), m_.arena.False()));
  EXPECT_FALSE(compare_->Refuted(p_, q_));
  EXPECT_FALSE(compare_->Refuted(p_, m_.arena.True()));
}

TEST_F(Comparing, NothingRestartsByItself) {
  EXPECT_FALSE(compare_->restarts());
  EXPECT_FALSE(compare_->Restart());
}

}  // namespace
}  // namespace rondo::choreo
