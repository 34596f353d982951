#pragma once

#include <span>
#include <vector>

#include "explore/transition_system.h"

namespace rondo::explore {

/// The states that were visited, numbered in the order of their insertion. Exact, or by a hash of 64 bits
/// alone (hash compaction: two states that share a hash count as one).
class VisitedSet {
 public:
  VisitedSet(size_t words, bool compact);

  /// The number of the state; `fresh` tells whether it is new.
  uint32_t Insert(std::span<const Word> state, bool& fresh);
  size_t size() const { return count_; }
  /// Only of exact sets.
  std::span<const Word> operator[](uint32_t number) const {
    return {states_.data() + static_cast<size_t>(number) * words_, words_};
  }
  /// Does the state have this number?
  bool Is(std::span<const Word> state, uint32_t number) const;
  size_t bytes() const;

  static constexpr uint32_t kMost = 0xfffffff0u;

 private:
  void Grow();
  static uint64_t Hash(std::span<const Word> state);

  size_t words_;
  bool compact_;
  size_t count_ = 0;
  std::vector<Word> states_;     // exact: all words; compact: the hashes
  std::vector<uint32_t> table_;  // open addressing: number + 1
};

}  // namespace rondo::explore
