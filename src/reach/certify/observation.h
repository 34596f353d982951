#pragma once

#include "reach/certify/system.h"
#include "verdict/truth.h"

/// Claims and events during one step, for the checker.
namespace rondo::reach::certify {

/// Tells what the terms of claims and events are during a step. Computes what is asked for, once. Times of a
/// step run from 0 to 1.
class Observation {
 public:
  Observation(const ModeSystem& in, const Step& step);

  /// Reports whether the condition is certainly false at all times of the step.
  bool IsFalse(const ModeGuard& guard);
  /// Returns what the terms of the condition are during the step: by atom, enclosures.
  std::function<Interval(size_t)> RangesOf(const ModeGuard& guard);
  /// Reports whether the claim holds at all times of the step, for sure. `below`: terms that are known to be
  /// at most zero.
  bool Holds(const ModeClaim& claim, const std::vector<bool>& below);
  /// Reports whether a term that is at most zero when the step begins stays so, for sure. If g' <= r g along
  /// every trajectory, for some number r, then g(t) <= exp(r t) g(0) (Gronwall).
  bool StaysBelow(size_t output);
  /// Encloses the derivative of a term, per second; everything if it depends on inputs, which jump.
  Interval Slope(size_t output);
  /// Encloses its second derivative, per second squared; everything unless that exists, and the first one is
  /// continuous.
  Interval Acceleration(size_t output);

 private:
  Interval Range(size_t output, double from, double to);
  const OnBox* Slopes();

  const ModeSystem& in_;
  const Step& step_;
  std::vector<Interval> coarse_;  ///< by node
  bool tried_ = false;
  std::optional<std::vector<Model>> models_;
  std::optional<OnBox> slopes_;
  bool no_slopes_ = false;
  std::vector<Interval> accelerations_;
};

/// Reports whether the condition holds for sure, and by more than a touch: what is zero may hold for this
/// instant only, and do nothing.
///
/// @param range  of the condition's terms.
template <typename Range>
bool HoldsOn(const ModeGuard& guard, const Range& range) {
  const verdict::Truth truth = guard.formula.Check([&](size_t atom) {
    const Interval r = range(atom);
    return r.hi == 0 ? Interval{r.lo, 0x1p-1000} : r;
  });
  return truth == verdict::Truth::kTrue;
}

/// Cuts the range of a term that is known to be at most zero.
inline Interval AtMostZero(Interval range) { return {std::fmin(range.lo, 0), std::fmin(range.hi, 0)}; }

/// Encloses the derivative of a term along the flow, per second, where states and inputs are in a box.
///
/// @param slopes  the terms on the box; @param rates  what the derivatives of the states can be.
Interval SlopeOf(const OnBox& slopes, size_t output, size_t width, const interval::Box& rates);

}  // namespace rondo::reach::certify
