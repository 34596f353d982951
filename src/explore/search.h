#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "base/stop.h"
#include "explore/transition_system.h"
#include "explore/visited_set.h"

/// Breadth first search over any transition system, for explorations of Koord programs.
namespace rondo::explore {

/// Says how far to search, and what for.
struct SearchOptions {
  std::optional<uint32_t> depth;  ///< at most so many transitions from an initial state; none: no limit
  uint64_t states = 100'000'000;  ///< the search gives up once it has visited so many
  size_t memory = SIZE_MAX;       ///< ... or before it takes more than so many bytes
  std::function<size_t()> beside =
      {};  ///< returns how many bytes the system takes itself, asked now and then
  /// Hash compaction: a hash for each state instead of its words; a state may be missed.
  bool compact = false;
  bool deadlocks = false;  ///< whether a state that `Deadlocked` accepts ends the search
  /// Tells how far a search is.
  struct Progress {
    uint64_t states;
    uint64_t frontier;  ///< states that were visited, and whose successors were not listed yet
    uint32_t depth;
    double seconds;  ///< since the search began
  };
  std::function<void(const Progress&)>
      progress;  ///< called now and then, at most every 200 ms, also in the middle of a state
  base::StopToken stop;
};

/// Says why a search ended.
enum class Ending : uint8_t {
  kComplete,  ///< every reachable state was visited, and nothing is wrong
  kDepth,     ///< every state up to the depth was visited, and nothing is wrong
  kStates,    ///< the limit of states was reached
  kMemory,    ///< the limit of memory was reached
  kStopped,   ///< the stop token asked for it
  kBroken,    ///< a property is broken; `path` leads there
  kDeadlock,  ///< a state is dead; `path` leads there
};

/// Tells what a search found, and what it took.
struct SearchResult {
  Ending ending = Ending::kComplete;
  uint64_t states = 0;       ///< that were visited, each once
  uint64_t transitions = 0;  ///< that were listed, those to known states included
  uint32_t depth = 0;        ///< of the deepest state, in transitions
  uint64_t initial = 0;      ///< initial states, each once
  double seconds = 0;
  size_t bytes = 0;  ///< of states, table and predecessors, as allocated
  Broken broken;     ///< which property, if the ending is kBroken
  /// The words of each state from an initial one to the state that is broken or dead, or whose successors
  /// break something. As few states as there can be, since the search is breadth first.
  std::vector<std::vector<Word>> path;
};

/// Runs one breadth first search; an object serves one call of `Run`. See `Search`.
template <TransitionSystem S>
class Searcher {
 public:
  Searcher(S& system, const SearchOptions& options)
      : system_(system), options_(options), visited_(system.words(), options.compact) {}

  SearchResult Run() {
    Begin();
    while (!done_ && at_ < level_end_) {
      if (options_.depth && result_.depth >= *options_.depth) {
        End(Ending::kDepth);
        break;
      }
      Level();
    }
    result_.states = visited_.size();
    result_.seconds = Seconds();
    result_.bytes = visited_.bytes() + OtherBytes();
    if (bad_ != kNone) FindPath();
    return std::move(result_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr uint32_t kNone = 0xffffffffu;

  double Seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  void End(Ending ending) {
    result_.ending = ending;
    done_ = true;
  }

  Seen Meet(std::span<const Word> state) {
    if ((++result_.transitions & 0xfff) == 0) {
      Tell();
      if (options_.stop.StopRequested()) {
        stopped_ = true;
        return Seen::kStop;
      }
    }
    if (options_.beside && (result_.transitions & 0xff) == 0) beside_ = options_.beside();
    if (visited_.bytes_next() + OtherBytes() > options_.memory) {
      large_ = true;
      return Seen::kStop;
    }
    bool fresh = false;
    visited_.Insert(state, fresh);
    if (!fresh) return Seen::kKnown;
    parent_.push_back(current_);
    if (options_.compact) next_.insert(next_.end(), state.begin(), state.end());
    full_ = visited_.size() >= std::min<uint64_t>(options_.states, VisitedSet::kMost);
    return full_ ? Seen::kStop : Seen::kNew;
  }

  // What became of the states that were met just now.
  void Judge(const Broken& broken) {
    if (broken.property >= 0) {
      result_.broken = broken;
      bad_ = broken.at_visited ? static_cast<uint32_t>(visited_.size() - 1) : current_;
      End(Ending::kBroken);
    } else if (stopped_) {
      End(Ending::kStopped);
    } else if (large_) {
      End(Ending::kMemory);
    } else if (full_) {
      End(Ending::kStates);
    }
  }

  void Begin() {
    Judge(system_.Initial(visit_));
    result_.initial = visited_.size();
    level_end_ = static_cast<uint32_t>(visited_.size());
  }

  // All states of one depth.
  void Level() {
    frontier_.swap(next_);
    next_.clear();
    for (const uint32_t first = at_; at_ < level_end_ && !done_; ++at_) {
      current_ = at_;
      const size_t words = state_.size();
      const std::span<const Word> here =
          options_.compact ? std::span<const Word>(frontier_).subspan((at_ - first) * words, words)
                           : visited_[at_];
      state_.assign(here.begin(), here.end());
      if (options_.deadlocks && system_.Deadlocked(state_)) {
        bad_ = at_;
        End(Ending::kDeadlock);
        break;
      }
      Judge(system_.Successors(state_, visit_));
      if ((++polled_ & 0xff) != 0) continue;
      Tell();
      if (options_.stop.StopRequested() && !done_) End(Ending::kStopped);
    }
    if (visited_.size() > level_end_) ++result_.depth;
    level_end_ = static_cast<uint32_t>(visited_.size());
  }

  void Tell() {
    if (!options_.progress) return;
    const auto now = Clock::now();
    if (now - last_ <= std::chrono::milliseconds(200)) return;
    last_ = now;
    options_.progress({visited_.size(), visited_.size() - at_, result_.depth, Seconds()});
  }

  size_t OtherBytes() const {
    return beside_ + parent_.size() * sizeof(uint32_t) +
           (frontier_.capacity() + next_.capacity()) * sizeof(Word);
  }

  // The numbers of the path are known; its states are found again from the initial ones.
  void FindPath() {
    std::vector<uint32_t> numbers;
    for (uint32_t i = bad_; i != kNone; i = parent_[i]) numbers.insert(numbers.begin(), i);
    for (const uint32_t number : numbers) {
      std::vector<Word> found;
      const Visit look = [&](std::span<const Word> candidate) {
        if (!visited_.Is(candidate, number)) return Seen::kKnown;
        found.assign(candidate.begin(), candidate.end());
        return Seen::kStop;
      };
      if (result_.path.empty()) {
        system_.Initial(look);
      } else {
        system_.Successors(result_.path.back(), look);
      }
      result_.path.push_back(std::move(found));
    }
  }

  S& system_;
  const SearchOptions& options_;
  SearchResult result_;
  VisitedSet visited_;
  std::deque<uint32_t> parent_;  // by number of a state
  std::vector<Word> frontier_;   // with hash compaction: the words of the states of this level
  std::vector<Word> next_;
  std::vector<Word> state_ = std::vector<Word>(system_.words());
  const Visit visit_ = [this](std::span<const Word> state) { return Meet(state); };
  uint32_t current_ = kNone;  // whose successors are met
  uint32_t at_ = 0;
  uint32_t level_end_ = 0;
  uint32_t bad_ = kNone;
  uint64_t polled_ = 0;
  size_t beside_ = 0;
  bool full_ = false;
  bool large_ = false;
  bool stopped_ = false;  // in the middle of a state
  bool done_ = false;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

/// Searches breadth first from all initial states, by one thread.
///
/// Exact unless `options.compact`: then a state whose hash was seen before is taken for visited. Memory is
/// O(states): the words of each state (or its hash) and 10 to 15 bytes more.
template <TransitionSystem S>
SearchResult Search(S& system, const SearchOptions& options) {
  return Searcher<S>(system, options).Run();
}

}  // namespace rondo::explore
