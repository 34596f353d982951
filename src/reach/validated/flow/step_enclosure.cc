#include <algorithm>
#include <cmath>

#include "reach/validated/flow/stepper.h"
#include "reach/validated/series/bound.h"

namespace rondo::reach {

namespace {

bool Inside(Interval inner, Interval outer) { return outer.lo < inner.lo && inner.hi < outer.hi; }

}  // namespace

// The polynomials of the states during [0, h], without their errors. False if one is not finite.
bool Stepper::RangeSeries(double h) {
  const Interval time{0, h};
  for (size_t i = 0; i < states_; ++i) {
    Interval sum = ranges_[i * (order_ + 1) + order_];
    for (size_t k = order_; k-- > 0;) sum = sum * time + ranges_[i * (order_ + 1) + k];
    series_[i] = sum;
    if (!std::isfinite(sum.lo) || !std::isfinite(sum.hi)) return false;
  }
  return true;
}

// Berz & Makino, step 1: a guess at where the flow is during the step, wider than its polynomials by twice the errors
// and a margin. 5 %: less needs more attempts, more widens derivatives; the constants keep points from staying points.
void Stepper::GuessBox() {
  for (size_t i = 0; i < states_; ++i) {
    const Interval b = series_[i] + Around(2 * error_[static_cast<Eigen::Index>(i)]);
    box_[i] = b + Around(0.05 * b.Width() + 1e-14 * Magnitude(b) + 0x1p-900);
  }
}

// What did not fit, with a tenth around it: attempts grow geometrically.
void Stepper::GrowBox() {
  for (size_t i = 0; i < states_; ++i) {
    const Interval b = interval::Hull(during_[i], series_[i]);
    box_[i] = b + Around(0.1 * b.Width() + 1e-14 * Magnitude(b) + 0x1p-900);
  }
}

// The branches that the series used must hold on the whole box; if they do not, the series is made again. False if it
// cannot be.
bool Stepper::KeepBranches(const FlowSet& set, double h) {
  const Program& p = dynamics_.program;
  const std::vector<Branch> used = branches_;
  const std::vector<Interval> before = held_;
  Decide(box_);
  bool same = true;
  for (const uint32_t k : p.kinks) {
    same =
        same && used[k] == branches_[k] && (branches_[k] != Branch::kEither || before[k].Contains(held_[k]));
    if (used[k] == branches_[k] && before[k].Contains(held_[k])) held_[k] = before[k];
  }
  if (same) return true;
  for (const uint32_t k : p.kinks) {
    if (branches_[k] == Branch::kEither) held_[k] = held_[k] + Around(0.1 * held_[k].Width() + 0x1p-900);
  }
  return Series(set, order_) && RangeSeries(h);
}

// The Taylor coefficients on the box, for nominal inputs: the last of them bounds what the polynomials leave out.
bool Stepper::EncloseRest() {
  const Program& p = dynamics_.program;
  for (size_t i = 0; i < states_; ++i) rest_.SetVariable(i, 0, box_[i]);
  for (size_t w = 0; w < dynamics_.inputs.size(); ++w) {
    for (size_t k = 0; k <= order_; ++k)
      rest_.SetVariable(states_ + w, k, Interval::Point(k == 0 ? dynamics_.inputs[w].Middle() : 0));
  }
  nominal_ = held_;
  for (const uint32_t k : p.kinks) nominal_[k] = Interval::Point(held_[k].Middle());
  for (size_t k = 0; k <= order_; ++k) {
    if (!rest_.Compute(k, branches_, nominal_, false, 0, p.core_end)) return false;
    for (size_t i = 0; i < states_; ++i) rest_.SetFromDerivative(i, i, k);
  }
  return true;
}

// The linear part, for all inputs: how errors grow, and how fast inputs and held nodes push the state from its nominal
// trajectory, at most.
bool Stepper::EncloseLinear(double h) {
  const Program& p = dynamics_.program;
  sources_.clear();
  for (const uint32_t k : p.kinks) {
    if (branches_[k] == Branch::kEither) sources_.push_back(k);
  }
  const bool driven = Driven();
  BoxSeries& linear = driven ? wide_ : rest_;
  if (driven) {
    for (size_t i = 0; i < states_; ++i) wide_.SetVariable(i, 0, box_[i]);
    for (size_t w = 0; w < dynamics_.inputs.size(); ++w)
      wide_.SetVariable(states_ + w, 0, dynamics_.inputs[w]);
    if (!wide_.Compute(0, branches_, held_, false, 0, p.core_end)) return false;
  }
  observed_ = Known::kNot;
  linear.Gradient(core_outputs_, branches_, sources_, false, gradient_, 0, p.core_end);
  const size_t width = p.variables.size() + sources_.size();
  rates_.resize(states_ * states_);
  for (size_t i = 0; i < states_; ++i)
    std::copy_n(gradient_.begin() + static_cast<std::ptrdiff_t>(i * width), states_,
                rates_.begin() + static_cast<std::ptrdiff_t>(i * states_));
  Propagate(rates_, states_, h, transition_);
  push_.setZero(static_cast<Eigen::Index>(states_));
  for (size_t i = 0; i < states_ && driven; ++i) {
    double sum = 0;
    for (size_t v = states_; v < width; ++v) {
      const size_t w = v - states_;
      const double radius = w < dynamics_.inputs.size()
                                ? RadiusOf(dynamics_.inputs[w])
                                : RadiusOf(held_[sources_[w - dynamics_.inputs.size()]]);
      sum += Magnitude(gradient_[i * width + v]) * radius;
    }
    push_[static_cast<Eigen::Index>(i)] = Above(sum);
  }
  return true;
}

// Polynomials, what they leave out, and errors: where the flow is during the step, if it stays in the box. Nothing if
// that is not finite.
std::optional<bool> Stepper::StaysInside(double h) {
  drift_ = (transition_.growth * (error_ + h * push_)).unaryExpr([](double x) { return Above(x); });
  bool inside = true;
  for (size_t i = 0; i < states_; ++i) {
    during_[i] = series_[i] + Rest(dynamics_.program.variable_nodes[i], h) +
                 Around(drift_[static_cast<Eigen::Index>(i)]);
    if (!std::isfinite(during_[i].lo) || !std::isfinite(during_[i].hi)) return std::nullopt;
    inside = inside && Inside(during_[i], box_[i]);
  }
  return inside;
}

// What inputs and held nodes add to the errors by the end of the step.
void Stepper::SumInputErrors(double h) {
  for (size_t i = 0; i < states_; ++i) {
    double sum = 0;
    for (size_t j = 0; j < states_ && Driven(); ++j)
      sum += transition_.growth(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
             push_[static_cast<Eigen::Index>(j)];
    input_error_[i] = Driven() ? Above(h * sum) : 0;
  }
}

// Is there a box that the flow cannot leave within h? Then every term is enclosed on it. A box that is not found in
// eight attempts is not found by more: the step is too long.
bool Stepper::Try(const FlowSet& set, double h) {
  if (!RangeSeries(h)) return false;
  GuessBox();
  for (int attempt = 0; attempt < 8; ++attempt) {
    if (!dynamics_.program.kinks.empty() && !KeepBranches(set, h)) return false;
    if (!EncloseRest() || !EncloseLinear(h)) return false;
    const auto inside = StaysInside(h);
    if (!inside) return false;
    if (*inside) {
      SumInputErrors(h);
      return true;
    }
    GrowBox();
  }
  return false;
}

}  // namespace rondo::reach
