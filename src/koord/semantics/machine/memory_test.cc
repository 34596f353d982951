#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "koord/semantics/machine/machine.h"

namespace rondo::koord::semantics {
namespace {

using testing::ElementsAre;

// Shared: sum at 0, cells[3] from 1, place (a point) from 4; each robot: n at 0, own[2] from 1, the mark.
class Memory : public testing::Test {
 protected:
  Memory() {
    auto& types = model_.types;
    Declare(VariableKind::kAllwrite, types.integer());
    Declare(VariableKind::kAllwrite, types.Array(types.integer(), "3"));
    Declare(VariableKind::kAllwrite, types.pos());
    Declare(VariableKind::kLocal, types.integer());
    Declare(VariableKind::kLocal, types.Array(types.integer(), "2"));
    Declare(VariableKind::kParam, types.integer());
    layout_ = std::make_unique<Layout>(model_, 2, Lengths{{"3", 3}, {"2", 2}});
    memory_.resize(layout_->words());
    for (size_t i = 0; i < memory_.size(); ++i) memory_[i] = 100 + i;
  }
  void Declare(VariableKind kind, TypeId type) {
    model_.variables.push_back({kind, "v", "", type, {}, {}, -1});
  }
  Word Block(size_t robot, uint32_t at) const { return memory_[layout_->block(robot) + at]; }

  // `values` are pushed first, the first one deepest.
  bool Execute(std::vector<Word> values, std::vector<Instruction> instructions, size_t robot = 0,
               bool total = false) {
    code_.constants = std::move(values);
    code_.instructions.clear();
    for (uint32_t i = 0; i < code_.constants.size(); ++i) code_.instructions.push_back({Op::kConstant, i});
    code_.instructions.insert(code_.instructions.end(), instructions.begin(), instructions.end());
    code_.instructions.push_back({Op::kEnd});
    code_.spans.resize(code_.instructions.size());
    for (uint32_t i = 0; i < code_.spans.size(); ++i) code_.spans[i].begin = i;
    code_.frame_words = 4;
    machine_ = std::make_unique<Machine>(code_, *layout_, heap_);
    machine_->SetMemory(memory_.data());
    return machine_->Run(0, robot, total);
  }
  std::vector<std::pair<uint32_t, Word>> Writes() const {
    std::vector<std::pair<uint32_t, Word>> writes;
    for (const Write& w : machine_->writes()) writes.emplace_back(w.at, w.before);
    return writes;
  }
  std::vector<Word> Items(Word list) const { return {heap_[list].begin(), heap_[list].end()}; }
  Word List(std::vector<Word> words) { return heap_.Intern(words); }

  Model model_;
  Heap heap_;
  Code code_;
  std::unique_ptr<Layout> layout_;
  std::unique_ptr<Machine> machine_;
  std::vector<Word> memory_;
};

TEST_F(Memory, LoadsReadSharedWordsAndTheRobotsOwn) {
  ASSERT_TRUE(Execute({}, {{Op::kGlobal, 1, 2}, {Op::kOwn, 1, 2}}, 1));
  EXPECT_THAT(machine_->result(), ElementsAre(101, 102, Block(1, 1), Block(1, 2)));
}

TEST_F(Memory, CellsAreThoseOfTheRobotOnTheStack) {
  ASSERT_TRUE(Execute({1}, {{Op::kCell, 0, 2}}));
  EXPECT_THAT(machine_->result(), ElementsAre(Block(1, 0), Block(1, 1)));
  ASSERT_TRUE(Execute({1}, {{Op::kCellArray, 1, 1, 2}}));
  EXPECT_THAT(Items(machine_->result()[0]), ElementsAre(Block(1, 1), Block(1, 2)));
}

TEST_F(Memory, ThereIsNoCellOfAStrangeRobot) {
  for (const Word robot : {FromInt(-1), FromInt(2)}) {
    EXPECT_FALSE(Execute({robot}, {{Op::kCell, 0, 1}}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
    ASSERT_TRUE(Execute({robot}, {{Op::kCell, 0, 2}}, 0, true));
    EXPECT_THAT(machine_->result(), ElementsAre(0, 0));
    EXPECT_TRUE(machine_->used_default());
    EXPECT_FALSE(Execute({robot}, {{Op::kCellArray, 1, 1, 2}}));
    ASSERT_TRUE(Execute({robot}, {{Op::kCellArray, 1, 1, 2}}, 0, true));
    EXPECT_THAT(machine_->result(), ElementsAre(0));
  }
}

TEST_F(Memory, ARowHasTheWordsOfEveryRobot) {
  ASSERT_TRUE(Execute({}, {{Op::kRow, 0, 1}}));
  EXPECT_THAT(Items(machine_->result()[0]), ElementsAre(Block(0, 0), Block(1, 0)));
}

TEST_F(Memory, ArraysAreListsAsValues) {
  ASSERT_TRUE(Execute({}, {{Op::kGlobalArray, 1, 1, 3}, {Op::kOwnArray, 1, 1, 2}}, 1));
  EXPECT_THAT(Items(machine_->result()[0]), ElementsAre(101, 102, 103));
  EXPECT_THAT(Items(machine_->result()[1]), ElementsAre(Block(1, 1), Block(1, 2)));
}

TEST_F(Memory, ItemsOfArraysAreReadByIndex) {
  ASSERT_TRUE(Execute({2}, {{Op::kGlobalAt, 1, 1, 3}}));
  EXPECT_THAT(machine_->result(), ElementsAre(103));
  ASSERT_TRUE(Execute({1}, {{Op::kOwnAt, 1, 1, 2}}, 1));
  EXPECT_THAT(machine_->result(), ElementsAre(Block(1, 2)));
}

TEST_F(Memory, AnIndexOutOfRangeIsAFaultInEventsAndZeroInFormulas) {
  for (const Word index : {FromInt(-1), FromInt(3)}) {
    EXPECT_FALSE(Execute({index}, {{Op::kGlobalAt, 1, 1, 3}}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
    ASSERT_TRUE(Execute({index}, {{Op::kGlobalAt, 1, 1, 3}}, 0, true));
    EXPECT_THAT(machine_->result(), ElementsAre(0));
    EXPECT_TRUE(machine_->used_default());
  }
}

TEST_F(Memory, EachLevelOfANestedIndexHasItsOwnRange) {
  ASSERT_TRUE(Execute({1, 2}, {{Op::kFlatIndex, 3}}));
  EXPECT_THAT(machine_->result(), ElementsAre(5));
  EXPECT_FALSE(Execute({0, 3}, {{Op::kFlatIndex, 3}}));
  EXPECT_EQ(machine_->fault(), Fault::kIndex);
  EXPECT_FALSE(Execute({1, FromInt(-1)}, {{Op::kFlatIndex, 3}}));
  EXPECT_FALSE(Execute({FromInt(-1), 2}, {{Op::kFlatIndex, 3}}));
}

TEST_F(Memory, AWrongInnerIndexReadsZeroInFormulas) {
  ASSERT_TRUE(Execute({0, 3}, {{Op::kFlatIndex, 3}, {Op::kGlobalAt, 0, 1, 6}}, 0, true));
  EXPECT_THAT(machine_->result(), ElementsAre(0));
  EXPECT_TRUE(machine_->used_default());
}

TEST_F(Memory, PackedArraysUnpackToTheSameWords) {
  code_.shapes = {{{2, 3}, 1}};
  ASSERT_TRUE(Execute({1, 2, 3, 4, 5, 6}, {{Op::kPack, 0, 6}}));
  const Word list = machine_->result()[0];
  const std::vector<Word> rows = Items(list);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_THAT(Items(rows[1]), ElementsAre(4, 5, 6));
  ASSERT_TRUE(Execute({list}, {{Op::kUnpack, 0, 6}}));
  EXPECT_THAT(machine_->result(), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(Memory, AListOfAnotherShapeIsNotUnpacked) {
  code_.shapes = {{{2, 2}, 1}};
  const Word ragged = List({List({1, 2}), List({3})});
  EXPECT_FALSE(Execute({ragged}, {{Op::kUnpack, 0, 4}}));
  EXPECT_EQ(machine_->fault(), Fault::kIndex);
  ASSERT_TRUE(Execute({ragged}, {{Op::kUnpack, 0, 4}}, 0, true));
  EXPECT_THAT(machine_->result(), ElementsAre(0, 0, 0, 0));
}

TEST_F(Memory, ASliceKeepsAPartOfTheTop) {
  ASSERT_TRUE(Execute({9, 1, 2, 3, 4}, {{Op::kSlice, 1, 2, 4}}));
  EXPECT_THAT(machine_->result(), ElementsAre(9, 2, 3));
}

TEST_F(Memory, AMemberOfARecordIsReplaced) {
  ASSERT_TRUE(Execute({9, 70, 71, 1, 2, 3, 4}, {{Op::kReplace, 1, 2, 4}}));
  EXPECT_THAT(machine_->result(), ElementsAre(9, 1, 70, 71, 4));
}

TEST_F(Memory, TheFrameKeepsLocalVariables) {
  ASSERT_TRUE(Execute({7, 8}, {{Op::kSetFrame, 1, 2}, {Op::kFrame, 2, 1}, {Op::kFrame, 1, 1}}));
  EXPECT_THAT(machine_->result(), ElementsAre(8, 7));
}

TEST_F(Memory, APopForgetsWords) {
  ASSERT_TRUE(Execute({7, 8, 9}, {{Op::kPop, 2}, {Op::kRobot}}, 1));
  EXPECT_THAT(machine_->result(), ElementsAre(7, 1));
}

TEST_F(Memory, ParametersAreNoPartOfTheState) {
  ASSERT_TRUE(Execute({41}, {{Op::kSetParam, 0, 1}, {Op::kParam, 0, 1}}));
  EXPECT_THAT(machine_->result(), ElementsAre(41));
  EXPECT_TRUE(machine_->writes().empty());
}

TEST_F(Memory, AWriteRemembersWhatWasThere) {
  ASSERT_TRUE(Execute({5}, {{Op::kSetGlobal, 0, 1}}));
  EXPECT_EQ(memory_[0], 5U);
  EXPECT_THAT(Writes(), ElementsAre(std::pair<uint32_t, Word>{0, 100}));
  EXPECT_THAT(machine_->units(), ElementsAre(Unit{0, 1}));
}

TEST_F(Memory, SeveralWritesOfOneWordAreOne) {
  ASSERT_TRUE(Execute({5, 6}, {{Op::kSetGlobal, 0, 1}, {Op::kSetGlobal, 0, 1}}));
  EXPECT_EQ(memory_[0], 5U);
  EXPECT_THAT(Writes(), ElementsAre(std::pair<uint32_t, Word>{0, 100}));
  EXPECT_THAT(machine_->units(), ElementsAre(Unit{0, 1}));
}

TEST_F(Memory, UndoTakesEveryWriteBack) {
  const std::vector<Word> before = memory_;
  ASSERT_TRUE(
      Execute({1, 2, 3, 4, 5, 6},
              {{Op::kSetGlobal, 4, 3}, {Op::kSetOwn, 0, 1}, {Op::kSetGlobal, 0, 1}, {Op::kSetOwn, 0, 1}}));
  EXPECT_NE(memory_, before);
  machine_->Undo();
  EXPECT_EQ(memory_, before);
  EXPECT_TRUE(machine_->writes().empty());
  EXPECT_TRUE(machine_->units().empty());
}

TEST_F(Memory, WritesBeforeAFaultCanBeTakenBack) {
  const std::vector<Word> before = memory_;
  EXPECT_FALSE(Execute({1, 0, 5}, {{Op::kSetGlobal, 0, 1}, {Op::kDivInt}}));
  EXPECT_EQ(memory_[0], 5U);
  machine_->Undo();
  EXPECT_EQ(memory_, before);
}

TEST_F(Memory, TheNextRunForgetsTheWritesOfTheLast) {
  ASSERT_TRUE(Execute({5}, {{Op::kSetGlobal, 0, 1}}));
  ASSERT_TRUE(machine_->Run(0, 0, false));
  EXPECT_THAT(Writes(), ElementsAre(std::pair<uint32_t, Word>{0, 5}));
}

TEST_F(Memory, AVariableIsOneUnitAndCellsAreMany) {
  ASSERT_TRUE(Execute({1, 2, 3}, {{Op::kSetGlobal, 4, 3, 0, 0}}));
  EXPECT_THAT(machine_->units(), ElementsAre(Unit{4, 3}));
  ASSERT_TRUE(Execute({1, 2, 3}, {{Op::kSetGlobal, 1, 3, 0, 1}}));
  EXPECT_THAT(machine_->units(), ElementsAre(Unit{1, 1}, Unit{2, 1}, Unit{3, 1}));
}

TEST_F(Memory, OwnVariablesAreNoUnits) {
  ASSERT_TRUE(Execute({7, 1, 8}, {{Op::kSetOwn, 0, 1}, {Op::kSetOwnAt, 1, 1, 2, 1}}, 1));
  EXPECT_EQ(Block(1, 0), 8U);
  EXPECT_EQ(Block(1, 2), 7U);
  EXPECT_TRUE(machine_->units().empty());
}

TEST_F(Memory, AnItemOfAnArrayIsWrittenByItself) {
  ASSERT_TRUE(Execute({7, 1}, {{Op::kSetGlobalAt, 1, 1, 3, 1}}));
  EXPECT_EQ(memory_[1], 101U);
  EXPECT_EQ(memory_[2], 7U);
  EXPECT_EQ(memory_[3], 103U);
  EXPECT_THAT(machine_->units(), ElementsAre(Unit{2, 1}));
}

TEST_F(Memory, ARowOfCellsIsAUnitForEachCell) {
  ASSERT_TRUE(Execute({7, 8, 1}, {{Op::kSetGlobalAt, 1, 2, 2, 1}}));
  EXPECT_EQ(memory_[3], 7U);
  EXPECT_EQ(memory_[4], 8U);
  EXPECT_THAT(machine_->units(), ElementsAre(Unit{3, 1}, Unit{4, 1}));
}

TEST_F(Memory, NothingIsWrittenBesideAnArray) {
  const std::vector<Word> before = memory_;
  for (const Word index : {FromInt(-1), FromInt(3)}) {
    EXPECT_FALSE(Execute({7, index}, {{Op::kSetGlobalAt, 1, 1, 3, 1}}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
    EXPECT_EQ(memory_, before);
    EXPECT_TRUE(machine_->units().empty());
  }
}

TEST_F(Memory, AListOfTheRightLengthBecomesAnArray) {
  ASSERT_TRUE(Execute({List({7, 8, 9})}, {{Op::kSetGlobalArray, 1, 1, 3}}));
  EXPECT_EQ(memory_[3], 9U);
  EXPECT_THAT(machine_->units(), ElementsAre(Unit{1, 1}, Unit{2, 1}, Unit{3, 1}));
  EXPECT_FALSE(Execute({List({7, 8})}, {{Op::kSetGlobalArray, 1, 1, 3}}));
  EXPECT_EQ(machine_->fault(), Fault::kIndex);
  ASSERT_TRUE(Execute({List({5, 6})}, {{Op::kSetOwnArray, 1, 1, 2}}, 1));
  EXPECT_EQ(Block(1, 2), 6U);
}

TEST_F(Memory, AFaultSaysWhichInstructionFailed) {
  EXPECT_FALSE(Execute({1, 0}, {{Op::kDivInt}}));
  EXPECT_EQ(machine_->fault_span().begin, 2U);
  EXPECT_TRUE(machine_->result().empty());
}

}  // namespace
}  // namespace rondo::koord::semantics
