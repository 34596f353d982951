#include "koord/node/values.h"

#include <gtest/gtest.h>

#include <random>

#include "koord/node/compiled_test.h"

namespace rondo::koord::node {
namespace {

using runtime::codec::Bytes;
using runtime::codec::Reader;
using runtime::codec::Writer;

// Robots whose heaps have other handles for the same values.
class ChangesTest : public testing::Test {
 protected:
  ChangesTest() {
    teams_[1]->heap().Intern(std::vector<Word>{7, 7, 7});
    for (size_t v = 0; v < model().variables.size(); ++v) types_.push_back(teams_[0]->layout()[v].item);
  }
  const Model& model() const { return teams_[0]->model(); }

  // A value of the type in a heap: the same for the same numbers.
  Word List(size_t variable, Heap& heap, const std::vector<int>& items) const {
    std::vector<Word> words;
    for (const int i : items) {
      if (variable == 2) {
        const std::vector<Word> inner(static_cast<size_t>(i % 3), static_cast<Word>(i));
        words.push_back(heap.Intern(inner));
        continue;
      }
      words.push_back(static_cast<Word>(i));
      if (variable == 1) words.push_back(heap.InternText(std::string(static_cast<size_t>(i), 'a')));
    }
    return heap.Intern(words);
  }
  Bytes Change(size_t variable, const std::vector<int>& before, const std::vector<int>& after) {
    Heap& heap = teams_[0]->heap();
    const Word old = List(variable, heap, before), fresh = List(variable, heap, after);
    Bytes bytes;
    Writer writer(bytes);
    EncodeChange(model().types, heap, types_[variable], std::span(&old, 1), std::span(&fresh, 1), writer);
    return bytes;
  }
  bool Reads(size_t variable, const std::vector<int>& before, const Bytes& bytes, Word& value) {
    Heap& heap = teams_[1]->heap();
    const Word old = List(variable, heap, before);
    Reader reader(bytes);
    std::vector<Word> words;
    DecodeChange(model().types, heap, types_[variable], std::span(&old, 1), reader, words);
    if (reader.ok()) value = words.at(0);
    return reader.Complete();
  }

  Compiled program_{
      "def adt Order:\n    int id\n    string name\nlocal:\n    List<int> numbers\n    List<Order> orders\n    List<List<int>> "
      "lists\nGo:\n    eff:\n        numbers = numbers\n"};
  std::unique_ptr<semantics::Team> teams_[2] = {program_.Team(1), program_.Team(1)};
  std::vector<TypeId> types_;
};

TEST_F(ChangesTest, ComeOutAsTheyWereInAnotherHeapAndInOneFormOnly) {
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    const size_t variable = random() % 3;
    std::vector<int> before, after;
    for (size_t k = random() % 6; k > 0; --k) before.push_back(static_cast<int>(random() % 3));
    after = before;
    for (size_t k = random() % 3; k > 0; --k) {
      const auto at = after.begin() + static_cast<ptrdiff_t>(random() % (after.size() + 1));
      if (random() % 2 == 0 || at == after.end())
        after.insert(at, static_cast<int>(random() % 3));
      else
        after.erase(at);
    }
    const Bytes bytes = Change(variable, before, after);
    Word value = 0;
    ASSERT_TRUE(Reads(variable, before, bytes, value));
    EXPECT_EQ(value, List(variable, teams_[1]->heap(), after));
    // Other bytes are another value, or none.
    Bytes other = bytes;
    other[random() % other.size()] ^= static_cast<uint8_t>(1 + random() % 255);
    const bool is_one = Reads(variable, before, other, value);
    EXPECT_FALSE(is_one && value == List(variable, teams_[1]->heap(), after));
  }
}

TEST_F(ChangesTest, WhatIsAppendedToALongListIsShort) {
  std::vector<int> before(1000, 5), after = before;
  after.push_back(6);
  EXPECT_LT(Change(0, before, after).size(), 8U);
  after = before;
  after.erase(after.begin());
  EXPECT_LT(Change(0, before, after).size(), 8U);
}

TEST_F(ChangesTest, ThatKeepMoreThanThereIsAreRefused) {
  const auto read = [&](std::initializer_list<uint64_t> numbers) {
    Bytes bytes;
    for (const uint64_t n : numbers) Writer(bytes).Number(n);
    Word value = 0;
    return Reads(0, {1, 2, 3}, bytes, value);
  };
  EXPECT_TRUE(read({3, 0, 0}));
  EXPECT_FALSE(read({2, 1, 0}));  // the same in another form
  EXPECT_FALSE(read({4, 0, 0}));
  EXPECT_FALSE(read({2, 2, 0}));
  EXPECT_FALSE(read({UINT64_MAX, 2, 0}));
  EXPECT_FALSE(read({0, 0, 1'000'001}));
  EXPECT_FALSE(read({3, 0, 2, 1}));
}

}  // namespace
}  // namespace rondo::koord::node
