#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>

#include "explore/state_table.h"

namespace rondo::explore {

/// Is the number of shares into which the visited states are divided, by their hashes. A search gives the same
/// results whatever it is.
inline constexpr size_t kShares = 16;

/// Keeps the states that one thread has listed, in order, until it is known which of them are new.
class Candidates {
 public:
  /// Forgets all, and keeps the memory.
  void Clear() {
    for (Share& share : shares_) share.size = share.count = 0;
    count_ = 0;
  }
  /// Adds a state that was met from the source with this number.
  void Add(State state, uint32_t source) {
    const Header header{HashOf(state), count_++, source, static_cast<uint32_t>(state.size())};
    Share& share = shares_[ShareOf(header.hash)];
    if (share.capacity < share.size + sizeof header + state.size()) Grow(share, sizeof header + state.size());
    uint8_t* const at = share.bytes.get() + share.size;
    std::memcpy(at, &header, sizeof header);
    std::copy(state.begin(), state.end(), at + sizeof header);
    share.size += sizeof header + state.size();
    ++share.count;
  }
  uint32_t count() const { return count_; }
  uint32_t count(size_t share) const { return shares_[share].count; }
  /// Returns how many bytes the states of a share have, and what is kept of them besides.
  size_t size(size_t share) const { return shares_[share].size; }
  /// Returns the memory that they occupy, as allocated.
  size_t bytes() const {
    size_t all = 0;
    for (const Share& share : shares_) all += share.capacity;
    return all;
  }
  /// Takes back all but the first `count`. Cost: linear in those that stay.
  void KeepFirst(uint32_t count);

  /// Is one of them.
  struct Item {
    uint64_t hash;
    uint32_t order;  ///< the number of those that were added before
    uint32_t source;
    State state;
  };
  /// Returns the item at a position of a share, from 0, and moves on to the next; the last one ends at `size`.
  Item Read(size_t share, size_t& at) const {
    Header header;
    const uint8_t* const from = shares_[share].bytes.get() + at;
    std::memcpy(&header, from, sizeof header);
    at += sizeof header + header.length;
    return {header.hash, header.order, header.source, {from + sizeof header, header.length}};
  }

 private:
  struct Header {
    uint64_t hash;
    uint32_t order, source, length;
  };
  struct Share {
    std::unique_ptr<uint8_t[]> bytes;
    size_t size = 0;
    size_t capacity = 0;
    uint32_t count = 0;
  };
  // Tables look at the low bits and the highest ones.
  static size_t ShareOf(uint64_t hash) { return hash >> 40 & (kShares - 1); }
  static void Grow(Share& share, size_t more);

  std::array<Share, kShares> shares_;
  uint32_t count_ = 0;
};

}  // namespace rondo::explore
