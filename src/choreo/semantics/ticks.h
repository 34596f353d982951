#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "choreo/graph/graph.h"

/// Measures time in whole numbers, so that states of runs are finite.
namespace rondo::choreo {

/// Converts durations to ticks: half of what divides every duration of a choreography. Durations are closed
/// intervals, so that whatever can be reached in dense time can be reached at whole ticks; the halves let
/// motions end between their bounds.
class Ticks {
 public:
  static constexpr int64_t kForever = std::numeric_limits<int64_t>::max();

  explicit Ticks(const std::vector<Duration>& durations);
  /// Returns the least and the largest number of ticks that a motion of this duration takes; kForever if
  /// there is no largest one.
  int64_t Least(const Duration& d) const { return Of(d.least); }
  int64_t Most(const Duration& d) const { return d.most ? Of(*d.most) : kForever; }
  /// Returns a number of ticks beyond every bound; clocks need not count further.
  int64_t enough() const { return enough_; }

 private:
  int64_t Of(const expr::Rational& seconds) const;

  expr::Rational tick_{1};
  int64_t enough_ = 1;
};

}  // namespace rondo::choreo
