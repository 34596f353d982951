#include <algorithm>
#include <cmath>

#include "reach/validated/flow/stepper.h"
#include "reach/validated/series/bound.h"

namespace rondo::reach {

Interval Stepper::Polynomial(size_t node, double from, double to, bool tight) const {
  const Interval time{from, to};
  if (!tight) {
    Interval sum = models_.Range(node, order_);
    for (size_t k = order_; k-- > 0;) sum = sum * time + models_.Range(node, k);
    return sum;
  }
  // Each monomial's coefficient as a polynomial in time; that of 1 about the middle of the time.
  const size_t count = models_.count();
  Interval sum = Interval::Point(0);
  double radius = 0;
  double power = 1;
  for (size_t k = 0; k <= order_; ++k) {
    radius = Above(radius + models_.At(node, k).radius * power);
    power = Above(power * to);
  }
  const double middle = time.Middle();
  const Interval offset = time - Interval::Point(middle);
  std::vector<Interval> shifted(order_ + 1);
  double up = 0;
  double down = 0;
  for (size_t i = 0; i < count; ++i) {
    bool any = false;
    for (size_t k = 0; k <= order_; ++k) {
      const double c = models_.At(node, k).polynomial[i];
      shifted[k] = Interval::Point(c);
      any = any || c != 0;
    }
    if (!any) continue;
    if (i == 0) {  // Taylor shift
      for (size_t a = 0; a < order_; ++a) {
        for (size_t k = order_; k-- > a;) shifted[k] = shifted[k] + shifted[k + 1] * Interval::Point(middle);
      }
    }
    const Interval t = i == 0 ? offset : time;
    Interval value = shifted[order_];
    for (size_t k = order_; k-- > 0;) value = value * t + shifted[k];
    if (i == 0) {
      sum = value;
    } else if (monomials_->IsEven(i)) {
      up += std::fmax(0, value.hi);
      down += std::fmax(0, -value.lo);
    } else {
      up += Magnitude(value);
      down += Magnitude(value);
    }
  }
  return sum + Interval{-Above(down + radius), Above(up + radius)};
}

bool Stepper::Observe() {
  if (observed_ != Known::kNot) return observed_ == Known::kDefined;
  observed_ = Known::kUndefined;
  const Program& p = dynamics_.program;
  const auto end = static_cast<uint32_t>(p.code.size());
  // The series of the states is known; what is observed follows order by order.
  for (size_t k = 0; k <= order_; ++k) {
    if (!models_.Compute(k, branches_, held_, k == order_ ? 0 : p.core_end, end)) return false;
  }
  for (size_t k = 0; k <= order_ + 1; ++k) {
    if (!rest_.Compute(k, branches_, nominal_, false, k == order_ + 1 ? 0 : p.core_end, end)) return false;
  }
  if (Driven() && !wide_.Compute(0, branches_, held_, false, p.core_end, end)) return false;
  std::vector<uint32_t> outputs(p.outputs.begin() + static_cast<std::ptrdiff_t>(states_), p.outputs.end());
  (Driven() ? wide_ : rest_)
      .Gradient(outputs, branches_, sources_, false, observed_gradient_, p.core_end, end);
  observed_ = Known::kDefined;
  return true;
}

Interval Stepper::Observed(size_t observed, double from, double to, bool tight) {
  const Program& p = dynamics_.program;
  if (!Observe()) return {};
  const size_t node = p.outputs[states_ + observed];
  const size_t width = p.variables.size() + sources_.size();
  double error = 0;
  for (size_t j = 0; j < states_; ++j)
    error += Magnitude(observed_gradient_[observed * width + j]) * drift_[static_cast<Eigen::Index>(j)];
  for (size_t w = 0; w < dynamics_.inputs.size(); ++w)
    error += Magnitude(observed_gradient_[observed * width + states_ + w]) * RadiusOf(dynamics_.inputs[w]);
  for (size_t s = 0; s < sources_.size(); ++s)
    error += Magnitude(observed_gradient_[observed * width + p.variables.size() + s]) *
             RadiusOf(held_[sources_[s]]);
  const Interval enclosed = Polynomial(node, from, to, tight) + Rest(node, to) + Around(Above(error));
  // On the box that holds the step, it may be sharper still.
  return interval::Meet(enclosed, Enclosure().Of(node, 0));
}

Interval Stepper::ObservedRate(size_t observed) {
  if (!Observe()) return {};
  const Program& p = dynamics_.program;
  const size_t width = p.variables.size() + sources_.size();
  // What it depends on besides the states may jump.
  for (size_t v = states_; v < width; ++v) {
    if (observed_gradient_[observed * width + v] != Interval::Point(0)) return {};
  }
  Interval sum = Interval::Point(0);
  for (size_t j = 0; j < states_; ++j)
    sum = sum + observed_gradient_[observed * width + j] * Enclosure().Of(p.outputs[j], 0);
  return sum;
}

Interval Stepper::ObservedSecond(size_t observed) {
  if (!Observe()) return {};
  const Program& p = dynamics_.program;
  const size_t width = p.variables.size() + sources_.size();
  const auto pushed = [&](const std::vector<Interval>& gradient, size_t row) {
    return std::any_of(gradient.begin() + static_cast<std::ptrdiff_t>(row * width + states_),
                       gradient.begin() + static_cast<std::ptrdiff_t>((row + 1) * width),
                       [](Interval d) { return d != Interval::Point(0); });
  };
  if (pushed(observed_gradient_, observed)) return {};
  // The states that it depends on, those that these depend on, and so on.
  std::vector<bool> seen(p.variables.size());
  std::vector<uint32_t> open = p.depends[p.outputs[states_ + observed]];
  while (!open.empty()) {
    const uint32_t v = open.back();
    open.pop_back();
    if (v >= states_ || seen[v]) continue;
    if (pushed(gradient_, v)) return {};
    seen[v] = true;
    open.insert(open.end(), p.depends[p.outputs[v]].begin(), p.depends[p.outputs[v]].end());
  }
  return Interval::Point(2) * rest_.Of(p.outputs[states_ + observed], 2);
}

bool Stepper::StaysBelow(size_t observed) {
  if (!Observe()) return false;
  if (ObservedRate(observed).hi <= 0) return true;
  const Program& p = dynamics_.program;
  const size_t width = p.variables.size() + sources_.size();
  const size_t node = p.outputs[states_ + observed];
  std::vector<double> slope(states_);
  for (size_t v = 0; v < width; ++v) {
    const Interval d = observed_gradient_[observed * width + v];
    if (!d.IsPoint() || (v >= states_ && d.lo != 0)) return false;
    if (v < states_) slope[v] = d.lo;
  }
  // g' as a polynomial in the symbols, by order: sum of slope_j f_j; and g itself.
  const size_t count = models_.count();
  std::vector<std::vector<double>> rate(order_, std::vector<double>(count));
  double norm = 0;
  double radius = 0;
  double power = 1;
  for (size_t k = 0; k < order_; ++k) {
    for (size_t j = 0; j < states_; ++j) {
      if (slope[j] == 0) continue;
      const auto f = models_.At(p.outputs[j], k);
      for (size_t m = 0; m < count; ++m) {
        rate[k][m] += slope[j] * f.polynomial[m];
        norm += std::fabs(slope[j] * f.polynomial[m]) * power;
      }
      radius += std::fabs(slope[j]) * f.radius * power;
    }
    power = Above(power * h_);
  }
  const auto g0 = models_.At(node, 0);
  double along = 0;
  double square = 0;
  for (size_t m = 1; m < count; ++m) {
    along += rate[0][m] * g0.polynomial[m];
    square += g0.polynomial[m] * g0.polynomial[m];
  }
  const double r = square > 0 ? along / square : 0;
  if (!std::isfinite(r)) return false;
  // g' - r g over the step: polynomial part, monomial by monomial.
  const Interval time{0, h_};
  Interval sum = Interval::Point(0);
  double up = 0;
  for (size_t m = 0; m < count; ++m) {
    Interval value = Interval::Point(0);
    for (size_t k = order_; k-- > 0;) {
      const double g = models_.At(node, k).polynomial[m];
      value = value * time + (Interval::Point(rate[k][m]) - Interval::Point(r) * Interval::Point(g));
    }
    if (m == 0) {
      sum = value;
    } else {
      up += monomials_->IsEven(m) ? std::fmax(0, value.hi) : Magnitude(value);
    }
  }
  // Errors: roundings of the sums above, radii, what the series leave out, and how far trajectories are from
  // nominal ones.
  double error = radius + norm * Roundings(static_cast<double>(2 * states_ + 4));
  power = 1;
  for (size_t k = 0; k < order_; ++k) {
    error += std::fabs(r) * models_.At(node, k).radius * power;
    power = Above(power * h_);
  }
  // power = h^K: the last order of g, and the rest of both series.
  error += power * (std::fabs(r) *
                    (Magnitude(models_.Range(node, order_)) + h_ * Magnitude(rest_.Of(node, order_ + 1))));
  for (size_t j = 0; j < states_; ++j) {
    if (slope[j] == 0) continue;
    double off = power * Magnitude(rest_.Of(p.outputs[j], order_)) + push_[static_cast<Eigen::Index>(j)];
    for (size_t i = 0; i < states_; ++i)
      off += Magnitude(rates_[j * states_ + i]) * drift_[static_cast<Eigen::Index>(i)];
    off += std::fabs(r) * drift_[static_cast<Eigen::Index>(j)];
    error += std::fabs(slope[j]) * off;
  }
  return (sum + Interval::Point(Above(up + error))).hi <= 0;
}

}  // namespace rondo::reach
