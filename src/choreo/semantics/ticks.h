#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "choreo/graph/graph.h"

namespace rondo::choreo {

/// Time in ticks: half of what divides every duration of a choreography. Durations are closed intervals, so
/// that whatever can be reached in dense time can be reached at whole ticks; the halves let motions end
/// between their bounds.
class Ticks {
 public:
  static constexpr int64_t kForever = std::numeric_limits<int64_t>::max();

  explicit Ticks(const std::vector<Duration>& durations);
  int64_t Least(const Duration& d) const { return Of(d.least); }
  int64_t Most(const Duration& d) const { return d.most ? Of(*d.most) : kForever; }
  /// Beyond every bound; clocks need not count further.
  int64_t enough() const { return enough_; }

 private:
  int64_t Of(const expr::Rational& seconds) const;

  expr::Rational tick_{1};
  int64_t enough_ = 1;
};

}  // namespace rondo::choreo
