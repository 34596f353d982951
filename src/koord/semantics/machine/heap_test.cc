#include "koord/semantics/machine/heap.h"

#include <gtest/gtest.h>

#include "koord/semantics/machine/layout.h"

namespace rondo::koord::semantics {
namespace {

Word Intern(Heap& heap, std::vector<Word> words) { return heap.Intern(words); }

TEST(Heap, EqualSequencesHaveEqualHandles) {
  Heap heap;
  const Word a = Intern(heap, {1, 2, 3});
  EXPECT_EQ(Intern(heap, {1, 2, 3}), a);
  EXPECT_NE(Intern(heap, {1, 2}), a);
  EXPECT_NE(Intern(heap, {3, 2, 1}), a);
}

TEST(Heap, TheEmptySequenceIsZero) {
  Heap heap;
  EXPECT_EQ(Intern(heap, {}), 0U);
  EXPECT_TRUE(heap[0].empty());
}

TEST(Heap, KeepsItsEntriesWhenItGrows) {
  Heap heap;
  std::vector<Word> handles;
  for (Word i = 0; i < 5000; ++i) handles.push_back(Intern(heap, {i, i + 1}));
  for (Word i = 0; i < 5000; ++i) {
    ASSERT_EQ(heap[handles[i]][1], i + 1);
    ASSERT_EQ(Intern(heap, {i, i + 1}), handles[i]);
  }
}

TEST(Heap, TextsKeepEveryByte) {
  Heap heap;
  for (const std::string& text : {std::string(), std::string("eight by"), std::string("nine byte"),
                                  std::string("a\0b\0", 4), std::string("a\0b", 3)})
    EXPECT_EQ(heap.Text(heap.InternText(text)), text);
  EXPECT_NE(heap.InternText(std::string("a\0", 2)), heap.InternText("a"));
}

TEST(Heap, SweepFreesWhatIsNotMarked) {
  Heap heap;
  const Word kept = Intern(heap, {1});
  const size_t needed = heap.words_in_use();
  Intern(heap, {2, 3});
  EXPECT_GT(heap.words_in_use(), needed);
  heap.Mark(kept);
  heap.Sweep();
  EXPECT_EQ(heap.words_in_use(), needed);
  EXPECT_EQ(Intern(heap, {1}), kept);
  EXPECT_EQ(heap[kept][0], 1U);
}

TEST(Heap, AMarkLastsForOneSweep) {
  Heap heap;
  const size_t empty = heap.words_in_use();
  heap.Mark(Intern(heap, {1}));
  heap.Sweep();
  heap.Sweep();
  EXPECT_EQ(heap.words_in_use(), empty);
}

TEST(Heap, PinnedEntriesAreNeverFreed) {
  Heap heap;
  const Word pinned = Intern(heap, {4, 5});
  heap.Pin();
  heap.Sweep();
  EXPECT_EQ(heap[pinned][1], 5U);
  EXPECT_EQ(Intern(heap, {4, 5}), pinned);
}

TEST(Heap, FreedHandlesAreUsedAgain) {
  Heap heap;
  const Word freed = Intern(heap, {1});
  heap.Sweep();
  EXPECT_EQ(Intern(heap, {2}), freed);
  EXPECT_NE(Intern(heap, {1}), freed);
}

Model Declare(const std::vector<std::pair<VariableKind, TypeId>>& variables, Model model) {
  for (const auto& [kind, type] : variables) model.variables.push_back({kind, "v", "", type, {}, {}, -1});
  return model;
}

TEST(Layout, SharedVariablesComeBeforeTheBlocks) {
  Model model;
  const auto& t = model.types;
  model = Declare({{VariableKind::kLocal, t.boolean()},
                   {VariableKind::kAllwrite, t.pos()},
                   {VariableKind::kAllread, t.integer()},
                   {VariableKind::kParam, t.pos()}},
                  model);
  const Layout layout(model, 3, {});
  EXPECT_EQ(layout.shared_words(), 3U);
  EXPECT_EQ(layout.block_words(), 3U);  // with the mark of stopped robots
  EXPECT_EQ(layout.words(), 3U + 3 * 3);
  EXPECT_EQ(layout.param_words(), 3U);
  EXPECT_EQ(layout.Address(1, 2), 0U);
  EXPECT_EQ(layout.Address(2, 2), 3U + 2 * 3 + 1);
}

TEST(Layout, NoTwoVariablesShareAWord) {
  Model model;
  const TypeId matrix = model.types.Array(model.types.Array(model.types.pos(), "2"), "3");
  const TypeId flags = model.types.Array(model.types.boolean(), "2");
  model = Declare({{VariableKind::kLocal, matrix},
                   {VariableKind::kLocal, model.types.integer()},
                   {VariableKind::kAllwrite, flags},
                   {VariableKind::kAllwrite, model.types.real()}},
                  model);
  const Layout layout(model, 2, {{"2", 2}, {"3", 3}});
  EXPECT_EQ(layout[0].words(), 18U);
  std::vector<int> used(layout.words());
  for (size_t v = 0; v < model.variables.size(); ++v) {
    for (size_t r = 0; r < (layout[v].own ? 2U : 1U); ++r) {
      for (uint32_t k = 0; k < layout[v].words(); ++k) ++used[layout.Address(v, r) + k];
    }
  }
  for (size_t r = 0; r < 2; ++r) ++used[layout.block(r) + layout.stopped()];
  EXPECT_EQ(used, std::vector<int>(layout.words(), 1));
}

TEST(Layout, WhatHasNoValueHasNoPlace) {
  Model model;
  model = Declare({{VariableKind::kLocal, model.types.stream()}, {VariableKind::kSensor, model.types.pos()}},
                  model);
  model.variables[1].function = 0;  // is called
  const Layout layout(model, 1, {});
  EXPECT_FALSE(layout[0].exists);
  EXPECT_FALSE(layout[1].exists);
  EXPECT_EQ(layout.block_words(), 1U);
}

TEST(Layout, EveryWordHasAKind) {
  Model model;
  const TypeId record =
      model.types.Record("Task", {"id", "done"}, {model.types.integer(), model.types.boolean()});
  const TypeId list = model.types.List(record);
  model = Declare({{VariableKind::kLocal, record}, {VariableKind::kLocal, list}}, model);
  const Layout layout(model, 1, {});
  std::vector<WordKind> kinds;
  for (const Layout::Slot& slot : layout.block_slots()) kinds.push_back(slot.kind);
  EXPECT_EQ(kinds,
            (std::vector<WordKind>{WordKind::kInt, WordKind::kBool, WordKind::kHandle, WordKind::kBool}));
  EXPECT_EQ(layout.block_slots()[2].type, list);
}

}  // namespace
}  // namespace rondo::koord::semantics
