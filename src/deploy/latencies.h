#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace rondo::deploy {

/// Counts spans of time, without allocating: quantiles are right to five in a hundred.
class Latencies {
 public:
  /// Adds a span in nanoseconds.
  void Add(int64_t span) {
    ++counts_[Bucket(span)];
    ++all_;
    most_ = std::max(most_, span);
  }
  /// Returns what so large a share of the spans does not exceed, in seconds; 0 if there are none.
  double Quantile(double share) const {
    if (all_ == 0) return 0;
    auto rank = static_cast<uint64_t>(share * static_cast<double>(all_ - 1));
    for (size_t b = 0; b < counts_.size(); ++b) {
      if (rank < counts_[b]) return std::min(1e-6 * std::pow(kStep, static_cast<double>(b)), Most());
      rank -= counts_[b];
    }
    return Most();
  }
  double Most() const { return static_cast<double>(most_) * 1e-9; }

 private:
  static constexpr double kStep = 1.05;
  static size_t Bucket(int64_t span) {
    const double steps = std::log(std::max(static_cast<double>(span) * 1e-3, 1.0)) / std::log(kStep);
    return std::min(static_cast<size_t>(std::ceil(steps)), size_t{399});
  }
  std::array<uint64_t, 400> counts_{};
  uint64_t all_ = 0;
  int64_t most_ = 0;
};

}  // namespace rondo::deploy
