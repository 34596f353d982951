#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rondo::koord::semantics {

/// Bounds the ways in which `any` lets one event of one robot end that are followed.
inline constexpr size_t kMostWays = 100'000;

/// Goes through everything that `any` may choose in one event: the first values at first, and then, run by run, all others. What is
/// chosen later may depend on what was chosen before.
class Choices {
 public:
  /// Forgets all: the next run is the first of an event.
  void Clear() { picks_.clear(); }
  /// Begins a run.
  void Begin() { met_ = 0; }
  /// Returns what this run chooses next, a number below `possibilities`.
  uint64_t Pick(uint64_t possibilities) {
    if (met_ == picks_.size()) picks_.push_back({0, possibilities});
    return picks_[met_++].pick;
  }
  /// Moves on to the next choices. Returns false behind the last ones.
  bool Next() {
    while (!picks_.empty() && picks_.back().pick + 1 >= picks_.back().possibilities) picks_.pop_back();
    if (picks_.empty()) return false;
    ++picks_.back().pick;
    return true;
  }
  /// Reports whether the last run chose anything.
  bool any() const { return !picks_.empty(); }

 private:
  struct Picked {
    uint64_t pick, possibilities;
  };
  std::vector<Picked> picks_;  // in the order in which a run meets them
  size_t met_ = 0;
};

}  // namespace rondo::koord::semantics
