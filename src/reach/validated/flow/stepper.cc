#include "reach/validated/flow/stepper.h"

#include <algorithm>
#include <cmath>

#include "reach/validated/series/bound.h"

namespace rondo::reach {

Stepper::Stepper(const Dynamics& dynamics, std::shared_ptr<Monomials> monomials, size_t max_order,
                 Eigen::Index capacity)
    : dynamics_(dynamics),
      monomials_(std::move(monomials)),
      states_(dynamics.states),
      capacity_(capacity),
      models_(dynamics.program, monomials_, max_order + 1),
      rest_(dynamics.program, max_order + 2),
      wide_(dynamics.program, 1),
      branches_(dynamics.program.code.size(), Branch::kEither),
      held_(dynamics.program.code.size()),
      ranges_(dynamics.states * (max_order + 2)),
      series_(dynamics.states),
      box_(dynamics.states),
      during_(dynamics.states),
      error_(static_cast<Eigen::Index>(dynamics.states)),
      drift_(static_cast<Eigen::Index>(dynamics.states)),
      input_error_(dynamics.states),
      series_error_(dynamics.states),
      degree_error_(dynamics.states),
      linear_error_(dynamics.states) {
  const auto& outputs = dynamics.program.outputs;
  core_outputs_.assign(outputs.begin(), outputs.begin() + static_cast<std::ptrdiff_t>(states_));
}

// Which branches hold on this box; what cannot be told is held at an interval.
void Stepper::Decide(const interval::Box& box) {
  const Program& p = dynamics_.program;
  for (size_t i = 0; i < states_; ++i) wide_.SetVariable(i, 0, box[i]);
  for (size_t w = 0; w < dynamics_.inputs.size(); ++w) wide_.SetVariable(states_ + w, 0, dynamics_.inputs[w]);
  if (wide_.Decide(branches_, held_)) return;
  for (const uint32_t k : p.kinks) {
    branches_[k] = Branch::kEither;
    held_[k] = {};
  }
}

bool Stepper::Series(const FlowSet& set, size_t order) {
  const Program& p = dynamics_.program;
  models_.Begin(set.degree, order);
  for (size_t i = 0; i < states_; ++i) models_.SetVariable(i, 0, set.Polynomial(i), 0);
  for (size_t w = 0; w < dynamics_.inputs.size(); ++w) {
    const double middle = dynamics_.inputs[w].Middle();
    for (size_t k = 0; k <= order; ++k)
      models_.SetVariable(states_ + w, k, std::span(&middle, k == 0 ? 1U : 0U), 0);
  }
  for (size_t k = 0; k < order; ++k) {
    if (!models_.Compute(k, branches_, held_, 0, p.core_end)) return false;
    for (size_t i = 0; i < states_; ++i) models_.SetFromDerivative(i, i, k);
  }
  for (size_t i = 0; i < states_; ++i) {
    for (size_t k = 0; k <= order; ++k) ranges_[i * (order + 1) + k] = models_.Range(p.variable_nodes[i], k);
  }
  return true;
}

bool Stepper::Advance(const FlowSet& set, double h, double least, size_t order) {
  order_ = order;
  for (size_t i = 0; i < states_; ++i) error_[static_cast<Eigen::Index>(i)] = set.Error(i);
  if (!Begin(set)) return false;
  while (h >= least) {
    if (Try(set, h)) {
      h_ = h;
      return true;
    }
    h *= 0.5;
    // Branches may have been decided for a larger step.
    if (!dynamics_.program.kinks.empty() && !Begin(set)) return false;
  }
  return false;
}

// The series from the set, with the branches that hold where it is.
bool Stepper::Begin(const FlowSet& set) {
  if (!dynamics_.program.kinks.empty()) {
    for (size_t i = 0; i < states_; ++i)
      during_[i] =
          RangeOf(*monomials_, set.Polynomial(i)) + Around(error_[static_cast<Eigen::Index>(i)] * 1.01);
    Decide(during_);
  }
  return Series(set, order_);
}

// t^(K+1) times the last coefficient, for t in [0, to].
Interval Stepper::Rest(size_t node, double to) const {
  Interval power = Interval::Point(1);
  for (size_t k = 0; k <= order_; ++k) power = power * Interval::Point(to);
  return Interval{0, power.hi} * rest_.Of(node, order_ + 1);
}

void Stepper::Finish(const FlowSet& set, FlowSet& next) {
  const Program& p = dynamics_.program;
  next.dimension = set.dimension;
  next.degree = set.degree;
  next.count = set.count;
  next.polynomials.assign(set.polynomials.size(), 0.0);
  next.generators = set.generators;
  next.used = set.used;
  next.slack = set.slack;
  std::vector<double> errors(states_);
  const size_t count = set.count;
  for (size_t i = 0; i < states_; ++i) {
    const size_t node = p.variable_nodes[i];
    auto out = next.Polynomial(i);
    const auto top = models_.At(node, order_);
    std::copy(top.polynomial.begin(), top.polynomial.end(), out.begin());
    double radius = top.radius;
    double size = 0;  // at least the norm of the sum so far
    for (const double c : top.polynomial) size += std::fabs(c);
    double rounded = 0;  // running error of Horner's scheme, in units of kHalfUlp
    for (size_t k = order_; k-- > 0;) {
      const auto c = models_.At(node, k);
      double norm = 0;
      for (size_t m = 0; m < count; ++m) {
        out[m] = out[m] * h_ + c.polynomial[m];
        norm += std::fabs(c.polynomial[m]);
      }
      radius = Above(radius * h_ + c.radius);
      const double product = size * h_;
      size = product + norm;
      rounded = rounded * h_ + product + size;
    }
    degree_error_[i] =
        Above(radius + rounded * Roundings(1) + static_cast<double>(count * order_) * 0x1p-1070);
    // The rest of the series: its middle belongs to the polynomial.
    Interval power = Interval::Point(1);
    for (size_t k = 0; k <= order_; ++k) power = power * Interval::Point(h_);
    const Interval rest = power * rest_.Of(node, order_ + 1);
    double middle = rest.Middle();
    if (std::fabs(middle) < kHalfUlp * std::fabs(out[0])) middle = 0;
    const double sum = out[0] + middle;
    series_error_[i] = Above(std::fmax(rest.hi - middle, middle - rest.lo));
    if (middle != 0) degree_error_[i] = Above(degree_error_[i] + std::fabs(sum) * Roundings(1));
    out[0] = sum;
    double linear = 0;
    for (size_t j = 0; j < states_; ++j)
      linear += transition_.radius(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
                error_[static_cast<Eigen::Index>(j)];
    linear_error_[i] = Above(linear);
    errors[i] = Above(degree_error_[i] + series_error_[i] + linear_error_[i] + input_error_[i]);
  }
  next.Transform(transition_.centre, errors, capacity_);
}

Interval Stepper::StateAt(size_t state, std::span<const double> symbols, double t) const {
  const size_t node = dynamics_.program.variable_nodes[state];
  const Interval time = Interval::Point(t);
  Interval sum = Interval::Point(0);
  for (size_t k = order_ + 1; k-- > 0;) {
    const auto model = models_.At(node, k);
    Interval value = Around(model.radius);
    for (size_t m = 0; m < model.polynomial.size(); ++m) {
      Interval term = Interval::Point(model.polynomial[m]);
      const auto e = monomials_->Exponents(m);
      for (size_t s = 0; s < e.size(); ++s) {
        for (size_t r = 0; r < e[s]; ++r) term = term * Interval::Point(symbols[s]);
      }
      value = value + term;
    }
    sum = sum * time + value;
  }
  return sum + Rest(node, t) + Around(drift_[static_cast<Eigen::Index>(state)]);
}

}  // namespace rondo::reach
