#include "choreo/semantics/ticks.h"

#include <algorithm>

namespace rondo::choreo {

using expr::Rational;

namespace {

Rational CommonDivisor(Rational a, Rational b) {
  while (!b.IsZero()) {
    const Rational rest = a - (a / b).Floor() * b;
    a = b;
    b = rest;
  }
  return a;
}

}  // namespace

Ticks::Ticks(const std::vector<Duration>& durations) {
  Rational divisor(0);
  for (const Duration& d : durations) {
    divisor = CommonDivisor(divisor, d.least);
    if (d.most) divisor = CommonDivisor(divisor, *d.most);
  }
  if (!divisor.IsZero()) tick_ = divisor / Rational(2);
  for (const Duration& d : durations) {
    enough_ = std::max(enough_, Of(d.least) + 1);
    if (d.most) enough_ = std::max(enough_, Of(*d.most) + 1);
  }
}

int64_t Ticks::Of(const Rational& seconds) const {
  return static_cast<int64_t>((seconds / tick_).ToDouble());
}

}  // namespace rondo::choreo
