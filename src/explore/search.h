#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "base/stop.h"
#include "explore/transition_system.h"
#include "explore/visited_set.h"

namespace rondo::explore {

struct SearchOptions {
  std::optional<uint32_t> depth;  ///< transitions from an initial state
  uint64_t states = 100'000'000;  ///< give up beyond so many
  bool compact = false;           ///< hash compaction
  bool deadlocks = false;         ///< look for them
  struct Progress {
    uint64_t states;
    uint64_t frontier;
    uint32_t depth;
    double seconds;
  };
  std::function<void(const Progress&)> progress;  ///< every now and then
  base::StopToken stop;
};

enum class Ending : uint8_t {
  kComplete,  ///< every reachable state was visited
  kDepth,     ///< every state up to the depth
  kStates,    ///< too many
  kStopped,
  kBroken,
  kDeadlock,
};

struct SearchResult {
  Ending ending = Ending::kComplete;
  uint64_t states = 0;
  uint64_t transitions = 0;  ///< listed, known targets included
  uint32_t depth = 0;        ///< of the deepest state
  uint64_t initial = 0;
  double seconds = 0;
  size_t bytes = 0;
  Broken broken;
  /// From an initial state to the one that is broken or dead, or whose successors break: the words of each,
  /// by breadth first search as few as there can be.
  std::vector<std::vector<Word>> path;
};

/// Breadth first search from all initial states.
///
/// Exact unless `options.compact`. O(states) memory: the words of each state and 8 bytes more.
template <TransitionSystem S>
SearchResult Search(S& system, const SearchOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  SearchResult result;
  VisitedSet visited(system.words(), options.compact);
  constexpr uint32_t kNone = 0xffffffffu;
  std::vector<uint32_t> parent;
  std::vector<Word> frontier;  // with hash compaction: the words of the states of this level
  std::vector<Word> next;
  const size_t words = system.words();
  uint32_t current = kNone;
  bool full = false;
  bool stopped = false;  // in the middle of a state
  const Visit visit = [&](std::span<const Word> state) {
    if ((++result.transitions & 0xffff) == 0 && options.stop.StopRequested()) {
      stopped = true;
      return Seen::kStop;
    }
    bool fresh = false;
    visited.Insert(state, fresh);
    if (!fresh) return Seen::kKnown;
    parent.push_back(current);
    if (options.compact) next.insert(next.end(), state.begin(), state.end());
    full = visited.size() >= std::min<uint64_t>(options.states, VisitedSet::kMost);
    return full ? Seen::kStop : Seen::kNew;
  };
  uint32_t bad = kNone;
  const auto report = [&](const Broken& broken) {
    if (broken.property < 0) return false;
    result.broken = broken;
    result.ending = Ending::kBroken;
    bad = broken.at_visited ? static_cast<uint32_t>(visited.size() - 1) : current;
    return true;
  };
  bool done = report(system.Initial(visit));
  result.initial = visited.size();
  uint32_t level_end = static_cast<uint32_t>(visited.size());
  uint32_t at = 0;
  auto last = begin;
  uint64_t polled = 0;
  std::vector<Word> state(words);
  if (full && !done) result.ending = Ending::kStates;
  done = done || full;
  while (!done && at < level_end) {
    if (options.depth && result.depth >= *options.depth) {
      result.ending = Ending::kDepth;
      break;
    }
    frontier.swap(next);
    next.clear();
    const uint32_t level_begin = at;
    for (; at < level_end && !done; ++at) {
      current = at;
      const std::span<const Word> here =
          options.compact
              ? std::span<const Word>(frontier.data() + static_cast<size_t>(at - level_begin) * words, words)
              : visited[at];
      state.assign(here.begin(), here.end());
      if (options.deadlocks && system.Deadlocked(state)) {
        bad = at;
        result.ending = Ending::kDeadlock;
        done = true;
        break;
      }
      done = report(system.Successors(state, visit));
      if (!done && stopped) {
        result.ending = Ending::kStopped;
        done = true;
      }
      if (!done && full) {
        result.ending = Ending::kStates;
        done = true;
      }
      if ((++polled & 0xff) == 0) {
        const auto now = Clock::now();
        if (options.stop.StopRequested() && !done) {
          result.ending = Ending::kStopped;
          done = true;
        }
        if (options.progress && now - last > std::chrono::milliseconds(200)) {
          last = now;
          options.progress({visited.size(), visited.size() - at, result.depth,
                            std::chrono::duration<double>(now - begin).count()});
        }
      }
    }
    if (visited.size() > level_end) ++result.depth;
    level_end = static_cast<uint32_t>(visited.size());
  }
  result.states = visited.size();
  result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  result.bytes = visited.bytes() + parent.capacity() * sizeof(uint32_t);
  if (bad == kNone) return result;
  // The numbers of the path; their states are found again from the initial ones.
  std::vector<uint32_t> numbers;
  for (uint32_t i = bad; i != kNone; i = parent[i]) numbers.insert(numbers.begin(), i);
  for (const uint32_t number : numbers) {
    std::vector<Word> found;
    const Visit look = [&](std::span<const Word> candidate) {
      if (!visited.Is(candidate, number)) return Seen::kKnown;
      found.assign(candidate.begin(), candidate.end());
      return Seen::kStop;
    };
    if (result.path.empty())
      system.Initial(look);
    else
      system.Successors(result.path.back(), look);
    result.path.push_back(std::move(found));
  }
  return result;
}

}  // namespace rondo::explore
