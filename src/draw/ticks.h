#pragma once

#include <cstddef>
#include <vector>

namespace rondo::draw {

/// Returns the marks of an axis from `lo` to `hi`: the multiples within of 1, 2 or 5 times a power of ten, as
/// many as possible, at most `most` (at least 1). Returns none if the axis is empty or not finite.
std::vector<double> Ticks(double lo, double hi, size_t most);

}  // namespace rondo::draw
