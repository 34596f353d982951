#pragma once

#include <cstdint>

namespace rondo::transport::simulated {

/// Is the clock of one robot: it began at another moment than the others and runs a little faster or slower.
struct Clock {
  int64_t offset = 0;
  int32_t ppm = 0;  ///< by how many millionths it runs faster

  /// Returns what the clock says at a moment of virtual time, in nanoseconds.
  int64_t At(int64_t time) const {
    return offset + time + time / 1'000'000 * ppm + time % 1'000'000 * ppm / 1'000'000;
  }
  /// Returns the first moment of virtual time at which it says at least so.
  int64_t When(int64_t local) const {
    int64_t time = local - offset;
    // Each step leaves `ppm` millionths of the error.
    for (int64_t error = local - At(time); error > 1 || error < -1; error = local - At(time)) time += error;
    while (At(time) < local) ++time;
    while (time > 0 && At(time - 1) >= local) --time;
    return time;
  }
};

}  // namespace rondo::transport::simulated
