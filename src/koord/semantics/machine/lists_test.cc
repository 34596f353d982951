#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "koord/semantics/machine/machine.h"

namespace rondo::koord::semantics {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Lists of pairs of words, texts, sets of values.
class Lists : public testing::Test {
 protected:
  bool Execute(std::vector<Word> values, const Instruction& instruction, bool total = false,
               Machine::Chooser chooser = nullptr) {
    code_.constants = std::move(values);
    code_.instructions.clear();
    for (uint32_t i = 0; i < code_.constants.size(); ++i) code_.instructions.push_back({Op::kConstant, i});
    code_.instructions.push_back(instruction);
    code_.instructions.push_back({Op::kEnd});
    code_.spans.resize(code_.instructions.size());
    machine_ = std::make_unique<Machine>(code_, layout_, heap_);
    machine_->SetMemory(memory_.data());
    machine_->SetChooser(std::move(chooser));
    return machine_->Run(0, 0, total);
  }
  Word List(std::vector<Word> words) { return heap_.Intern(words); }
  std::vector<Word> Items(Word list) const { return {heap_[list].begin(), heap_[list].end()}; }
  // The items of the list that is the only result.
  std::vector<Word> Made() const { return Items(machine_->result()[0]); }
  std::vector<double> Doubles() const {
    std::vector<double> values;
    for (const Word w : Made()) values.push_back(ToFloat(w));
    return values;
  }
  bool GridInt(int64_t low, int64_t high, int64_t step) {
    return Execute({FromInt(low), FromInt(high), FromInt(step)}, {Op::kGridInt});
  }
  bool GridFloat(double low, double high, double step) {
    return Execute({FromFloat(low), FromFloat(high), FromFloat(step)}, {Op::kGridFloat});
  }

  Model model_;
  Layout layout_{model_, 1, {}};
  std::vector<Word> memory_ = std::vector<Word>(layout_.words());
  Heap heap_;
  Code code_;
  std::unique_ptr<Machine> machine_;
};

TEST_F(Lists, AreMadeOfItemsOnTheStack) {
  ASSERT_TRUE(Execute({9, 1, 2, 3, 4}, {Op::kListMake, 2, 2}));
  ASSERT_EQ(machine_->result().size(), 2U);
  EXPECT_EQ(machine_->result()[0], 9U);
  EXPECT_THAT(Items(machine_->result()[1]), ElementsAre(1, 2, 3, 4));
}

TEST_F(Lists, TheLengthCountsItemsAndNotWords) {
  ASSERT_TRUE(Execute({List({1, 2, 3, 4, 5, 6})}, {Op::kListLength, 2}));
  EXPECT_THAT(machine_->result(), ElementsAre(3));
}

TEST_F(Lists, ItemsAreReadByIndex) {
  ASSERT_TRUE(Execute({List({1, 2, 3, 4}), 1}, {Op::kListAt, 2}));
  EXPECT_THAT(machine_->result(), ElementsAre(3, 4));
}

TEST_F(Lists, AnIndexOutOfRangeIsAFaultOrZero) {
  for (const Word index : {FromInt(-1), FromInt(2)}) {
    EXPECT_FALSE(Execute({List({1, 2, 3, 4}), index}, {Op::kListAt, 2}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
    ASSERT_TRUE(Execute({List({1, 2, 3, 4}), index}, {Op::kListAt, 2}, true));
    EXPECT_THAT(machine_->result(), ElementsAre(0, 0));
    EXPECT_TRUE(machine_->used_default());
  }
}

TEST_F(Lists, SettingAnItemMakesAnotherList) {
  const Word list = List({1, 2, 3, 4});
  ASSERT_TRUE(Execute({8, 9, list, 1}, {Op::kListSet, 2}));
  EXPECT_THAT(Made(), ElementsAre(1, 2, 8, 9));
  EXPECT_THAT(Items(list), ElementsAre(1, 2, 3, 4));
}

TEST_F(Lists, AnItemBesideTheListIsNotSet) {
  for (const Word index : {FromInt(-1), FromInt(2)}) {
    EXPECT_FALSE(Execute({8, 9, List({1, 2, 3, 4}), index}, {Op::kListSet, 2}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
  }
}

TEST_F(Lists, AppendingMakesAnotherList) {
  const Word list = List({1, 2});
  ASSERT_TRUE(Execute({list, 3, 4}, {Op::kListAppend, 2}));
  EXPECT_THAT(Made(), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(Items(list), ElementsAre(1, 2));
}

TEST_F(Lists, RemovingTakesTheFirstEqualItem) {
  ASSERT_TRUE(Execute({List({1, 1, 1, 2, 3, 3, 1, 2}), 1, 2}, {Op::kListRemove, 2}));
  EXPECT_THAT(Made(), ElementsAre(1, 1, 3, 3, 1, 2));
}

TEST_F(Lists, AnItemIsInsertedBetweenOthers) {
  ASSERT_TRUE(Execute({List({1, 2, 3, 4}), FromInt(1), 7, 8}, {Op::kListInsert, 2}));
  EXPECT_THAT(Made(), ElementsAre(1, 2, 7, 8, 3, 4));
  ASSERT_TRUE(Execute({List({1, 2, 3, 4}), FromInt(2), 7, 8}, {Op::kListInsert, 2}));
  EXPECT_THAT(Made(), ElementsAre(1, 2, 3, 4, 7, 8));
  for (const int64_t beyond : {int64_t{-1}, int64_t{3}}) {
    EXPECT_FALSE(Execute({List({1, 2, 3, 4}), FromInt(beyond), 7, 8}, {Op::kListInsert, 2}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
  }
}

TEST_F(Lists, AnItemIsTakenAway) {
  ASSERT_TRUE(Execute({List({1, 2, 3, 4, 5, 6}), FromInt(1)}, {Op::kListDrop, 2}));
  EXPECT_THAT(Made(), ElementsAre(1, 2, 5, 6));
  for (const int64_t beyond : {int64_t{-1}, int64_t{3}}) {
    EXPECT_FALSE(Execute({List({1, 2, 3, 4, 5, 6}), FromInt(beyond)}, {Op::kListDrop, 2}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
  }
}

TEST_F(Lists, ASliceIsAPart) {
  const Word list = List({1, 2, 3, 4, 5, 6});
  ASSERT_TRUE(Execute({list, FromInt(1), FromInt(3)}, {Op::kListSlice, 2}));
  EXPECT_THAT(Made(), ElementsAre(3, 4, 5, 6));
  ASSERT_TRUE(Execute({list, FromInt(2), FromInt(2)}, {Op::kListSlice, 2}));
  EXPECT_THAT(Made(), IsEmpty());
  for (const auto& [from, to] : {std::pair(-1, 2), std::pair(2, 1), std::pair(0, 4)}) {
    EXPECT_FALSE(Execute({list, FromInt(from), FromInt(to)}, {Op::kListSlice, 2}));
    EXPECT_EQ(machine_->fault(), Fault::kIndex);
  }
}

TEST_F(Lists, ItemsAreNotLookedForAcrossTheirBorders) {
  EXPECT_FALSE(Execute({List({1, 2, 3, 4}), 2, 3}, {Op::kListRemove, 2}));
  EXPECT_EQ(machine_->fault(), Fault::kRemove);
  ASSERT_TRUE(Execute({List({1, 2, 3, 4}), 2, 3}, {Op::kListContains, 2}));
  EXPECT_THAT(machine_->result(), ElementsAre(0));
}

TEST_F(Lists, ContainTheirLastItem) {
  ASSERT_TRUE(Execute({List({1, 2, 3, 4}), 3, 4}, {Op::kListContains, 2}));
  EXPECT_THAT(machine_->result(), ElementsAre(1));
  ASSERT_TRUE(Execute({0, 3, 4}, {Op::kListContains, 2}));
  EXPECT_THAT(machine_->result(), ElementsAre(0));
}

TEST_F(Lists, HaveAtMostAMillionItems) {
  std::vector<Word> words(kLongestList);
  EXPECT_FALSE(Execute({List(words), 1}, {Op::kListAppend, 1}));
  EXPECT_EQ(machine_->fault(), Fault::kTooLong);
  words.pop_back();
  EXPECT_TRUE(Execute({List(words), 1}, {Op::kListAppend, 1}));
}

TEST_F(Lists, TextsAreConcatenatedInOrder) {
  ASSERT_TRUE(Execute({heap_.InternText("left "), heap_.InternText("right")}, {Op::kConcatenate}));
  EXPECT_EQ(heap_.Text(machine_->result()[0]), "left right");
}

TEST_F(Lists, AValueIsShownAsThePrinterSays) {
  code_.constants = {1, 5, 6};
  code_.instructions = {{Op::kConstant, 0}, {Op::kConstant, 1}, {Op::kConstant, 2}, {Op::kShow, 3, 2}, {}};
  code_.spans.resize(5);
  Machine machine(code_, layout_, heap_);
  machine.SetMemory(memory_.data());
  machine.SetShow([](size_t type, std::span<const Word> value) {
    return std::to_string(type) + ":" + std::to_string(value[0]) + std::to_string(value[1]);
  });
  ASSERT_TRUE(machine.Run(0, 0, false));
  ASSERT_EQ(machine.result().size(), 2U);
  EXPECT_EQ(heap_.Text(machine.result()[1]), "3:56");
}

TEST_F(Lists, AnyIsTheItemThatIsChosen) {
  uint64_t asked = 0;
  const auto last = [&](uint64_t possibilities) { return (asked = possibilities) - 1; };
  ASSERT_TRUE(Execute({List({1, 2, 3, 4, 5, 6})}, {Op::kAnyItem, 2}, false, last));
  EXPECT_EQ(asked, 3U);
  EXPECT_THAT(machine_->result(), ElementsAre(5, 6));
}

TEST_F(Lists, AnyWithoutAChooserIsTheFirst) {
  ASSERT_TRUE(Execute({List({7, 8})}, {Op::kAnyItem, 1}));
  EXPECT_THAT(machine_->result(), ElementsAre(7));
  ASSERT_TRUE(Execute({FromInt(-3), 4}, {Op::kAnyInt}));
  EXPECT_EQ(ToInt(machine_->result()[0]), -3);
}

TEST_F(Lists, AnyOfARangeIncludesBothEnds) {
  uint64_t asked = 0;
  const auto last = [&](uint64_t possibilities) { return (asked = possibilities) - 1; };
  ASSERT_TRUE(Execute({FromInt(-2), 3}, {Op::kAnyInt}, false, last));
  EXPECT_EQ(asked, 6U);
  EXPECT_EQ(ToInt(machine_->result()[0]), 3);
  ASSERT_TRUE(Execute({5, 5}, {Op::kAnyInt}, false, last));
  EXPECT_EQ(asked, 1U);
}

TEST_F(Lists, NothingCanBeChosenFromAnEmptySet) {
  EXPECT_FALSE(Execute({0}, {Op::kAnyItem, 1}));
  EXPECT_EQ(machine_->fault(), Fault::kNoValue);
  EXPECT_FALSE(Execute({4, 3}, {Op::kAnyInt}));
  EXPECT_EQ(machine_->fault(), Fault::kNoValue);
}

TEST_F(Lists, TheSetOfAllIntsIsTooLarge) {
  EXPECT_FALSE(
      Execute({FromInt(std::numeric_limits<int64_t>::min()), FromInt(std::numeric_limits<int64_t>::max())},
              {Op::kAnyInt}));
  EXPECT_EQ(machine_->fault(), Fault::kTooMany);
}

TEST_F(Lists, AGridOfIntsEndsAtOrBeforeItsHighEnd) {
  ASSERT_TRUE(GridInt(-2, 4, 3));
  EXPECT_THAT(Made(), ElementsAre(FromInt(-2), 1, 4));
  ASSERT_TRUE(GridInt(0, 5, 3));
  EXPECT_THAT(Made(), ElementsAre(0, 3));
  ASSERT_TRUE(GridInt(1, 0, 1));
  EXPECT_THAT(Made(), IsEmpty());
}

TEST_F(Lists, AGridOfIntsStopsAtTheLargestInt) {
  constexpr int64_t kMax = std::numeric_limits<int64_t>::max();
  ASSERT_TRUE(GridInt(kMax - 1, kMax, 1));
  EXPECT_THAT(Made(), ElementsAre(FromInt(kMax - 1), FromInt(kMax)));
}

TEST_F(Lists, AGridOfFloatsHasBothEnds) {
  ASSERT_TRUE(GridFloat(60, 61, 0.5));
  EXPECT_THAT(Doubles(), ElementsAre(60, 60.5, 61));
  ASSERT_TRUE(GridFloat(0, 0.3, 0.1));  // 3 * 0.1 is more than 0.3
  EXPECT_EQ(Doubles().size(), 4U);
  ASSERT_TRUE(GridFloat(0, 0.99, 0.5));
  EXPECT_THAT(Doubles(), ElementsAre(0, 0.5));
}

TEST_F(Lists, TheStepOfAGridIsPositive) {
  EXPECT_FALSE(GridInt(0, 3, 0));
  EXPECT_EQ(machine_->fault(), Fault::kGrid);
  EXPECT_FALSE(GridInt(0, 3, -1));
  EXPECT_FALSE(GridFloat(0, 3, 0));
  EXPECT_EQ(machine_->fault(), Fault::kGrid);
}

TEST_F(Lists, AGridHasAtMostAMillionItems) {
  EXPECT_FALSE(GridInt(1, 1'000'001, 1));
  EXPECT_EQ(machine_->fault(), Fault::kTooLong);
  EXPECT_FALSE(GridFloat(0, 1, 1e-9));
  EXPECT_EQ(machine_->fault(), Fault::kTooLong);
}

TEST_F(Lists, AGridOfPointsHasItsLastAxisFastest) {
  std::vector<Word> words;
  for (const double x : {0.0, 0.0, 5.0, 1.0, 0.0, 6.0, 1.0}) words.push_back(FromFloat(x));
  ASSERT_TRUE(Execute(words, {Op::kGridPos}));
  EXPECT_THAT(Doubles(), ElementsAre(0, 0, 5, 0, 0, 6, 1, 0, 5, 1, 0, 6));
}

}  // namespace
}  // namespace rondo::koord::semantics
