#pragma once

#include <cstdint>
#include <span>

/// Interval arithmetic on eight intervals at once, for the instruction set that the machine has.
namespace rondo::interval {

/// How many intervals a batch holds.
inline constexpr int kLanes = 8;

/// Holds eight intervals, lane by lane. The lower bounds are kept negated, so that every bound is rounded
/// upwards.
struct alignas(64) Batch {
  double nl[kLanes];  ///< -lower
  double hi[kLanes];
};

/// Holds the operations for one instruction set. What every kernel guarantees, lane by lane: from non-empty
/// arguments, `out` encloses the exact image of the part of the arguments on which the function is defined
/// (empty if there is none; a quotient by zero is any number). Bounds of + - * / and sqrt are off by at most
/// two units in the last place, those of the elementary functions by at most 2^-47 relative or, for sin, cos
/// and acos, 2^-47 absolute; sin, cos and tan of numbers beyond 65,536 are not reduced. Empty arguments give
/// any result. `out` may be an argument.
struct Kernels {
  using Unary = void (*)(const Batch& a, Batch& out);
  using Binary = void (*)(const Batch& a, const Batch& b, Batch& out);
  using Power = void (*)(const Batch& a, int n, Batch& out);
  /// Contract `x` (and `y`) to a set that still holds every value with f(x, y) in `z`, as HC4 does on its way
  /// back (Benhamou et al. 1999).
  using UnaryInverse = void (*)(const Batch& z, Batch& x);
  using BinaryInverse = void (*)(const Batch& z, Batch& x, Batch& y);
  using PowerInverse = void (*)(const Batch& z, Batch& x, int n);

  const char* name;  ///< of the instruction set, for messages
  Unary neg, sqr, sqrt, abs, sin, cos, tan, asin, acos, atan, exp, log;
  Binary add, sub, mul, div, min, max, atan2, meet, hull;
  Power pow;  ///< n >= 1
  UnaryInverse neg_inverse, sqr_inverse, sqrt_inverse, abs_inverse, sin_inverse, cos_inverse, asin_inverse,
      acos_inverse, atan_inverse, exp_inverse, log_inverse;
  BinaryInverse add_inverse, sub_inverse, mul_inverse, div_inverse, min_inverse, max_inverse;
  PowerInverse pow_inverse;  ///< n >= 2
  /// Returns the lanes whose interval is empty, as bits.
  unsigned (*empty)(const Batch& a);
};

/// Names the instruction sets that there are kernels for.
enum class Backend : uint8_t { kPortable, kAvx2, kAvx512 };

/// Returns the back ends that this machine can run, best last.
std::span<const Backend> AvailableBackends();
/// Returns the kernels of a back end, which must be available.
const Kernels& KernelsOf(Backend backend);
/// Returns the kernels of the best back end of this machine.
const Kernels& BestKernels();

}  // namespace rondo::interval
