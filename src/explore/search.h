#pragma once

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/crew.h"
#include "base/stop.h"
#include "explore/candidates.h"
#include "explore/frontier.h"
#include "explore/state_table.h"
#include "explore/transition_system.h"
#include "explore/visited.h"

/// Breadth first search over any transition system, for explorations of Koord programs.
namespace rondo::explore {

/// Says how far to search, and what for.
struct SearchOptions {
  std::optional<uint32_t> depth;  ///< at most so many transitions from an initial state; none: no limit
  uint64_t states = 100'000'000;  ///< the search gives up once it has visited so many
  size_t memory = SIZE_MAX;       ///< ... or before it takes more than so many bytes
  std::function<size_t()> beside =
      {};  ///< returns how many bytes the systems take themselves, asked now and then
  /// Hash compaction: a hash for each state instead of its bytes; a state may be missed.
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
  size_t bytes = 0;              ///< of states, index, predecessors and lists, as allocated
  Broken broken;                 ///< which property, if the ending is kBroken
  std::vector<uint64_t> marked;  ///< by bit of `Marks`: of how many states whose successors were listed
  /// The states from an initial one to the state that is broken or dead, or whose successors break something.
  /// As few as there can be, since the search is breadth first.
  std::vector<KeptState> path;
};

/// Runs one breadth first search; an object serves one call of `Run`. See `Search`.
template <TransitionSystem S>
class Searcher {
 public:
  Searcher(std::span<S* const> systems, const SearchOptions& options)
      : systems_(systems),
        options_(options),
        crew_(static_cast<unsigned>(systems.size())),
        visited_(options.compact),
        width_(systems[0]->Marks().size()) {
    result_.marked.resize(64 * width_);
  }

  SearchResult Run() {
    List([&](const explore::Visit& visit) { return systems_[0]->Initial(visit); }, kNoState);
    result_.initial = result_.states;
    std::swap(frontier_, next_);
    while (!done_ && frontier_.size() > 0) {
      if (options_.depth && result_.depth >= *options_.depth) {
        End(Ending::kDepth);
        break;
      }
      Level();
    }
    result_.seconds = Seconds();
    result_.bytes = visited_.bytes() + OtherBytes();
    if (result_.ending == Ending::kBroken || result_.ending == Ending::kDeadlock) FindPath();
    return std::move(result_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  // Why the states behind some point of a list do not count.
  enum class Cut : uint8_t { kNone, kBroken, kDead, kStopped, kMany };
  struct Listed {
    Cut cut = Cut::kNone;
    uint32_t source = 0;  // the number of the state in the batch at which the list ends
    Broken broken;
  };

  static constexpr size_t kBatch = 4096;            // states, at most
  static constexpr uint64_t kBatchListed = 16'384;  // successors of a batch, as far as can be foreseen
  static constexpr uint32_t kListed = 16'384;       // successors in one list
  static constexpr size_t kTask = 64;               // states of a batch that one thread takes at a time
  static constexpr uint32_t kPolled = 1024;         // successors between two looks at the clock
  static constexpr size_t kBetween = 8;             // and states

  double Seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  void End(Ending ending) {
    result_.ending = ending;
    done_ = true;
  }

  void Level() {
    next_.Clear();
    for (at_ = 0; at_ < frontier_.size() && !done_;) {
      // So many that their successors fill the caches, and no more. Where batches end does not matter to what is found.
      const uint64_t listed = std::max<uint64_t>(1, result_.transitions);
      const auto size = std::clamp<uint64_t>(kBatchListed * (expanded_ + 1) / listed, 1, kBatch);
      Batch(std::min<size_t>(size, frontier_.size() - at_));
    }
    if (next_.size() > 0) ++result_.depth;
    std::swap(frontier_, next_);
  }

  // The successors of the next states: listed by all threads, and then visited in order.
  void Batch(size_t size) {
    const size_t task = std::clamp<size_t>(size / (4 * crew_.size()), 1, kTask);
    const size_t tasks = (size + task - 1) / task;
    if (lists_.size() < tasks) lists_.resize(tasks);
    listed_.assign(tasks, {});
    marks_.assign(size * width_, 0);
    crew_.Run(tasks, [&](size_t member, size_t t) {
      listed_[t] = Expand(member, t * task, std::min(size, (t + 1) * task), lists_[t]);
    });
    size_t used = 0;
    while (used + 1 < tasks && listed_[used].cut == Cut::kNone) ++used;
    const Listed& last = listed_[used];
    parents_.clear();
    for (size_t i = 0; i < size; ++i) parents_.push_back(frontier_.id(at_ + i));
    Settle(std::span(lists_).first(used + 1), last);
    const size_t ended = last.cut == Cut::kMany ? last.source : size;
    at_ += ended;
    expanded_ += ended;
    if (last.cut != Cut::kMany || done_ || ended > 0) return;
    // One state alone has too many: they are visited as they are listed.
    state_.assign(frontier_[at_].begin(), frontier_[at_].end());
    const StateId id = frontier_.id(at_);
    List([&](const explore::Visit& visit) { return systems_[0]->Successors(state_, visit); }, id);
    ++at_;
    ++expanded_;
  }

  Listed Expand(size_t member, size_t first, size_t last, Candidates& list) {
    S& system = *systems_[member];
    list.Clear();
    bool stopped = false;
    for (size_t i = first; i < last; ++i) {
      const auto source = static_cast<uint32_t>(i);
      if (list.count() >= kListed) return {Cut::kMany, source, {}};
      const bool polls = (i - first) % kBetween == 0;
      if (options_.stop.cancelled() || (polls && Poll(member))) return {Cut::kStopped, source, {}};
      const State state = frontier_[at_ + i];
      if (options_.deadlocks && system.Deadlocked(state)) return {Cut::kDead, source, {}};
      const uint32_t before = list.count();
      const Broken broken = system.Successors(state, [&](State next) {
        list.Add(next, source);
        const uint32_t count = list.count() - before;
        if (count % kPolled == 0) stopped = stopped || Poll(member);
        return !stopped && count <= kListed;
      });
      if (stopped) return {Cut::kStopped, source, {}};
      if (list.count() - before > kListed) {
        list.KeepFirst(before);
        return {Cut::kMany, source, {}};
      }
      std::ranges::copy(system.Marks(), marks_.begin() + static_cast<std::ptrdiff_t>(i * width_));
      if (broken.property >= 0) return {Cut::kBroken, source, broken};
    }
    return {};
  }

  // What `list` lists from one state, in pieces.
  template <typename ListAll>
  void List(const ListAll& list, StateId from) {
    if (lists_.empty()) lists_.resize(1);
    parents_.assign(1, from);
    Candidates& piece = lists_[0];
    piece.Clear();
    marks_.assign(width_, 0);  // counted once, at the end
    bool stopped = false;
    const Broken broken = list([&](State next) {
      piece.Add(next, 0);
      if (piece.count() % kPolled == 0) stopped = stopped || Poll(0);
      if (piece.count() < kListed || stopped) return !stopped;
      Settle({&piece, 1}, {});
      piece.Clear();
      return !done_;
    });
    if (from != kNoState && !stopped) Count(systems_[0]->Marks());
    if (done_) return;
    if (stopped) return End(Ending::kStopped);
    Settle({&piece, 1}, broken.property >= 0 ? Listed{Cut::kBroken, 0, broken} : Listed{});
  }

  // Visits what was listed up to a cut. What was found first counts, and nothing behind it.
  void Settle(std::span<const Candidates> lists, const Listed& last) {
    if (visited_.BytesAfter(lists) + OtherBytes() > options_.memory) return End(Ending::kMemory);
    const auto check = [&](size_t member, State state) { return systems_[member]->Check(state); };
    uint64_t listed = 0;
    for (const Candidates& list : lists) listed += list.count();
    StateId newest = kNoState;
    for (const Visited::Fresh& fresh : visited_.Visit(lists, parents_, check, crew_)) {
      ++result_.states;
      newest = fresh.id;
      if (fresh.property >= 0) {
        result_.transitions += fresh.order + 1;
        CountFirst(fresh.source + 1);
        return Break({fresh.property, true}, fresh.id);
      }
      next_.Add(fresh.id, fresh.state);
      if (result_.states < options_.states) continue;
      result_.transitions += fresh.order + 1;
      CountFirst(fresh.source + 1);
      return End(Ending::kStates);
    }
    result_.transitions += listed;
    CountFirst(last.cut == Cut::kNone     ? parents_.size()
               : last.cut == Cut::kBroken ? last.source + 1
                                          : last.source);
    if (visited_.full()) return End(Ending::kStates);
    switch (last.cut) {
      case Cut::kNone:
      case Cut::kMany:
        return;
      case Cut::kStopped:
        return End(Ending::kStopped);
      case Cut::kDead:
        bad_ = parents_[last.source];
        return End(Ending::kDeadlock);
      case Cut::kBroken:
        return Break(last.broken, last.broken.at_visited ? newest : parents_[last.source]);
    }
  }

  void Count(std::span<const uint64_t> marks) {
    for (size_t w = 0; w < width_; ++w) {
      for (uint64_t left = marks[w]; left != 0; left &= left - 1)
        ++result_.marked[64 * w + static_cast<size_t>(std::countr_zero(left))];
    }
  }
  // What was marked in the first states of the batch.
  void CountFirst(size_t states) {
    for (size_t i = 0; i < states; ++i) Count(std::span<const uint64_t>(marks_).subspan(i * width_, width_));
  }

  void Break(const Broken& broken, StateId state) {
    result_.broken = broken;
    bad_ = state;
    End(Ending::kBroken);
  }

  // Of member 0, which runs in the thread of the caller, also tells how far the search is.
  bool Poll(size_t member) {
    if (member == 0) Tell();
    return options_.stop.StopRequested();
  }

  void Tell() {
    if (!options_.progress) return;
    const auto now = Clock::now();
    if (now - last_ <= std::chrono::milliseconds(200)) return;
    last_ = now;
    options_.progress({result_.states, frontier_.size() - at_ + next_.size(), result_.depth, Seconds()});
  }

  size_t OtherBytes() const {
    size_t all = frontier_.bytes() + next_.bytes() + (options_.beside ? options_.beside() : 0);
    for (const Candidates& list : lists_) all += list.bytes();
    return all;
  }

  // The ids of the path are known; its states are found again from the initial ones. Then the first system
  // meets once more what is broken on the way, so that it can tell of it.
  void FindPath() {
    std::vector<StateId> ids;
    for (StateId id = bad_; id != kNoState; id = visited_.Parent(id)) ids.push_back(id);
    std::reverse(ids.begin(), ids.end());
    const auto from_last = [&](const explore::Visit& visit) {
      return result_.path.empty() ? systems_[0]->Initial(visit)
                                  : systems_[0]->Successors(result_.path.back(), visit);
    };
    for (const StateId id : ids) {
      KeptState found;
      from_last([&](State candidate) {
        if (!visited_.Is(candidate, id)) return true;
        found.assign(candidate.begin(), candidate.end());
        return false;
      });
      result_.path.push_back(std::move(found));
    }
    if (result_.ending == Ending::kBroken && !result_.broken.at_visited)
      from_last([](State) { return true; });
  }

  std::span<S* const> systems_;
  const SearchOptions& options_;
  base::Crew crew_;
  SearchResult result_;
  Visited visited_;
  Frontier frontier_;
  Frontier next_;
  size_t at_ = 0;          // the next state of the frontier
  uint64_t expanded_ = 0;  // states whose successors were listed
  std::vector<Candidates> lists_;
  std::vector<Listed> listed_;
  std::vector<StateId> parents_;
  size_t width_;                 // of marks
  std::vector<uint64_t> marks_;  // by number of the state in the batch
  KeptState state_;
  StateId bad_ = kNoState;
  bool done_ = false;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

/// Searches breadth first from all initial states, with a thread for each of the systems, which are all the
/// same. The result does not depend on how many there are, but for seconds, bytes, and where memory ends it; neither
/// does the path; what is told of a broken property, the first system knows.
///
/// Exact unless `options.compact`: then a state whose hash was seen before is taken for visited. Memory is
/// O(states): the bytes of each state (or its hash) and 13 to 20 more.
template <TransitionSystem S>
SearchResult Search(std::span<S* const> systems, const SearchOptions& options) {
  return Searcher<S>(systems, options).Run();
}

/// Searches with one system, by the thread of the caller.
template <TransitionSystem S>
SearchResult Search(S& system, const SearchOptions& options) {
  S* const only = &system;
  return Search<S>(std::span<S* const>(&only, 1), options);
}

}  // namespace rondo::explore
