#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "explore/transition_system.h"

/// The memory of a search.
namespace rondo::explore {

/// Returns a hash of all bytes of a state.
uint64_t HashOf(State state);

/// Names a state that a search has visited: where it lies.
using StateId = uint64_t;
/// Is the id of no state.
inline constexpr StateId kNoState = (uint64_t{1} << 40) - 1;

/// Keeps one share of the states that were visited, and where each was met first. Exact, or by a hash of 64
/// bits alone (hash compaction): then two states that share a hash count as one. States lie one behind the
/// other in blocks, with their bytes alone, so that none are moved and no memory is spare; the index has five
/// bytes for a slot and is at most seven tenths full. One thread at a time.
class StateTable {
 public:
  /// `share`: which of the shares of a search this is, below 256; part of every id. `compact`: keep hashes
  /// instead of states.
  StateTable(uint8_t share, bool compact);

  /// Asks for the cache lines that `Insert` of this hash will read.
  void Prefetch(uint64_t hash) const {
    const size_t at = hash & mask_;
    __builtin_prefetch(tags_.get() + at);
    __builtin_prefetch(places_.get() + at);
  }
  /// Asks for the state itself that `Insert` will compare with, most likely.
  void PrefetchState(uint64_t hash) const {
    const size_t at = hash & mask_;
    if (tags_[at] == TagOf(hash)) __builtin_prefetch(At(places_[at]));
  }
  /// Adds a state that was met first from `parent`, and returns its id; nothing if it was there.
  std::optional<StateId> Insert(State state, uint64_t hash, StateId parent);
  /// Reports whether there is little room left in ids: 256 MB of states, at most.
  bool full() const { return blocks_.size() + kSpare >= kMostBlocks; }

  size_t size() const { return count_; }
  /// Returns from where the state was met first; kNoState for an initial one.
  StateId Parent(StateId id) const;
  /// Reports whether the state has this id; with hash compaction, whether its hash is that one's.
  bool Is(State state, StateId id) const;

  /// Returns the memory that states and index occupy, as allocated.
  size_t bytes() const { return block_bytes_ + (mask_ + 1) * kSlot; }
  /// Returns the most memory that they occupy at any moment while `states` more are added, of `state_bytes`
  /// bytes altogether.
  size_t BytesAfter(size_t states, size_t state_bytes) const;

 private:
  static constexpr size_t kBlock = size_t{1} << 16;
  static constexpr size_t kMostBlocks = (size_t{1} << 32) / kBlock - 1;
  static constexpr size_t kSpare = 4096;
  static constexpr size_t kSlot = sizeof(uint8_t) + sizeof(uint32_t);
  static constexpr size_t kParent = 5;  // bytes

  uint8_t* At(uint32_t place) const { return blocks_[place / kBlock].get() + place % kBlock; }
  bool Crowded(size_t count) const { return count * 10 > (mask_ + 1) * 7; }
  static uint8_t TagOf(uint64_t hash) { return static_cast<uint8_t>(1 + (hash >> 56) % 255); }
  bool Holds(uint32_t place, State state, uint64_t hash) const;
  uint32_t Append(State state, uint64_t hash, StateId parent);
  void Grow();
  void Place(uint64_t hash, uint32_t place);

  uint64_t share_;
  bool compact_;
  size_t count_ = 0;
  size_t mask_;
  std::unique_ptr<uint8_t[]> tags_;     // open addressing; 0: an empty slot
  std::unique_ptr<uint32_t[]> places_;  // of the states, by slot
  std::vector<std::unique_ptr<uint8_t[]>> blocks_;
  std::vector<uint32_t> used_;  // bytes, by block
  size_t block_bytes_ = 0;
};

}  // namespace rondo::explore
