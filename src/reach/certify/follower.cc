#include "reach/certify/follower.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reach/system/bounds.h"

namespace rondo::reach::certify {

namespace {

constexpr size_t kOrder = 9;        // of polynomials in time
constexpr size_t kPointOrder = 20;  // if the start is a single point
constexpr int kMostSlices = 6;      // halvings of a step, for a claim
constexpr double kLeastStep = 1e-10;
constexpr Eigen::Index kMostColumns = 100;  // for each state

Interval AtMostZero(Interval range) { return {std::fmin(range.lo, 0), std::fmin(range.hi, 0)}; }

}  // namespace

bool Follower::Fail(std::string reason) {
  if (reason_.empty()) reason_ = fmt::format("{}, at {:.6g} s", std::move(reason), time_);
  return false;
}

// A symbol for each side that is not a point; copies of a state share its symbol.
void Follower::Begin(const interval::Box& box) {
  const size_t n = box.size();
  const auto& copies = system_.problem->copy_of;
  std::vector<std::optional<size_t>>& symbol = symbol_;
  symbol.assign(n, std::nullopt);
  symbols_ = 0;
  for (size_t i = 0; i < n; ++i) {
    const double size = Magnitude(box[i]);
    if (i < copies.size() && copies[i]) continue;
    if (box[i].Width() > 1e-13 * size) symbol[i] = symbols_++;
  }
  for (size_t i = 0; i < copies.size(); ++i) {
    if (copies[i]) symbol[i] = symbol[*copies[i]];
  }
  order_ = symbols_ == 0 ? kPointOrder : kOrder;
  set_ = {};
  set_.basis = bases_.Of(symbols_, 1);
  set_.generators.resize(static_cast<Eigen::Index>(n), 0);
  Eigen::VectorXd thin = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  for (size_t i = 0; i < n; ++i) {
    std::vector<double>& p = set_.polynomials.emplace_back(set_.basis->size(), 0.0);
    p[0] = box[i].Middle();
    if (symbol[i]) {
      p[1 + *symbol[i]] = Radius(box[i]);
    } else {
      thin[static_cast<Eigen::Index>(i)] = Radius(box[i]);
    }
  }
  set_.AddErrors(thin);
}

std::string Follower::Run(const interval::Box& part, const std::vector<PartRecord::Step>& steps) {
  if (CheckBox(system_.assumed_terms, system_.assumed, part) == Truth::kFalse) return "";
  if (steps.empty()) return "a part of the initial set has no steps";
  hints_ = &steps;
  Begin(part);
  for (const CompiledClaim& claim : system_.claims) falls_.push_back(claim.starts_below);
  const std::vector<Rational>& instants = system_.instants;
  for (size_t k = 0; k + 1 < instants.size(); ++k) {
    time_ = instants[k].ToDouble();
    if (system_.IsSample(instants[k]) && !Control()) break;
    if (k == 0 && !AtInstant(instants[0], true)) break;
    if (!Segment(instants[k], instants[k + 1])) break;
    if (!AtInstant(instants[k + 1], false)) break;
  }
  return reason_;
}

// What bends the set most.
std::optional<size_t> Follower::WorstSide() const {
  std::vector<double> weight(symbols_);
  for (const std::vector<double>& p : set_.polynomials) {
    double size = 0;
    for (size_t m = 1; m < p.size(); ++m) size += std::fabs(p[m]);
    for (size_t m = 1; m < p.size(); ++m) {
      const auto exponents = set_.basis->Exponents(m);
      // A little of the linear part, too, so that something is split in any case.
      const double share =
          std::fabs(p[m]) / std::fmax(size, 1e-300) * (set_.basis->DegreeOf(m) > 1 ? 1 : 1e-3);
      for (size_t s = 0; s < symbols_; ++s) weight[s] += exponents[s] * share;
    }
  }
  const auto worst = std::ranges::max_element(weight);
  for (size_t i = 0; i < symbol_.size() && worst != weight.end(); ++i) {
    if (symbol_[i] && *symbol_[i] == static_cast<size_t>(worst - weight.begin())) return i;
  }
  return std::nullopt;
}

bool Follower::Control() {
  Image image;
  if (!image.Of(system_.control, set_, system_.dynamics.inputs))
    return Fail("the controller is not defined on the whole set");
  set_ = image.Set();
  return true;
}

// From one instant to the next, between which only the flow acts.
bool Follower::Segment(const Rational& from, const Rational& to) {
  const double begin = from.ToDouble();
  Interval left = Enclose(to - from);
  double carried = 0;  // what is left of a step that was too long
  while (left.hi > 0) {
    if (stop_.StopRequested()) return Fail("stopped");
    time_ = begin + (to - from).ToDouble() - left.hi;
    double wanted = carried;
    if (!(wanted > 0)) {
      const PartRecord::Step& hint = (*hints_)[std::min(next_hint_, hints_->size() - 1)];
      ++next_hint_;
      wanted = hint.length;
      if (hint.degree != set_.basis->degree() && symbols_ > 0)
        set_.SetBasis(bases_.Of(symbols_, std::clamp<size_t>(hint.degree, 1, 40)));
    }
    if (!(wanted >= kLeastStep)) wanted = kLeastStep;
    // The last one ends where the segment does, not a rounding before it.
    if (wanted > left.hi * (1 - 1e-9)) wanted = left.hi;
    double taken = 0;
    if (!StepOn(wanted, from, to, taken)) return false;
    const bool last = taken == left.hi;
    if (last) {
      // It lasted `left`, of which the upper end was taken.
      const double late = left.Width();
      if (late > 0) {
        Eigen::VectorXd more(static_cast<Eigen::Index>(set_.states()));
        for (size_t i = 0; i < set_.states(); ++i)
          more[static_cast<Eigen::Index>(i)] = Up(Up(late) * Magnitude(last_rates_[i]));
        set_.AddErrors(more);
      }
      return true;
    }
    left = left - Interval::Point(taken);
    carried = wanted - taken;
  }
  return true;
}

// One step of the length that is wanted, or of a part of it.
bool Follower::StepOn(double wanted, const Rational& from, const Rational& to, double& taken) {
  Step step(system_.dynamics, order_);
  taken = wanted;
  while (!step.Take(set_, taken)) {
    taken *= 0.5;
    if (taken < kLeastStep) return Fail("the set cannot be followed further");
  }
  ++steps_;
  if (!During(step, from, to)) return false;
  last_rates_ = step.rates();
  set_ = step.end();
  const auto n = static_cast<Eigen::Index>(set_.states());
  set_.Reduce(kMostColumns * n);
  return true;
}

bool Follower::AtInstant(const Rational& instant, bool start) {
  std::optional<Image> image;
  for (const CompiledClaim& claim : system_.claims) {
    const bool own = claim.claim->from == instant && (start || claim.claim->to == instant);
    if (!own) continue;
    if (!image) {
      image.emplace();
      if (!image->Of(system_.observed, set_, system_.dynamics.inputs))
        return Fail("a claim is not defined on the whole set");
    }
    const Truth truth = claim.formula.Check([&](size_t atom) {
      const Interval range = image->Range(claim.first + atom);
      return start && claim.starts_below[atom] ? AtMostZero(range) : range;
    });
    if (truth != Truth::kTrue) return Fail(fmt::format("`{}` is not shown", claim.claim->name));
  }
  return true;
}

// All claims that must hold from one instant to the other, during a step in between.
bool Follower::During(const Step& step, const Rational& from, const Rational& to) {
  Fall(step);
  const std::vector<Interval> coarse = ValuesOn(system_.observed, step.region());
  std::optional<std::vector<Model>> models;
  for (size_t c = 0; c < system_.claims.size(); ++c) {
    const CompiledClaim& claim = system_.claims[c];
    if (to <= claim.claim->from || claim.claim->to <= from) continue;
    const auto known = [&](size_t atom, Interval range) {
      return falls_[c][atom] ? AtMostZero(range) : range;
    };
    const auto node = [&](size_t atom) { return system_.observed.outputs[claim.first + atom]; };
    if (claim.formula.Check([&](size_t atom) { return known(atom, coarse[node(atom)]); }) == Truth::kTrue)
      continue;
    if (!models) {
      OnBox on;
      if (Linearise(system_.observed, step.region(), 0, on))
        models = Evaluate(system_.observed, step.algebra(), step.during(), on);
      if (!models) return Fail("a claim is not defined during the whole step");
    }
    // Slices of the step's time, until it is shown on each.
    std::vector<std::pair<double, double>> open{{0, 1}};
    while (!open.empty()) {
      const auto [begin, end] = open.back();
      open.pop_back();
      const Truth truth = claim.formula.Check([&](size_t atom) {
        return known(atom, interval::Meet(step.algebra().Range((*models)[node(atom)], begin, end),
                                          coarse[node(atom)]));
      });
      if (truth == Truth::kTrue) continue;
      if (end - begin < std::ldexp(1.5, -kMostSlices))
        return Fail(fmt::format("`{}` is not shown", claim.claim->name));
      const double middle = 0.5 * (begin + end);
      open.emplace_back(middle, end);
      open.emplace_back(begin, middle);
    }
  }
  return true;
}

void Follower::Fall(const Step& step) {
  const auto any = [](const std::vector<bool>& f) { return std::ranges::find(f, true) != f.end(); };
  if (std::ranges::none_of(falls_, any)) return;
  OnBox on;
  const bool defined = Linearise(system_.observed, step.region(), system_.observed.outputs.size(), on);
  for (size_t c = 0; c < falls_.size(); ++c) {
    for (size_t k = 0; k < falls_[c].size(); ++k) {
      if (falls_[c][k]) falls_[c][k] = defined && StaysBelow(step, system_.claims[c].first + k, on);
    }
  }
}

// Does a term g that is at most zero when the step begins stay so? If g' <= r g along every course, for some
// number r, then g(t) <= exp(r t) g(0).
bool Follower::StaysBelow(const Step& step, size_t output, const OnBox& on) const {
  const Program& rates = system_.dynamics.rates;
  const size_t n = system_.dynamics.states;
  const size_t width = system_.observed.variables.size();
  bool linear = true;
  Interval change = Interval::Point(0);
  std::vector<LinearPart> parts;
  for (size_t v = 0; v < width; ++v) {
    const Interval slope = on.slopes[output * width + v];
    if (slope == Interval::Point(0)) continue;
    if (v >= n) return false;
    linear = linear && slope.IsPoint();
    change = change + slope * step.rates()[v];
    parts.push_back({slope.lo, 0, static_cast<uint32_t>(v)});
  }
  if (change.hi <= 0) return true;
  if (!linear) return false;
  // g and g' as models.
  const Algebra& algebra = step.algebra();
  OnBox on_rates;
  OnBox on_terms;
  if (!Linearise(rates, step.region(), 0, on_rates) ||
      !Linearise(system_.observed, step.region(), 0, on_terms))
    return false;
  const auto f = Evaluate(rates, algebra, step.during(), on_rates);
  const auto terms = Evaluate(system_.observed, algebra, step.during(), on_terms);
  if (!f || !terms) return false;
  std::vector<LinearPart> of_rates;
  for (const LinearPart& p : parts) of_rates.push_back({p.factor, 0, rates.outputs[p.node]});
  const LinearPart none{0, 0, 0};
  const Model& g = (*terms)[system_.observed.outputs[output]];
  const Model rate = algebra.Linear(of_rates, none, *f);
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
