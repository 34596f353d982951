#include "explore/search.h"

#include <gtest/gtest.h>

#include <set>

namespace rondo::explore {
namespace {

// Two counters below a limit; a state is one word.
struct Counters {
  Word limit = 10;
  Word bad = 1'000'000;  // the sum that breaks the property
  bool ends = false;     // both at the limit: nothing follows
  static size_t words() { return 1; }
  Broken Visited(Word state, const Visit& visit, bool& stop) const {
    const Seen seen = visit({&state, 1});
    stop = seen == Seen::kStop;
    if (seen == Seen::kNew && state / 1000 + state % 1000 >= bad) return {0, true};
    return {};
  }
  Broken Initial(const Visit& visit) const {
    bool stop = false;
    return Visited(0, visit, stop);
  }
  Broken Successors(std::span<const Word> state, const Visit& visit) const {
    const Word a = state[0] / 1000;
    const Word b = state[0] % 1000;
    bool stop = false;
    if (a < limit) {
      const Broken broken = Visited((a + 1) * 1000 + b, visit, stop);
      if (broken.property >= 0 || stop) return broken;
    }
    if (b < limit) return Visited(a * 1000 + b + 1, visit, stop);
    return {};
  }
  bool Deadlocked(std::span<const Word> state) const { return !ends && state[0] == limit * 1000 + limit; }
};

TEST(Search, VisitsEveryStateOnce) {
  for (const bool compact : {false, true}) {
    Counters system;
    SearchOptions options;
    options.compact = compact;
    const SearchResult result = Search(system, options);
    EXPECT_EQ(result.ending, Ending::kComplete);
    EXPECT_EQ(result.states, 121U);
    EXPECT_EQ(result.depth, 20U);
    EXPECT_EQ(result.transitions, 1U + 2 * 110);
  }
}

TEST(Search, FindsAShortestPath) {
  for (const bool compact : {false, true}) {
    Counters system;
    system.bad = 7;
    SearchOptions options;
    options.compact = compact;
    const SearchResult result = Search(system, options);
    EXPECT_EQ(result.ending, Ending::kBroken);
    ASSERT_EQ(result.path.size(), 8U);
    EXPECT_EQ(result.path[0][0], 0U);
    for (size_t i = 1; i < result.path.size(); ++i) {
      const Word step = result.path[i][0] - result.path[i - 1][0];
      EXPECT_TRUE(step == 1 || step == 1000);
    }
  }
}

TEST(Search, KeepsItsBoundsAndSaysSo) {
  Counters system;
  SearchOptions options;
  options.depth = 3;
  EXPECT_EQ(Search(system, options).ending, Ending::kDepth);
  EXPECT_EQ(Search(system, options).states, 10U);
  options.depth = 20;  // everything lies within it, but that is only known after one more level
  EXPECT_EQ(Search(system, options).states, 121U);
  options = {};
  options.states = 50;
  EXPECT_EQ(Search(system, options).ending, Ending::kStates);
  EXPECT_EQ(Search(system, options).states, 50U);
  options = {};
  options.stop.RequestStop();
  system.limit = 200;
  EXPECT_EQ(Search(system, options).ending, Ending::kStopped);
}

TEST(Search, EndsBeforeItTakesTooMuchMemory) {
  Counters system;
  system.limit = 900;
  SearchOptions options;
  options.memory = 1'000'000;
  const SearchResult result = Search(system, options);
  EXPECT_EQ(result.ending, Ending::kMemory);
  EXPECT_GT(result.states, 10'000U);
  EXPECT_LE(result.bytes, options.memory);
  options.compact = true;
  EXPECT_LE(Search(system, options).bytes, options.memory);
}

TEST(Search, TellsHowFarItIsInTheMiddleOfAState) {
  // The first state has very many successors.
  struct Wide {
    static size_t words() { return 1; }
    Broken Initial(const Visit& visit) const {
      const Word zero = 0;
      visit({&zero, 1});
      return {};
    }
    Broken Successors(std::span<const Word>, const Visit& visit) const {
      for (Word next = 0; next < 20'000'000 && !told; ++next) visit({&next, 1});
      return {};
    }
    static bool Deadlocked(std::span<const Word>) { return false; }
    bool told = false;
  } system;
  SearchOptions options;
  options.depth = 1;
  options.progress = [&](const SearchOptions::Progress& p) { system.told = p.depth == 0; };
  Search(system, options);
  EXPECT_TRUE(system.told);
}

TEST(Search, FindsDeadlocksWhenAsked) {
  Counters system;
  SearchOptions options;
  options.deadlocks = true;
  const SearchResult result = Search(system, options);
  EXPECT_EQ(result.ending, Ending::kDeadlock);
  EXPECT_EQ(result.path.size(), 21U);
  system.ends = true;
  EXPECT_EQ(Search(system, options).ending, Ending::kComplete);
}

TEST(VisitedSet, NumbersStatesInOrder) {
  VisitedSet set(2, false);
  std::set<std::pair<Word, Word>> expected;
  for (Word i = 0; i < 50'000; ++i) {
    const Word state[2] = {i * i % 1009, i % 13};
    bool fresh = false;
    const uint32_t number = set.Insert(state, fresh);
    EXPECT_EQ(fresh, expected.insert({state[0], state[1]}).second);
    EXPECT_EQ(set[number][0], state[0]);
    EXPECT_TRUE(set.Is(state, number));
  }
  EXPECT_EQ(set.size(), expected.size());
}

}  // namespace
}  // namespace rondo::explore
