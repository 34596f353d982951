#include "reach/certify/step.h"

#include <algorithm>
#include <cmath>

namespace rondo::reach::certify {

namespace {

constexpr int kMostAttempts = 14;

Eigen::Index At(size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

Step::Step(const Dynamics& dynamics, size_t order)
    : dynamics_(dynamics),
      order_(order),
      kinks_(!dynamics.rates.kinks.empty() ||
             std::ranges::any_of(dynamics.rates.code, [](const Code& c) { return c.op == CodeOp::kAtan2; })) {
}

interval::Box Step::Ranges() const {
  interval::Box box;
  for (size_t i = 0; i < dynamics_.states; ++i) box.push_back(algebra_->Range(during_[i], 0, 1));
  return box;
}

// The derivatives by the time of the step, but for its length. `lower`: all nodes at the limit before.
std::optional<std::vector<Model>> Step::Rates(const OnBox& on, std::optional<std::vector<Model>>* lower) {
  const bool known = lower != nullptr && *lower && !kinks_;
  auto nodes = Evaluate(dynamics_.rates, *algebra_, during_, on, known ? &**lower : nullptr);
  if (!nodes) return std::nullopt;
  std::vector<Model> rates;
  for (size_t i = 0; i < dynamics_.states; ++i) {
    const Model& f = (*nodes)[dynamics_.rates.outputs[i]];
    rates.push_back(factor_ ? algebra_->Product(*factor_, f) : f);
  }
  if (lower == nullptr) nearby_.nodes = RangesOf(*algebra_, *nodes);
  if (lower != nullptr) *lower = std::move(nodes);
  return rates;
}

// p(s, t): the Picard iteration finds one more power of t each time.
bool Step::Nominal(const ReachSet& set, const OnBox& on) {
  const size_t powers = order_ + 1;
  during_.clear();
  algebra_->Limit(0);
  std::optional<std::vector<Model>> nodes;
  for (const std::vector<double>& p : set.polynomials) during_.push_back(algebra_->InSymbols(p));
  for (const Interval input : dynamics_.inputs) during_.push_back(algebra_->Constant(input));
  for (size_t k = 0; k < order_; ++k) {
    algebra_->Limit(k);
    const auto rates = Rates(on, &nodes);
    if (!rates) return false;
    algebra_->Limit(k + 1);
    for (size_t i = 0; i < dynamics_.states; ++i) {
      const Model& f = (*rates)[i];
      for (size_t m = 0; m < set.basis->size(); ++m) {
        for (size_t a = 0; a <= k; ++a)
          during_[i].polynomial[m * powers + a + 1] =
              length_ * f.polynomial[m * powers + a] / static_cast<double>(a + 1);
      }
      algebra_->Seal(during_[i]);
      if (!std::isfinite(during_[i].norm)) return false;
    }
  }
  return true;
}

// How far p is from solving the equation.
bool Step::Defect(const OnBox& on) {
  const size_t powers = order_ + 1;
  const auto rates = Rates(on, nullptr);
  if (!rates) return false;
  push_.by_power.assign(powers, Eigen::VectorXd::Zero(At(dynamics_.states)));
  for (size_t i = 0; i < dynamics_.states; ++i) {
    const Model& f = (*rates)[i];
    const Model& p = during_[i];
    for (size_t a = 0; a < powers; ++a) {
      const double k = static_cast<double>(a) + 1;
      double sum = 0;
      double sizes = 0;
      for (size_t m = 0; m < algebra_->basis().size(); ++m) {
        const double rate = length_ * f.polynomial[m * powers + a];
        const double slope = a + 1 < powers ? k * p.polynomial[m * powers + a + 1] : 0;
        sum += std::fabs(rate - slope);
        sizes += std::fabs(rate) + std::fabs(slope);
      }
      push_.by_power[a][At(i)] = Up(sum + Gamma(4) * sizes);
    }
    push_.by_power[0][At(i)] = Up(push_.by_power[0][At(i)] + length_ * f.error);
  }
  return true;
}

// How errors go on, if they stay where `on` is known.
bool Step::Bound(const ReachSet& set, const OnBox& on, ErrorFlow& flow) const {
  const size_t n = dynamics_.states;
  const size_t width = dynamics_.rates.variables.size();
  ErrorRates rates;
  rates.centre.resize(At(n), At(n));
  rates.radius.resize(At(n), At(n));
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      const Interval slope = span_ * on.slopes[i * width + j];
      rates.centre(At(i), At(j)) = slope.Middle();
      rates.radius(At(i), At(j)) = Radius(slope);
    }
  }
  return PropagateErrors(rates, set.generators, push_, flow);
}

bool Step::Take(const ReachSet& set, const Pace& pace) {
  const size_t n = dynamics_.states;
  algebra_.emplace(*set.basis, order_);
  length_ = pace.length;
  factor_.reset();
  span_ = Interval::Point(length_);
  if (!pace.polynomial.empty()) {
    factor_ = algebra_->InSymbols(pace.polynomial);
    factor_->error = pace.error;
    span_ = span_ * algebra_->Bounds(*factor_);
    if (!(span_.lo >= 0)) return false;
  }
  const Eigen::VectorXd errors = set.Errors();
  // The box on which everything is looked at; it grows until the flow stays inside.
  interval::Box box = set.Box();
  box.insert(box.end(), dynamics_.inputs.begin(), dynamics_.inputs.end());
  OnBox on;
  if (!Linearise(dynamics_.rates, box, n, on)) return false;
  if (kinks_) {
    for (size_t i = 0; i < n; ++i) {
      const Interval reached = box[i] + Interval{0, span_.hi} * on.values[dynamics_.rates.outputs[i]];
      box[i] = interval::Hull(box[i], reached);
    }
    if (!Linearise(dynamics_.rates, box, n, on)) return false;
  }
  bool known = false;
  Eigen::VectorXd room = 1.2 * errors;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    if (!known) {
      if (!Nominal(set, on)) return false;
      // Without kinks, the box does not matter for p.
      if (!kinks_ && !Defect(on)) return false;
      known = !kinks_;
    }
    const interval::Box ranges = Ranges();
    for (size_t i = 0; i < n; ++i) {
      const double more = room[At(i)] + 1e-15 * Magnitude(ranges[i]) + 0x1p-900;
      box[i] = ranges[i] + Around(more);
      if (!IsFinite(box[i])) return false;
    }
    if (kinks_ && (!Linearise(dynamics_.rates, box, n, on) || !Defect(on))) return false;
    nearby_.errors = room;
    for (size_t i = 0; i < n; ++i)
      nearby_.errors[At(i)] = Up(room[At(i)] + 2e-15 * Magnitude(ranges[i]) + 0x1p-899);
    if (!Linearise(dynamics_.rates, box, n, on, &nearby_)) return false;
    ErrorFlow flow;
    if (!Bound(set, on, flow)) return false;
    bool inside = true;
    for (size_t i = 0; i < n; ++i) {
      const Interval reached = ranges[i] + Around(flow.most[At(i)]);
      inside = inside && box[i].lo < reached.lo && reached.hi < box[i].hi;
      room[At(i)] = std::fmax(room[At(i)], 1.3 * flow.most[At(i)]);
    }
    if (!inside) continue;
    region_ = box;
    rates_.clear();
    for (size_t i = 0; i < n; ++i) rates_.push_back(on.values[dynamics_.rates.outputs[i]]);
    end_.basis = set.basis;
    end_.generators = std::move(flow.generators);
    added_ = std::move(flow.added);
    end_.polynomials.assign(n, std::vector<double>(set.basis->size()));
    Eigen::VectorXd rounded(At(n));
    for (size_t i = 0; i < n; ++i) {
      for (size_t m = 0; m < set.basis->size(); ++m) {
        const double* c = during_[i].polynomial.data() + m * (order_ + 1);
        double sum = 0;
        for (size_t a = order_ + 1; a-- > 0;) sum += c[a];
        end_.polynomials[i][m] = sum;
      }
      rounded[At(i)] = Up(Gamma(static_cast<double>(order_) + 1) * during_[i].norm);
      during_[i].error = flow.most[At(i)];
    }
    end_.AddErrors(rounded);
    return true;
  }
  return false;
}

}  // namespace rondo::reach::certify
