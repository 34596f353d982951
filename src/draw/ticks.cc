#include "draw/ticks.h"

#include <cmath>

namespace rondo::draw {

std::vector<double> Ticks(double lo, double hi, size_t most) {
  if (!(lo < hi) || !std::isfinite(hi - lo) || most == 0) return {};
  // The least step that leaves at most so many marks.
  const double least = (hi - lo) / static_cast<double>(most);
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1, 2, 5, 10, 20}) {
    const double step = factor * power;
    const double first = std::ceil(lo / step), last = std::floor(hi / step);
    if (!(last - first < static_cast<double>(most))) continue;
    std::vector<double> ticks;
    const size_t count = last < first ? 0 : static_cast<size_t>(last - first) + 1;
    for (size_t k = 0; k < count; ++k) ticks.push_back((first + static_cast<double>(k)) * step);
    return ticks;
  }
  return {};
}

}  // namespace rondo::draw
