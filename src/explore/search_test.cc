#include "explore/search.h"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace rondo::explore {
namespace {

KeptState Bytes(uint64_t value) {
  KeptState bytes;
  for (; value > 0; value /= 256) bytes.push_back(static_cast<uint8_t>(value % 256));
  return bytes;
}

uint64_t Value(State state) {
  uint64_t value = 0;
  for (size_t i = state.size(); i > 0; --i) value = value * 256 + state[i - 1];
  return value;
}

// Two counters below a limit; a state is one number.
struct Counters {
  uint64_t limit = 10;
  uint64_t bad = 1'000'000;     // the sum that breaks the property
  uint64_t faulty = 1'000'000;  // the sum from which nothing can be listed
  bool ends = false;            // both at the limit: nothing follows
  static Broken Initial(const Visit& visit) {
    visit({});
    return {};
  }
  Broken Successors(State state, const Visit& visit) {
    const uint64_t a = Value(state) / 1000;
    const uint64_t b = Value(state) % 1000;
    marks[0] = (a < limit ? 1 : 0) | (b % 2 == 0 ? 2 : 0);
    if (a < limit && !visit(Bytes((a + 1) * 1000 + b))) return {};
    if (a + b >= faulty) return {1, false};
    if (b < limit) visit(Bytes(a * 1000 + b + 1));
    return {};
  }
  int Check(State state) const { return Value(state) / 1000 + Value(state) % 1000 >= bad ? 0 : -1; }
  std::array<uint64_t, 1> marks{};
  std::span<const uint64_t> Marks() const { return marks; }
  bool Deadlocked(State state) const { return !ends && Value(state) == limit * 1000 + limit; }
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
    EXPECT_EQ(Value(result.path[0]), 0U);
    for (size_t i = 1; i < result.path.size(); ++i) {
      const uint64_t step = Value(result.path[i]) - Value(result.path[i - 1]);
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
  options.memory = 6'000'000;
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
    static Broken Initial(const Visit& visit) {
      visit({});
      return {};
    }
    Broken Successors(State, const Visit& visit) const {
      for (uint64_t next = 0; next < 20'000'000 && !told; ++next) {
        if (!visit(Bytes(next))) break;
      }
      return {};
    }
    static int Check(State) { return -1; }
    static std::span<const uint64_t> Marks() { return {}; }
    static bool Deadlocked(State) { return false; }
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

// What the definition says, without any batches: the states in the order in which they are met.
struct Plainly {
  std::vector<uint64_t> states{0};
  uint64_t transitions = 1;
  std::array<uint64_t, 2> marked{};
  std::vector<uint64_t> path;
};

Plainly SearchPlainly(Counters system) {
  Plainly result;
  std::map<uint64_t, uint64_t> parents{{0, 0}};
  const auto to = [&](uint64_t state) {
    for (; state != 0; state = parents[state]) result.path.insert(result.path.begin(), state);
    result.path.insert(result.path.begin(), 0);
  };
  for (size_t i = 0; i < result.states.size() && result.path.empty(); ++i) {
    const uint64_t from = result.states[i];
    const Broken broken = system.Successors(Bytes(from), [&](State state) {
      ++result.transitions;
      if (!parents.emplace(Value(state), from).second) return true;
      result.states.push_back(Value(state));
      if (system.Check(state) >= 0) to(Value(state));
      return result.path.empty();
    });
    for (size_t bit = 0; bit < 2; ++bit) result.marked[bit] += system.marks[0] >> bit & 1;
    if (result.path.empty() && broken.property >= 0) to(from);
  }
  return result;
}

TEST(Search, FindsTheSameWithAnyNumberOfThreads) {
  for (const auto& [bad, faulty] : std::vector<std::pair<uint64_t, uint64_t>>{
           {1'000'000, 1'000'000}, {450, 1'000'000}, {1'000'000, 449}, {450, 449}, {1, 0}, {451, 449}}) {
    Counters model;
    model.limit = 300;
    model.bad = bad;
    model.faulty = faulty;
    const Plainly expected = SearchPlainly(model);
    for (const size_t threads : {1, 2, 5}) {
      for (const bool compact : {false, true}) {
        std::vector<Counters> systems(threads, model);
        std::vector<Counters*> pointers;
        for (Counters& system : systems) pointers.push_back(&system);
        SearchOptions options;
        options.compact = compact;
        const SearchResult result = Search<Counters>(pointers, options);
        EXPECT_EQ(result.states, expected.states.size());
        EXPECT_EQ(result.transitions, expected.transitions);
        EXPECT_EQ(result.marked[0], expected.marked[0]);
        EXPECT_EQ(result.marked[1], expected.marked[1]);
        std::vector<uint64_t> path;
        for (const KeptState& state : result.path) path.push_back(Value(state));
        EXPECT_EQ(path, expected.path);
      }
    }
  }
}

TEST(Search, KeepsTheOrderWhereStatesHaveVeryManySuccessors) {
  // From 0 to each number below a million; from each of those to its double.
  struct Fan {
    uint64_t bad;
    static Broken Initial(const Visit& visit) {
      visit({});
      return {};
    }
    static Broken Successors(State state, const Visit& visit) {
      const uint64_t value = Value(state);
      for (uint64_t next = 1; value == 0 && next < 100'000; ++next) {
        if (!visit(Bytes(next))) return {};
      }
      if (value < 500) visit(Bytes(2'000'000 + value / 2));
      return {};
    }
    int Check(State state) const { return Value(state) == bad ? 0 : -1; }
    static std::span<const uint64_t> Marks() { return {}; }
    static bool Deadlocked(State) { return false; }
  };
  for (const size_t threads : {1, 3}) {
    std::vector<Fan> systems(threads, Fan{77'777});
    std::vector<Fan*> pointers;
    for (Fan& system : systems) pointers.push_back(&system);
    EXPECT_EQ(Search<Fan>(pointers, {}).states, 77'778U);
    EXPECT_EQ(Search<Fan>(pointers, {}).transitions, 77'778U);
    for (Fan& system : systems) system.bad = 2'000'005;
    const SearchResult result = Search<Fan>(pointers, {});
    ASSERT_EQ(result.path.size(), 3U);
    EXPECT_EQ(Value(result.path[1]), 10U);
    EXPECT_EQ(result.states, 100'000U + 6);
  }
}

TEST(StateTable, KnowsWhatItHolds) {
  for (const bool compact : {false, true}) {
    StateTable table(3, compact);
    std::map<KeptState, StateId> expected;
    for (uint64_t i = 0; i < 200'000; ++i) {
      KeptState state = Bytes(i * i % 65'537);
      state.resize(state.size() + i % 13);
      const auto id = table.Insert(state, HashOf(state), i);
      const bool fresh = expected.emplace(state, id.value_or(0)).second;
      EXPECT_EQ(fresh, id.has_value());
      if (id) {
        EXPECT_EQ(table.Parent(*id), i);
      }
    }
    EXPECT_EQ(table.size(), expected.size());
    for (const auto& [state, id] : expected) {
      EXPECT_EQ(id >> 32, 3U);
      EXPECT_TRUE(table.Is(state, id));
    }
  }
}

TEST(StateTable, HoldsHugeStates) {
  StateTable table(0, false);
  std::vector<StateId> ids;
  for (const size_t size : {10, 70'000, 0, 1'000'000, 65'000, 300}) {
    const KeptState state(size, 7);
    ids.push_back(table.Insert(state, HashOf(state), kNoState).value());
    EXPECT_FALSE(table.Insert(state, HashOf(state), kNoState));
  }
  for (uint64_t i = 0; i < 5000; ++i) table.Insert(Bytes(i + 1), HashOf(Bytes(i + 1)), i);
  EXPECT_TRUE(table.Is(KeptState(1'000'000, 7), ids[3]));
  EXPECT_FALSE(table.Insert(KeptState(1'000'000, 7), HashOf(KeptState(1'000'000, 7)), 1));
  EXPECT_EQ(table.Parent(ids[1]), kNoState);
}

TEST(StateTable, ForeseesItsMemory) {
  StateTable table(0, false);
  uint64_t next = 1;
  for (int round = 0; round < 200; ++round) {
    size_t bytes = 0;
    const size_t count = 1 + static_cast<size_t>(round) * 7;
    for (uint64_t i = next; i < next + count; ++i) bytes += Bytes(i).size();
    const size_t foreseen = table.BytesAfter(count, bytes);
    for (const uint64_t end = next + count; next < end; ++next)
      table.Insert(Bytes(next), HashOf(Bytes(next)), 0);
    EXPECT_LE(table.bytes(), foreseen);
  }
}

}  // namespace
}  // namespace rondo::explore
