#pragma once

#include <cmath>
#include <utility>

#include "interval/interval.h"

/// Upper bounds in round-to-nearest: sums and products of non-negative doubles are enlarged once, at the end.
namespace rondo::reach {

/// Half a unit in the last place, relative: 2^-53.
inline constexpr double kHalfUlp = 0x1p-53;

/// Returns at least the exact value of an expression of at most 4000 sums and products of non-negative
/// doubles whose rounded value is `x`; also if some of them underflow.
inline double Above(double x) { return x * (1 + 0x1p-40) + 0x1p-1000; }
/// Returns at most the exact value of such an expression.
inline double Below(double x) { return std::fmax(0, x * (1 - 0x1p-40) - 0x1p-1000); }

/// Returns the largest distance of a member from zero.
inline double Magnitude(interval::Interval i) { return std::fmax(std::fabs(i.lo), std::fabs(i.hi)); }

/// Returns at least half the width of an interval.
inline double RadiusOf(interval::Interval i) { return Above((i.hi - i.lo) * 0.5); }

/// Returns the interval [-radius, radius].
inline interval::Interval Around(double radius) { return {-radius, radius}; }

/// Returns a double in an interval, and at least how far its members are from that.
inline std::pair<double, double> Centred(interval::Interval i) {
  const double middle = i.Middle();
  return {middle, Above(std::fmax(i.hi - middle, middle - i.lo))};
}

/// Returns at least how much `operations` roundings one after the other can add up to, relative to the sum of
/// magnitudes.
inline double Roundings(double operations) { return operations * kHalfUlp * (1 + 0x1p-20); }

}  // namespace rondo::reach
