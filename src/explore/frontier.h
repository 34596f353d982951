#pragma once

#include <cstdint>
#include <vector>

#include "explore/state_table.h"

namespace rondo::explore {

/// Keeps the states of one level of a search, in the order in which they were met.
class Frontier {
 public:
  void Add(StateId id, State state) {
    ids_.push_back(id);
    bytes_.insert(bytes_.end(), state.begin(), state.end());
    ends_.push_back(bytes_.size());
  }
  void Clear() {
    ids_.clear();
    bytes_.clear();
    ends_.clear();
  }
  size_t size() const { return ids_.size(); }
  const StateId& id(size_t i) const { return ids_[i]; }
  State operator[](size_t i) const {
    const size_t begin = i == 0 ? 0 : ends_[i - 1];
    return {bytes_.data() + begin, ends_[i] - begin};
  }
  /// Returns the memory that they occupy, as allocated.
  size_t bytes() const {
    return bytes_.capacity() + ids_.capacity() * sizeof(StateId) + ends_.capacity() * sizeof(uint64_t);
  }

 private:
  std::vector<StateId> ids_;
  std::vector<uint8_t> bytes_;
  std::vector<uint64_t> ends_;
};

}  // namespace rondo::explore
