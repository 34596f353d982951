#pragma once

#include <cmath>

#include "interval/interval.h"

/// Upper bounds in round-to-nearest: sums and products of non-negative doubles are enlarged once, at the end.
namespace rondo::reach {

/// Half a unit in the last place, relative.
inline constexpr double kHalfUlp = 0x1p-53;

/// At least the exact value of an expression of at most 4000 sums and products of non-negative doubles whose
/// rounded value is `x`; also if some of them underflow.
inline double Above(double x) { return x * (1 + 0x1p-40) + 0x1p-1000; }
/// At most the exact value of such an expression.
inline double Below(double x) { return std::fmax(0, x * (1 - 0x1p-40) - 0x1p-1000); }

/// The largest distance of a member from zero.
inline double Magnitude(interval::Interval i) { return std::fmax(std::fabs(i.lo), std::fabs(i.hi)); }

/// How much `operations` roundings one after the other can add up to, relative to the sum of magnitudes.
inline double Roundings(double operations) { return operations * kHalfUlp * (1 + 0x1p-20); }

}  // namespace rondo::reach
