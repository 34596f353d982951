#pragma once

#include "koord/semantics/machine/numbers.h"

/// Carries out arithmetic on points, which are three doubles, x deepest.
namespace rondo::koord::semantics {

RONDO_INSTRUCTION RunSplat(Registers& r, const Instruction&) {
  r.top[0] = r.top[1] = r.top[-1];
  r.top += 2;
  return Fault::kNone;
}

/// Pops two points and pushes the one whose coordinates `operation` makes of theirs; an overflow, if one is
/// not finite.
template <typename Operation>
inline Fault Coordinates(Registers& r, Operation operation) {
  r.top -= 3;
  for (int k = 0; k < 3; ++k) {
    const double value = operation(ToFloat(r.top[k - 3]), ToFloat(r.top[k]));
    if (!std::isfinite(value)) return Fault::kOverflow;
    r.top[k - 3] = FloatWord(value);
  }
  return Fault::kNone;
}

RONDO_INSTRUCTION RunAddPos(Registers& r, const Instruction&) {
  return Coordinates(r, [](double a, double b) { return a + b; });
}

RONDO_INSTRUCTION RunSubPos(Registers& r, const Instruction&) {
  return Coordinates(r, [](double a, double b) { return a - b; });
}

RONDO_INSTRUCTION RunMulPos(Registers& r, const Instruction&) {
  return Coordinates(r, [](double a, double b) { return a * b; });
}

RONDO_INSTRUCTION RunMidPos(Registers& r, const Instruction&) {
  return Coordinates(r, [](double a, double b) { return (a + b) / 2; });
}

RONDO_INSTRUCTION RunDivPos(Registers& r, const Instruction&) {
  for (int k = 1; k <= 3; ++k) {
    if (ToFloat(r.top[-k]) == 0) RONDO_TOTAL(Division);
  }
  return Coordinates(r, [](double a, double b) { return b == 0 ? 0 : a / b; });
}

RONDO_INSTRUCTION RunNegPos(Registers& r, const Instruction&) {
  for (int k = 1; k <= 3; ++k) r.top[-k] = FloatWord(-ToFloat(r.top[-k]));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunDistPos(Registers& r, const Instruction&) {
  r.top -= 5;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = ToFloat(r.top[k - 1]) - ToFloat(r.top[k + 2]);
    sum += d * d;
  }
  return SetFinite(r, std::sqrt(sum));
}

RONDO_INSTRUCTION RunInRect(Registers& r, const Instruction&) {
  r.top -= 8;
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const double p = ToFloat(r.top[k - 1]);
    inside = inside && ToFloat(r.top[k + 2]) <= p && p <= ToFloat(r.top[k + 5]);
  }
  r.top[-1] = inside;
  return Fault::kNone;
}

}  // namespace rondo::koord::semantics
