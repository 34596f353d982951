#include "reach/validated/flow/stepper.h"

#include <algorithm>
#include <cmath>

#include "reach/validated/series/bound.h"

namespace rondo::reach {

namespace {

double RadiusOf(Interval i) { return Above((i.hi - i.lo) * 0.5); }
Interval Around(double radius) { return {-radius, radius}; }
bool Inside(Interval inner, Interval outer) { return outer.lo < inner.lo && inner.hi < outer.hi; }

}  // namespace

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

// t^(K+1) times the last coefficient, for t in [0, to].
Interval Stepper::Rest(size_t node, double to) const {
  Interval power = Interval::Point(1);
  for (size_t k = 0; k <= order_; ++k) power = power * Interval::Point(to);
  return Interval{0, power.hi} * rest_.Of(node, order_ + 1);
}

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
