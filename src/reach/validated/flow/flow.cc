#include "reach/validated/flow/flow.h"

#include <algorithm>
#include <cmath>

#include "reach/validated/series/bound.h"

namespace rondo::reach {

namespace {

// How far errors may be beyond the tolerance of a degree before many more monomials are worth it. Laub-Loomis
// takes half the time for 0.3 % of width (./dev bench reach).
constexpr double kPatience = 8;

FlowOptions Chosen(FlowOptions options, size_t symbols) {
  if (options.order == 0) options.order = symbols == 0 ? 20 : 8;
  return options;
}

}  // namespace

Flow::Flow(const Dynamics& dynamics, std::shared_ptr<Monomials> monomials, FlowOptions options,
           double horizon)
    : options_(Chosen(options, monomials->symbols())),
      horizon_(horizon),
      stepper_(dynamics, std::move(monomials), options_.order,
               options.generators_per_state * static_cast<Eigen::Index>(dynamics.states)),
      h_(options.first_step) {}

void Flow::Start(FlowSet set, double time) {
  set_ = std::move(set);
  time_ = begin_ = time;
  const size_t least = stepper_.monomials().symbols() == 0 ? 0 : options_.least_degree;
  if (set_.degree < least) {
    stepper_.monomials().Extend(least);
    set_.Raise(stepper_.monomials(), least);
  }
}

// Is the next degree worth its time, when errors are so many times what they should be? Many monomials take
// long.
bool Flow::IsWorthIt(double excess) const {
  const size_t degree = set_.degree + 1;
  if (excess <= 1 || degree > options_.most_degree) return false;
  double count = 1;
  for (size_t d = 1; d <= degree; ++d)
    count *= static_cast<double>(stepper_.monomials().symbols() + d) / static_cast<double>(d);
  if (count > static_cast<double>(options_.most_monomials)) return false;
  return excess > kPatience || count <= static_cast<double>(options_.cheap_monomials);
}

bool Flow::Step(double until) {
  const double left = until - time_;
  double h = std::min({h_, options_.most_step, left});
  // No crumbs at the end.
  if (h < left && left < 1.5 * h) h = left * 0.5;
  const size_t n = set_.dimension;
  while (true) {
    if (!stepper_.Advance(set_, h, std::min(options_.least_step, left), options_.order)) return false;
    h = stepper_.h();
    stepper_.Finish(set_, next_);
    // How the errors of the step compare with what it may add.
    if (stepper_.HoldsKinks() && h > 1e-4 * horizon_ && h > 4 * options_.least_step) {
      // What is held for a step costs the square of its length: short steps across kinks.
      bool rough = false;
      for (size_t i = 0; i < n; ++i)
        rough = rough || stepper_.InputError(i) >
                             0.02 * 0.5 * RangeOf(stepper_.monomials(), set_.Polynomial(i)).Width();
      if (rough) {
        h *= 0.5;
        continue;
      }
    }
    double series = 0;
    double degree = 0;
    double linear = 0;
    largest_ = 0;
    for (size_t i = 0; i < n; ++i) largest_ = std::fmax(largest_, Magnitude(stepper_.during()[i]));
    for (size_t i = 0; i < n; ++i) {
      const Interval start = RangeOf(stepper_.monomials(), set_.Polynomial(i));
      const double radius = start.Width() * 0.5;
      const double magnitude = Magnitude(start) + 1e-6 * largest_;
      const double share = h / horizon_;
      const double least = std::fmax(share * options_.floor, 4e-16) * magnitude + 0x1p-900;
      series =
          std::fmax(series, stepper_.SeriesError(i) / (share * options_.series_tolerance * radius + least));
      linear =
          std::fmax(linear, stepper_.LinearError(i) / (share * options_.linear_tolerance * radius + least));
      // Rounding does not fall with the degree.
      degree = std::fmax(degree, stepper_.DegreeError(i) /
                                     (share * options_.degree_tolerance * radius + least + 1e-14 * largest_));
    }

    if (!(series < 1e300)) return false;
    double factor = std::clamp(
        0.9 * std::pow(std::fmax(series, 1e-12), -1.0 / static_cast<double>(options_.order + 1)), 0.3, 1.5);
    // Errors of the linear part fall with the length of steps, but only in proportion: they set the next
    // step.
    if (linear > 1 && h > horizon_ * 1e-3) factor = std::fmin(factor, std::fmax(0.7, 1 / linear));
    if (series > 2 && h * factor > options_.least_step) {
      h *= factor;
      continue;
    }
    if (stepper_.monomials().symbols() > 0 && IsWorthIt(degree)) {
      stepper_.monomials().Extend(set_.degree + 1);
      set_.Raise(stepper_.monomials(), set_.degree + 1);
      calm_ = 0;
      continue;
    }
    const bool last = h >= left;
    begin_ = time_;
    time_ = last ? until : time_ + h;
    // A step that was cut short says nothing about longer ones.
    if (!(last && h < h_)) h_ = h * factor;
    std::swap(set_, next_);
    ++steps_;
    ++since_event_;
    if (last) {
      Settle(set_, until);
      since_event_ = 0;
    }
    AdaptDegree();
    return true;
  }
}

// The instant that is meant differs from the sum of the steps by roundings: what the flow does meanwhile.
void Flow::Settle(FlowSet& set, double time) const {
  const double late = static_cast<double>(since_event_ + 4) * 0x1p-50 * std::fabs(time);
  for (size_t i = 0; i < set.dimension; ++i)
    set.slack[i] = Above(set.slack[i] + late * Magnitude(stepper_.Rate(i)));
}

void Flow::AdaptDegree() {
  if (set_.degree <= options_.least_degree) return;
  // Dropping the top degree costs once what is in it, and later what it would have kept from being cut off.
  if (++calm_ < 10) return;
  calm_ = 0;
  double worst = 0;
  for (size_t i = 0; i < set_.dimension; ++i) {
    const Interval range = RangeOf(stepper_.monomials(), set_.Polynomial(i));
    const double allowed =
        0.05 * options_.degree_tolerance * (stepper_.h() / horizon_) * range.Width() * 0.5 +
        1e-15 * largest_ + 0x1p-900;
    worst = std::fmax(worst, set_.Top(stepper_.monomials(), i) / allowed);
  }
  if (worst < 1) set_.Lower(stepper_.monomials(), set_.degree - 1);
}

interval::Box Flow::Now() const {
  interval::Box box(set_.dimension);
  for (size_t i = 0; i < box.size(); ++i) {
    const double error = set_.Error(i);
    box[i] = RangeOf(stepper_.monomials(), set_.Polynomial(i)) + Interval{-error, error};
  }
  return box;
}

}  // namespace rondo::reach
