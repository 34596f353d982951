#include "choreo/prove/answer.h"

#include <cmath>

namespace rondo::choreo {

using expr::Numeric;

Numeric::Point PointOf(const solve::Answer& answer) {
  Numeric::Point point;
  if (const auto* sat = std::get_if<solve::Sat>(&answer)) {
    for (const auto& [term, value] : sat->values) {
      if (value.IsNumber()) point.emplace(term, value.AsNumber().ToDouble());
    }
  } else if (const auto* delta = std::get_if<solve::DeltaSat>(&answer)) {
    for (const auto& [term, range] : delta->box) {
      const auto [lo, hi] = range;
      const bool low = std::isfinite(lo), high = std::isfinite(hi);
      point.emplace(term, low && high ? lo / 2 + hi / 2 : low ? lo : high ? hi : 0);
    }
  }
  return point;
}

}  // namespace rondo::choreo
