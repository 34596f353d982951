#pragma once

#include <cmath>

#include "interval/interval.h"

/// Upper bounds with ordinary arithmetic: sums and products of non-negative doubles are rounded up once, at
/// the end.
namespace rondo::reach::certify {

using interval::Interval;

/// Returns at least the exact value of an expression whose rounded value is `x`: of sums and products of
/// non-negative doubles, at most 2^16 operations deep. The last term is for products that underflow.
inline double Up(double x) { return x * (1 + 0x1p-36) + 0x1p-980; }

/// Returns at least the relative error of `n` roundings to nearest, one after the other (n < 2^40): the
/// classical n u / (1 - n u), u = 2^-53.
inline double Gamma(double n) { return n * 0x1.01p-53; }

/// Returns the largest distance of a member from zero.
inline double Magnitude(Interval i) { return std::fmax(std::fabs(i.lo), std::fabs(i.hi)); }
/// Returns the interval [-radius, radius].
inline Interval Around(double radius) { return {-radius, radius}; }
/// Returns at least the distance of any member from i.Middle().
inline double Radius(Interval i) {
  const double middle = i.Middle();
  return i.IsPoint() ? 0 : Up(std::fmax(i.hi - middle, middle - i.lo));
}
/// Reports whether both bounds are finite.
inline bool IsFinite(Interval i) { return std::isfinite(i.lo) && std::isfinite(i.hi); }

}  // namespace rondo::reach::certify
