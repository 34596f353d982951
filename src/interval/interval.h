#pragma once

#include <limits>
#include <string>
#include <vector>

/// Rigorous interval arithmetic: every operation encloses the exact results of its arguments' members.
namespace rondo::interval {

/// Is a closed interval of reals with double bounds; a bound may be infinite. Empty if lo > hi. Operations
/// have the guarantees of `Kernels` (batch.h): partial functions are enclosed over the part of the argument
/// that lies in their domain, a quotient by zero is any number. An operation on an empty interval may give
/// anything.
struct Interval {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();

  static Interval Point(double x) { return {x, x}; }
  static Interval Empty() {
    return {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  }

  bool IsEmpty() const { return !(lo <= hi); }
  bool IsPoint() const { return lo == hi; }
  bool Contains(double x) const { return lo <= x && x <= hi; }
  bool Contains(Interval other) const { return lo <= other.lo && other.hi <= hi; }
  /// Returns hi - lo, rounded to nearest: for decisions, not for bounds.
  double Width() const { return hi - lo; }
  /// Returns a member of a non-empty interval, near its middle; finite.
  double Middle() const;
  friend bool operator==(const Interval&, const Interval&) = default;
};

/// Is a product of intervals, one for each variable in turn; empty if one of them is.
using Box = std::vector<Interval>;

/// Enclose the results of the operation or function for all members of the arguments; angles in radians.
Interval operator-(Interval a);
Interval operator+(Interval a, Interval b);
Interval operator-(Interval a, Interval b);
Interval operator*(Interval a, Interval b);
Interval operator/(Interval a, Interval b);
Interval Meet(Interval a, Interval b);  ///< the intersection, perhaps empty
Interval Hull(Interval a, Interval b);  ///< the smallest interval that holds both; of non-empty intervals
Interval Abs(Interval a);
Interval Sqr(Interval a);
Interval Pow(Interval a, int n);  ///< n >= 1
Interval Sqrt(Interval a);
Interval Min(Interval a, Interval b);
Interval Max(Interval a, Interval b);
Interval Sin(Interval a);
Interval Cos(Interval a);
Interval Tan(Interval a);
Interval Asin(Interval a);
Interval Acos(Interval a);
Interval Atan(Interval a);
/// Encloses the angle of each point (x, y), in [-pi, pi]; at the origin it is any of these.
Interval Atan2(Interval y, Interval x);
Interval Exp(Interval a);
Interval Log(Interval a);

/// Returns `[0.1, 0.2]`, with digits enough to read the bounds back.
std::string ToString(Interval a);

}  // namespace rondo::interval
