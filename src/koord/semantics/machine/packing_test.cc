#include "koord/semantics/machine/packing.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace rondo::koord::semantics {
namespace {

// Shared: a bool, an int, a float, a member of an enumeration, a list; each of two robots: an int, a bool.
class Packed : public testing::Test {
 protected:
  Packed() {
    auto& types = model_.types;
    const TypeId colour = types.Enum("Colour", {"red", "green", "blue"});
    for (const TypeId t : {types.boolean(), types.integer(), types.real(), colour, types.List(colour)})
      model_.variables.push_back({VariableKind::kAllwrite, "v", "", t, {}, {}, -1});
    for (const TypeId t : {types.integer(), types.boolean()})
      model_.variables.push_back({VariableKind::kLocal, "v", "", t, {}, {}, -1});
    layout_ = std::make_unique<Layout>(model_, 2, Lengths{});
    packing_ = std::make_unique<Packing>(*layout_, 2);
  }
  std::vector<uint8_t> Pack(const std::vector<Word>& state, Word flags) {
    const auto packed = packing_->Pack(state, flags);
    return {packed.begin(), packed.end()};
  }
  void ExpectRoundTrip(const std::vector<Word>& state, Word flags) {
    const std::vector<uint8_t> packed = Pack(state, flags);
    EXPECT_EQ(packing_->Flags(packed), flags);
    std::vector<Word> again(state.size(), 77);
    Word kept = 77;
    packing_->Unpack(packed, again, kept);
    EXPECT_EQ(again, state);
    EXPECT_EQ(kept, flags);
  }
  std::vector<Word> Zero() const { return std::vector<Word>(layout_->words()); }

  Model model_;
  std::unique_ptr<Layout> layout_;
  std::unique_ptr<Packing> packing_;
};

TEST_F(Packed, IsSmallerThanTheState) { EXPECT_LE(Pack(Zero(), 0).size(), layout_->words()); }

TEST_F(Packed, ZeroComesBack) {
  for (Word flags = 0; flags < 4; ++flags) ExpectRoundTrip(Zero(), flags);
}

TEST_F(Packed, EveryIntComesBack) {
  constexpr int64_t kEdge = int64_t{1} << 30;
  for (const int64_t x :
       {int64_t{-1}, kEdge - 1, kEdge, -kEdge, -kEdge - 1, int64_t{1} << 31, int64_t{1} << 32,
        std::numeric_limits<int64_t>::max(), std::numeric_limits<int64_t>::min()}) {
    std::vector<Word> state = Zero();
    state[1] = FromInt(x);
    ExpectRoundTrip(state, 1);
  }
}

TEST_F(Packed, EveryFloatComesBack) {
  for (const double x : {1.0, -0.1, 1e-308, 5e-324, std::numeric_limits<double>::max()}) {
    std::vector<Word> state = Zero();
    state[2] = FromFloat(x);
    ExpectRoundTrip(state, 0);
  }
}

TEST_F(Packed, FieldsDoNotDisturbEachOther) {
  std::vector<Word> full{1, FromInt(-1), FromFloat(2.5), 2, 0xffffffff};
  for (size_t r = 0; r < 2; ++r) {
    full.push_back(FromInt(std::numeric_limits<int64_t>::min() + static_cast<int64_t>(r)));
    full.push_back(1);
    full.push_back(1);
  }
  ExpectRoundTrip(full, 3);
  for (size_t i = 0; i < full.size(); ++i) {
    std::vector<Word> state = Zero();
    state[i] = full[i];
    ExpectRoundTrip(state, 0);
  }
}

TEST_F(Packed, DifferentStatesDiffer) {
  std::mt19937_64 random(5);
  std::set<std::vector<Word>> states;
  std::set<std::vector<uint8_t>> packed;
  const int64_t ints[] = {0, 1, -1, int64_t{1} << 30, int64_t{1} << 31, int64_t{1} << 40};
  const double floats[] = {0, 1, -1, 0.5};
  for (int k = 0; k < 3000; ++k) {
    std::vector<Word> state = Zero();
    state[0] = random() % 2;
    state[1] = FromInt(ints[random() % 6]);
    state[2] = FromFloat(floats[random() % 4]);
    state[3] = random() % 3;
    state[4] = random() % 3;
    state[5] = FromInt(ints[random() % 6]);
    state[layout_->block(1) + 1] = random() % 2;
    states.insert(state);
    packed.insert(Pack(state, 0));
  }
  EXPECT_EQ(packed.size(), states.size());
}

TEST_F(Packed, TheFlagsAreAPartOfIt) { EXPECT_NE(Pack(Zero(), 0), Pack(Zero(), 1)); }

TEST_F(Packed, EqualStatesAreEqualAgain) {
  std::vector<Word> state = Zero();
  state[2] = FromFloat(3.5);
  const std::vector<uint8_t> first = Pack(state, 0);
  state[2] = FromFloat(4.5);
  Pack(state, 0);
  state[2] = FromFloat(3.5);
  EXPECT_EQ(Pack(state, 0), first);
}

TEST_F(Packed, ListsAreEqualAcrossHeaps) {
  auto& types = model_.types;
  const TypeId inner = types.List(types.integer());
  const TypeId outer = types.List(types.Tuple({inner, types.string()}));
  Model model = model_;
  model.variables = {{VariableKind::kAllwrite, "v", "", outer, {}, {}, -1},
                     {VariableKind::kAllwrite, "w", "", inner, {}, {}, -1}};
  const Layout layout(model, 1, Lengths{});
  SharedValues shared;
  Heap heaps[2];
  heaps[1].InternText("other numbers from the start");
  std::vector<std::vector<uint8_t>> packed;
  for (int order = 0; order < 2; ++order) {
    Heap& heap = heaps[order];
    HandleExchange exchange(model.types, heap, shared);
    Packing packing(layout, 1, &exchange);
    if (order == 1) heap.Intern(std::vector<Word>{7, 7});
    const Word one = heap.Intern(std::vector<Word>{1, 2, 3});
    const Word text = heap.InternText("hello");
    const Word list = heap.Intern(std::vector<Word>{one, text, 0, text});
    const std::vector<Word> state{list, heap.Intern(std::vector<Word>{one, text}), 0};
    const auto bytes = packing.Pack(state, 0);
    packed.emplace_back(bytes.begin(), bytes.end());
    std::vector<Word> again(3, 99);
    Word flags = 9;
    packing.Unpack(packed.back(), again, flags);
    EXPECT_EQ(again, state);
    // What the other heap has written.
    packing.Unpack(packed.front(), again, flags);
    const auto items = heap[again[0]];
    ASSERT_EQ(items.size(), 4U);
    EXPECT_EQ(std::vector<Word>(heap[items[0]].begin(), heap[items[0]].end()), (std::vector<Word>{1, 2, 3}));
    EXPECT_EQ(heap.Text(items[3]), "hello");
  }
  EXPECT_NE(packed[0], packed[1]);  // of `w`, whose ints are handles of the one heap only by chance
}

}  // namespace
}  // namespace rondo::koord::semantics
