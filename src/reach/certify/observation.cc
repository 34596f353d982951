#include "reach/certify/observation.h"

#include <cmath>

#include "reach/certify/acceleration.h"
#include "reach/problem/bounds.h"
#include "verdict/truth.h"

namespace rondo::reach::certify {

namespace {

constexpr int kMostSlices = 6;  // halvings of a step, for a claim

}  // namespace

Interval SlopeOf(const OnBox& slopes, size_t output, size_t width, const interval::Box& rates) {
  Interval sum = Interval::Point(0);
  for (size_t v = 0; v < width; ++v) {
    const Interval slope = slopes.slopes[output * width + v];
    if (slope == Interval::Point(0)) continue;
    if (v >= rates.size()) return {};
    sum = sum + slope * rates[v];
  }
  return sum;
}

Observation::Observation(const ModeSystem& in, const Step& step)
    : in_(in), step_(step), coarse_(ValuesOn(in.observed, step.region())) {}

Interval Observation::Range(size_t output, double from, double to) {
  const uint32_t node = in_.observed.outputs[output];
  if (!tried_) {
    tried_ = true;
    OnBox on;
    if (Linearise(in_.observed, step_.region(), 0, on))
      models_ = Evaluate(in_.observed, step_.algebra(), step_.during(), on);
  }
  if (!models_) return coarse_[node];
  return interval::Meet(step_.algebra().Range((*models_)[node], from, to), coarse_[node]);
}

const OnBox* Observation::Slopes() {
  if (!slopes_ && !no_slopes_) {
    slopes_.emplace();
    no_slopes_ = !Linearise(in_.observed, step_.region(), in_.observed.outputs.size(), *slopes_);
  }
  return no_slopes_ ? nullptr : &*slopes_;
}

bool Observation::IsFalse(const ModeGuard& guard) {
  const auto coarse = [&](size_t atom) { return coarse_[in_.observed.outputs[guard.first + atom]]; };
  if (guard.formula.Check(coarse) == verdict::Truth::kFalse) return true;
  return guard.formula.Check([&](size_t atom) { return Range(guard.first + atom, 0, 1); }) ==
         verdict::Truth::kFalse;
}

std::function<Interval(size_t)> Observation::RangesOf(const ModeGuard& guard) {
  return [this, first = guard.first](size_t atom) { return Range(first + atom, 0, 1); };
}

bool Observation::Holds(const ModeClaim& claim, const std::vector<bool>& below) {
  const auto known = [&](size_t atom, Interval range) { return below[atom] ? AtMostZero(range) : range; };
  const auto coarse = [&](size_t atom) {
    return known(atom, coarse_[in_.observed.outputs[claim.first + atom]]);
  };
  if (claim.formula.Check(coarse) == verdict::Truth::kTrue) return true;
  // Slices of the step's time, until it is shown on each.
  std::vector<std::pair<double, double>> open{{0, 1}};
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    const auto range = [from = begin, to = end, &known, &claim, this](size_t atom) {
      return known(atom, Range(claim.first + atom, from, to));
    };
    if (claim.formula.Check(range) == verdict::Truth::kTrue) continue;
    if (end - begin < std::ldexp(1.5, -kMostSlices)) return false;
    const double middle = 0.5 * (begin + end);
    open.emplace_back(middle, end);
    open.emplace_back(begin, middle);
  }
  return true;
}

Interval Observation::Slope(size_t output) {
  const OnBox* slopes = Slopes();
  if (slopes == nullptr) return {};
  return SlopeOf(*slopes, output, in_.observed.variables.size(), step_.rates());
}

Interval Observation::Acceleration(size_t output) {
  if (accelerations_.empty()) accelerations_ = Accelerations(in_.dynamics, in_.observed, step_.region());
  return accelerations_[output];
}

bool Observation::StaysBelow(size_t output) {
  if (Slope(output).hi <= 0) return true;
  const OnBox* on = Slopes();
  if (on == nullptr) return false;
  const Program& rates = in_.dynamics.rates;
  const size_t width = in_.observed.variables.size();
  std::vector<LinearPart> parts;  // of g', if g is linear
  for (size_t v = 0; v < width; ++v) {
    const Interval slope = on->slopes[output * width + v];
    if (!slope.IsPoint() || (v >= in_.dynamics.states && slope.lo != 0)) return false;
    if (slope.lo != 0) parts.push_back({slope.lo, 0, rates.outputs[v]});
  }
  const Algebra& algebra = step_.algebra();
  OnBox on_rates;
  if (!Linearise(rates, step_.region(), 0, on_rates)) return false;
  const auto f = Evaluate(rates, algebra, step_.during(), on_rates);
  Range(output, 0, 1);
  if (!f || !models_) return false;
  const LinearPart none{0, 0, 0};
  const Model& g = (*models_)[in_.observed.outputs[output]];
  const Model rate = algebra.Linear(parts, none, *f);
  double along = 0;
  double square = 0;
  const size_t powers = algebra.order() + 1;
  for (size_t m = 1; m < algebra.basis().size(); ++m) {
    along += rate.polynomial[m * powers] * g.polynomial[m * powers];
    square += g.polynomial[m * powers] * g.polynomial[m * powers];
  }
  const double r = square > 0 ? along / square : 0;
  if (!std::isfinite(r)) return false;
  const std::vector<LinearPart> both{{1, 0, 0}, {-r, 0, 1}};
  return algebra.Range(algebra.Linear(both, none, {rate, g}), 0, 1).hi <= 0;
}

}  // namespace rondo::reach::certify
