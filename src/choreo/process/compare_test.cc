#include "choreo/process/compare.h"

#include <gtest/gtest.h>

#include "choreo/graph/lower.h"
#include "choreo/syntax/parser.h"

namespace rondo::choreo {
namespace {

class Comparing : public testing::Test {
 protected:
  Comparing() {
    Parse(sources_, sources_.Add("test", R"(
robot R {
  state x : length in [-9 m, 9 m]
  motion Idle() interruptible [0 s, inf) {}
}
world W { a: R  b: R }
choreography C in W { { a: Idle(), b: Idle() } }
process a in C { Idle() }
)"),
          module_, diagnostics_);
    declarations_ = std::make_unique<Declarations>(module_, arena_, diagnostics_);
    graphs_ = Lower(module_, *declarations_);
    process_ = std::get<ProcessDef>(module_.items.back());
    Begin();
  }
  void Begin() {
    flow_ = BuildFlow(process_, graphs_.at(0), *declarations_);
    compare_ = std::make_unique<Compare>(*flow_, graphs_[0], *declarations_);
  }
  expr::TermId Variable(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Bool())); }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Module module_;
  expr::Arena arena_;
  std::unique_ptr<Declarations> declarations_;
  std::vector<Graph> graphs_;
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
  compare_->Need({}, "", p_, arena_.True(), {});
  compare_->Need({}, "", p_, p_, {});
  compare_->Need({}, "", arena_.False(), q_, {});
  compare_->Need({}, "", arena_.And(p_, q_), q_, {});
  EXPECT_EQ(compare_->conditions(), 0u);
}

TEST_F(Comparing, TheRestIsNeeded) {
  compare_->Need({}, "why", p_, q_, {NodeId(1)}, true);
  compare_->Need({}, "", arena_.Or(p_, q_), q_, {});
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
  EXPECT_TRUE(compare_->Refuted(p_, arena_.False()));
  EXPECT_TRUE(compare_->Refuted(arena_.Not(p_), p_));
  EXPECT_FALSE(compare_->Refuted(arena_.False(), arena_.False()));
  EXPECT_FALSE(compare_->Refuted(p_, q_));
  EXPECT_FALSE(compare_->Refuted(p_, arena_.True()));
}

TEST_F(Comparing, NothingRestartsByItself) {
  EXPECT_FALSE(compare_->restarts());
  EXPECT_FALSE(compare_->Restart());
}

}  // namespace
}  // namespace rondo::choreo
