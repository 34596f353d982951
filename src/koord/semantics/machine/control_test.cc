#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "koord/semantics/machine/machine.h"

namespace rondo::koord::semantics {
namespace {

using testing::ElementsAre;

// Knows function 0, the sum of its arguments and the robot, and keeps what is logged.
class Adder final : public Host {
 public:
  Answer Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) override {
    if (f > 1) return Answer::kLater;
    if (f != 0) return Answer::kNone;
    result[0] = robot;
    for (const Word a : arguments) result[0] += a;
    return Answer::kValue;
  }
  void Log(size_t robot, size_t type, std::span<const Word> value) override {
    logged = {robot, type};
    logged.insert(logged.end(), value.begin(), value.end());
  }
  std::vector<Word> logged;
};

// Two robots with a local int each, and a shared one.
class Control : public testing::Test {
 protected:
  Control() {
    model_.variables.push_back({VariableKind::kAllwrite, "s", "", model_.types.integer(), {}, {}, -1});
    model_.variables.push_back({VariableKind::kLocal, "n", "", model_.types.integer(), {}, {}, -1});
    layout_ = std::make_unique<Layout>(model_, 2, Lengths{});
    memory_.resize(layout_->words());
    code_.constants = {0, 1, 2, 3, 4, 5, 6, 7};  // constant k is k
    code_.frame_words = 4;
  }
  void Load(std::vector<Instruction> instructions) {
    code_.instructions = std::move(instructions);
    code_.spans.resize(code_.instructions.size());
    machine_ = std::make_unique<Machine>(code_, *layout_, heap_);
    machine_->SetMemory(memory_.data());
    machine_->SetHost(&host_);
    machine_->marks().resize(2);
  }
  bool Execute(std::vector<Instruction> instructions, size_t robot = 0, bool total = false) {
    Load(std::move(instructions));
    return machine_->Run(0, robot, total);
  }

  Model model_;
  Heap heap_;
  Code code_;
  Adder host_;
  std::unique_ptr<Layout> layout_;
  std::unique_ptr<Machine> machine_;
  std::vector<Word> memory_;
};

TEST_F(Control, JumpsSkipInstructions) {
  ASSERT_TRUE(Execute({{Op::kJump, 2}, {Op::kConstant, 1}, {Op::kConstant, 2}, {Op::kEnd}}));
  EXPECT_THAT(machine_->result(), ElementsAre(2));
}

TEST_F(Control, ConditionalJumpsLookAtTheTop) {
  for (const uint32_t condition : {0U, 1U}) {
    ASSERT_TRUE(Execute({{Op::kConstant, condition}, {Op::kJumpUnless, 3}, {Op::kConstant, 5}, {Op::kEnd}}));
    EXPECT_EQ(machine_->result().size(), condition);
    ASSERT_TRUE(Execute({{Op::kConstant, condition}, {Op::kJumpIf, 3}, {Op::kConstant, 5}, {Op::kEnd}}));
    EXPECT_EQ(machine_->result().size(), 1 - condition);
  }
}

TEST_F(Control, ALoopIsHalfOpen) {
  ASSERT_TRUE(Execute({{Op::kConstant, 2},
                       {Op::kSetFrame, 0, 1},
                       {Op::kConstant, 5},
                       {Op::kSetFrame, 1, 1},
                       {Op::kFrame, 0, 1},  // the loop begins here
                       {Op::kForNext, 0, 1, 4},
                       {Op::kEnd}}));
  EXPECT_THAT(machine_->result(), ElementsAre(2, 3, 4));
}

TEST_F(Control, AProgramThatRunsForEverIsAFault) {
  code_.constants[1] = Word{1} << 60;
  EXPECT_FALSE(Execute({{Op::kConstant, 1}, {Op::kSetFrame, 1, 1}, {Op::kForNext, 0, 1, 2}, {Op::kEnd}}));
  EXPECT_EQ(machine_->fault(), Fault::kRunaway);
}

TEST_F(Control, AFunctionReturnsBehindItsCall) {
  code_.function_entry = {0, 3};
  ASSERT_TRUE(Execute({{Op::kCall, 1}, {Op::kConstant, 2}, {Op::kEnd}, {Op::kConstant, 7}, {Op::kReturn}}));
  EXPECT_THAT(machine_->result(), ElementsAre(7, 2));
}

TEST_F(Control, CallsMayBeNested) {
  code_.function_entry = {0, 3, 6};
  ASSERT_TRUE(Execute({{Op::kCall, 1},
                       {Op::kConstant, 1},
                       {Op::kEnd},  // begin
                       {Op::kCall, 2},
                       {Op::kConstant, 2},
                       {Op::kReturn},  // function 1
                       {Op::kConstant, 3},
                       {Op::kReturn}}));  // function 2
  EXPECT_THAT(machine_->result(), ElementsAre(3, 2, 1));
}

TEST_F(Control, ExternalFunctionsAreComputedByTheHost) {
  ASSERT_TRUE(Execute({{Op::kConstant, 3}, {Op::kConstant, 4}, {Op::kExternal, 0, 2, 1}, {Op::kEnd}}, 1));
  EXPECT_THAT(machine_->result(), ElementsAre(8));
}

TEST_F(Control, AFunctionThatTheHostDoesNotKnowIsAFaultOrZero) {
  const std::vector<Instruction> call{{Op::kConstant, 3}, {Op::kExternal, 1, 1, 2}, {Op::kEnd}};
  EXPECT_FALSE(Execute(call));
  EXPECT_EQ(machine_->fault(), Fault::kExternal);
  ASSERT_TRUE(Execute(call, 0, true));
  EXPECT_THAT(machine_->result(), ElementsAre(0, 0));
  EXPECT_TRUE(machine_->used_default());
}

TEST_F(Control, AFunctionThatIsNotFinishedIsASkip) {
  EXPECT_FALSE(Execute({{Op::kConstant, 3}, {Op::kExternal, 2, 1, 1}, {Op::kEnd}}));
  EXPECT_EQ(machine_->fault(), Fault::kNotYet);
}

TEST_F(Control, NoFunctionHasAValueWithoutAHost) {
  Load({{Op::kExternal, 0, 0, 1}, {Op::kEnd}});
  machine_->SetHost(nullptr);
  EXPECT_FALSE(machine_->Run(0, 0, false));
  EXPECT_EQ(machine_->fault(), Fault::kExternal);
}

// Checks summary 4: the constant `holds`, then pushes 5.
std::vector<Instruction> Summary(uint32_t holds) {
  return {{Op::kSummaryBegin, 5},
          {Op::kConstant, holds},
          {Op::kSummaryTest, 4},
          {Op::kSummaryEnd},
          {Op::kJump, 5},
          {Op::kConstant, 5},
          {Op::kEnd}};
}

TEST_F(Control, ASummaryThatDoesNotHoldIsRemembered) {
  Load(Summary(0));
  machine_->CheckSummaries(true);
  ASSERT_TRUE(machine_->Run(0, 0, false));
  EXPECT_EQ(machine_->violated_summary(), 4);
  machine_->ForgetSummary();
  EXPECT_EQ(machine_->violated_summary(), -1);
}

TEST_F(Control, ASummaryThatHoldsIsNot) {
  Load(Summary(1));
  machine_->CheckSummaries(true);
  ASSERT_TRUE(machine_->Run(0, 0, false));
  EXPECT_EQ(machine_->violated_summary(), -1);
}

TEST_F(Control, SummariesAreCheckedOnlyInEventsAndWhenAsked) {
  Load(Summary(0));
  ASSERT_TRUE(machine_->Run(0, 0, false));
  EXPECT_EQ(machine_->violated_summary(), -1);
  machine_->CheckSummaries(true);
  ASSERT_TRUE(machine_->Run(0, 0, true));
  EXPECT_EQ(machine_->violated_summary(), -1);
}

TEST_F(Control, OperationsBehindASummaryAreFaultsAgain) {
  std::vector<Instruction> code = Summary(1);
  code.back() = {Op::kConstant, 0};
  code.push_back({Op::kDivInt});
  code.push_back({Op::kEnd});
  Load(code);
  machine_->CheckSummaries(true);
  EXPECT_FALSE(machine_->Run(0, 0, false));
  EXPECT_EQ(machine_->fault(), Fault::kDivision);
}

TEST_F(Control, ALockIsTakenUnlessAnotherRobotHoldsIt) {
  Load({{Op::kLock}, {Op::kConstant, 1}, {Op::kEnd}});
  ASSERT_TRUE(machine_->Run(0, 0, false));
  EXPECT_TRUE(machine_->locked());
  machine_->SetLockTaken(true);
  EXPECT_FALSE(machine_->Run(0, 0, false));
  EXPECT_EQ(machine_->fault(), Fault::kNoLock);
  EXPECT_FALSE(machine_->locked());
}

TEST_F(Control, OnlyTheLastRunStops) {
  Load({{Op::kStop}, {Op::kEnd}, {Op::kEnd}});
  ASSERT_TRUE(machine_->Run(0, 0, false));
  EXPECT_TRUE(machine_->stopped());
  ASSERT_TRUE(machine_->Run(1, 0, false));
  EXPECT_FALSE(machine_->stopped());
}

TEST_F(Control, AnExplicitFaultIsADefaultInFormulas) {
  const std::vector<Instruction> code{
      {Op::kFault, static_cast<uint32_t>(Fault::kReturn)}, {Op::kConstant, 0}, {}};
  EXPECT_FALSE(Execute(code));
  EXPECT_EQ(machine_->fault(), Fault::kReturn);
  ASSERT_TRUE(Execute(code, 0, true));
  EXPECT_TRUE(machine_->used_default());
}

TEST_F(Control, OldReadsTheEndOfTheProgramTransition) {
  std::vector<Word> before(layout_->words(), 3);
  memory_.assign(memory_.size(), 8);
  Load({{Op::kGlobal, 0, 1},
        {Op::kOld},
        {Op::kGlobal, 0, 1},
        {Op::kOwn, 0, 1},
        {Op::kNow},
        {Op::kOwn, 0, 1},
        {}});
  machine_->SetMemory(memory_.data(), before.data());
  ASSERT_TRUE(machine_->Run(0, 1, true));
  EXPECT_THAT(machine_->result(), ElementsAre(8, 3, 3, 8));
}

TEST_F(Control, WithoutAnOldStateOldIsNow) {
  memory_[0] = 6;
  ASSERT_TRUE(Execute({{Op::kOld}, {Op::kGlobal, 0, 1}, {Op::kNow}, {Op::kEnd}}, 0, true));
  EXPECT_THAT(machine_->result(), ElementsAre(6));
}

TEST_F(Control, StreamsGoToTheHost) {
  ASSERT_TRUE(Execute({{Op::kConstant, 1}, {Op::kConstant, 6}, {Op::kConstant, 7}, {Op::kLog, 2, 2}, {}}, 1));
  EXPECT_THAT(host_.logged, ElementsAre(1, 2, 6, 7));
  EXPECT_THAT(machine_->result(), ElementsAre(1));
}

TEST_F(Control, TakenBranchesAreMarked) {
  ASSERT_TRUE(Execute({{Op::kMark, 1}, {Op::kEnd}}));
  EXPECT_EQ(machine_->marks(), (std::vector<bool>{false, true}));
}

TEST_F(Control, AFormulaHoldsIfItsValueIsTrue) {
  Load({{Op::kRobot}, {Op::kEnd}});
  EXPECT_FALSE(machine_->RunFormula(0, 0));
  EXPECT_TRUE(machine_->RunFormula(0, 1));
}

}  // namespace
}  // namespace rondo::koord::semantics
