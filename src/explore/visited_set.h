#pragma once

#include <memory>
#include <span>
#include <vector>

#include "explore/transition_system.h"

/// The memory of a search.
namespace rondo::explore {

/// Numbers the states that were visited, in the order of their insertion. Exact, or by a hash of 64 bits
/// alone (hash compaction): then two states that share a hash count as one. The index is an open-addressing
/// table that is at most half full; states lie in blocks, so that none are moved, and no memory is spare.
class VisitedSet {
 public:
  /// `words`: the length of every state. `compact`: keep hashes instead of states.
  VisitedSet(size_t words, bool compact);

  /// Returns the number of the state, which is added if it was not there; `fresh` tells whether it was added.
  uint32_t Insert(std::span<const Word> state, bool& fresh);
  size_t size() const { return count_; }
  /// Returns the words of a state, valid until the next insertion. Only where states are kept: with hash
  /// compaction there are none.
  std::span<const Word> operator[](uint32_t number) const { return {Stored(number), words_}; }
  /// Reports whether the state has this number; with hash compaction, whether its hash is that one's.
  bool Is(std::span<const Word> state, uint32_t number) const;
  /// Returns the memory that states and table occupy, as allocated.
  size_t bytes() const {
    return blocks_.size() * kBlock * words_ * sizeof(Word) + table_.capacity() * sizeof(uint32_t);
  }
  /// Returns the memory that they occupy while the next state is added.
  size_t bytes_next() const {
    return bytes() + (count_ % kBlock == 0 ? kBlock * words_ * sizeof(Word) : 0) +
           (Full() ? 2 * table_.capacity() * sizeof(uint32_t) : 0);
  }

  /// Is the largest number of states that a set may hold: numbers have 32 bits.
  static constexpr uint32_t kMost = 0xfffffff0u;

 private:
  static constexpr size_t kBlock = 4096;  // states

  Word* Stored(size_t number) const { return blocks_[number / kBlock].get() + number % kBlock * words_; }
  bool Full() const { return (count_ + 1) * 2 > table_.size(); }
  void Grow();
  static uint64_t Hash(std::span<const Word> state);

  size_t words_;
  bool compact_;
  size_t count_ = 0;
  std::vector<std::unique_ptr<Word[]>> blocks_;  // exact: all words; compact: the hashes
  std::vector<uint32_t> table_;                  // open addressing: number + 1
};

}  // namespace rondo::explore
