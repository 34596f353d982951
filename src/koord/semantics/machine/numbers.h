#pragma once

#include <cmath>
#include <limits>

#include "koord/semantics/machine/registers.h"

/// Carries out arithmetic: on integers of 64 bits that never wrap, with Euclidean division, and on doubles
/// that are always finite. What leaves these ranges is `Fault::kOverflow`.
namespace rondo::koord::semantics {

/// Pops two integers a and b and pushes what `operation(a, b, &result)` writes. The operation returns true if
/// that is beyond 64 bits, which is an overflow.
template <typename Operation>
[[gnu::always_inline]] inline Fault Integers(Registers& r, Operation operation) {
  const int64_t b = ToInt(*--r.top);
  const int64_t a = ToInt(r.top[-1]);
  int64_t result = 0;
  if (operation(a, b, &result)) return Fault::kOverflow;
  r.top[-1] = FromInt(result);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunAddInt(Registers& r, const Instruction&) {
  return Integers(r, [](int64_t a, int64_t b, int64_t* to) { return __builtin_add_overflow(a, b, to); });
}

RONDO_INSTRUCTION RunSubInt(Registers& r, const Instruction&) {
  return Integers(r, [](int64_t a, int64_t b, int64_t* to) { return __builtin_sub_overflow(a, b, to); });
}

RONDO_INSTRUCTION RunMulInt(Registers& r, const Instruction&) {
  return Integers(r, [](int64_t a, int64_t b, int64_t* to) { return __builtin_mul_overflow(a, b, to); });
}

/// Returns the remainder of the Euclidean division, which is never negative. `b` must not be 0, and a / b
/// must not overflow.
inline int64_t EuclideanRest(int64_t a, int64_t b) {
  const int64_t rest = a % b;
  return rest < 0 ? (b > 0 ? rest + b : rest - b) : rest;
}

/// Does what `Integers` does, unless the divisor, which is on top, is 0.
template <typename Operation>
[[gnu::always_inline]] inline Fault Quotients(Registers& r, Operation operation) {
  if (ToInt(r.top[-1]) != 0) return Integers(r, operation);
  RONDO_TOTAL(Division);
  --r.top;
  r.top[-1] = 0;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunDivInt(Registers& r, const Instruction&) {
  return Quotients(r, [](int64_t a, int64_t b, int64_t* to) {
    if (a == std::numeric_limits<int64_t>::min() && b == -1) return true;
    const int64_t towards_zero = a / b;
    *to = a % b < 0 ? towards_zero - (b > 0 ? 1 : -1) : towards_zero;
    return false;
  });
}

RONDO_INSTRUCTION RunModInt(Registers& r, const Instruction&) {
  return Quotients(r, [](int64_t a, int64_t b, int64_t* to) {
    *to = b == -1 ? 0 : EuclideanRest(a, b);
    return false;
  });
}

RONDO_INSTRUCTION RunNegInt(Registers& r, const Instruction&) {
  const int64_t a = ToInt(r.top[-1]);
  if (a == std::numeric_limits<int64_t>::min()) return Fault::kOverflow;
  r.top[-1] = FromInt(-a);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunAbsInt(Registers& r, const Instruction&) {
  const int64_t a = ToInt(r.top[-1]);
  if (a == std::numeric_limits<int64_t>::min()) return Fault::kOverflow;
  r.top[-1] = FromInt(a < 0 ? -a : a);
  return Fault::kNone;
}

/// Replaces the top of the stack by a double; an overflow, if it is not finite.
inline Fault SetFinite(Registers& r, double value) {
  if (!std::isfinite(value)) return Fault::kOverflow;
  r.top[-1] = FloatWord(value);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunAddFloat(Registers& r, const Instruction&) {
  --r.top;
  return SetFinite(r, ToFloat(r.top[-1]) + ToFloat(r.top[0]));
}

RONDO_INSTRUCTION RunSubFloat(Registers& r, const Instruction&) {
  --r.top;
  return SetFinite(r, ToFloat(r.top[-1]) - ToFloat(r.top[0]));
}

RONDO_INSTRUCTION RunMulFloat(Registers& r, const Instruction&) {
  --r.top;
  return SetFinite(r, ToFloat(r.top[-1]) * ToFloat(r.top[0]));
}

RONDO_INSTRUCTION RunDivFloat(Registers& r, const Instruction&) {
  --r.top;
  const double divisor = ToFloat(r.top[0]);
  if (divisor == 0) {
    RONDO_TOTAL(Division);
    r.top[-1] = 0;
    return Fault::kNone;
  }
  return SetFinite(r, ToFloat(r.top[-1]) / divisor);
}

RONDO_INSTRUCTION RunNegFloat(Registers& r, const Instruction&) {
  r.top[-1] = FloatWord(-ToFloat(r.top[-1]));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunAbsFloat(Registers& r, const Instruction&) {
  r.top[-1] = FloatWord(std::fabs(ToFloat(r.top[-1])));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSqrtFloat(Registers& r, const Instruction&) {
  const double x = ToFloat(r.top[-1]);
  if (x < 0) {
    RONDO_TOTAL(Root);
    r.top[-1] = 0;
    return Fault::kNone;
  }
  r.top[-1] = FloatWord(std::sqrt(x));
  return Fault::kNone;
}

// Made of operations that are rounded alike everywhere, which `std::hypot` is not.
RONDO_INSTRUCTION RunHypotFloat(Registers& r, const Instruction&) {
  --r.top;
  const double a = ToFloat(r.top[-1]);
  const double b = ToFloat(r.top[0]);
  const double squares = a * a + b * b;
  return SetFinite(r, std::sqrt(squares));
}

/// Replaces the top of the stack by an int; an overflow, if it is beyond 64 bits.
inline Fault SetInteger(Registers& r, double whole) {
  if (!(whole >= -0x1p63 && whole < 0x1p63)) return Fault::kOverflow;
  r.top[-1] = FromInt(static_cast<int64_t>(whole));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunFloorFloat(Registers& r, const Instruction&) {
  return SetInteger(r, std::floor(ToFloat(r.top[-1])));
}

RONDO_INSTRUCTION RunCeilFloat(Registers& r, const Instruction&) {
  return SetInteger(r, std::ceil(ToFloat(r.top[-1])));
}

RONDO_INSTRUCTION RunRoundFloat(Registers& r, const Instruction&) {
  return SetInteger(r, std::round(ToFloat(r.top[-1])));
}

RONDO_INSTRUCTION RunSignFloat(Registers& r, const Instruction&) {
  const double x = ToFloat(r.top[-1]);
  r.top[-1] = FromInt(x > 0 ? 1 : x < 0 ? -1 : 0);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunToFloat(Registers& r, const Instruction&) {
  r.top[-1] = FromFloat(static_cast<double>(ToInt(r.top[-1])));
  return Fault::kNone;
}

}  // namespace rondo::koord::semantics
