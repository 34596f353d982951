#include "sim/models/modelled_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/uniform.h"

namespace rondo::sim {

ModelledBody::ModelledBody(std::shared_ptr<const RobotCode> code, std::map<std::string, double> initial)
    : code_(std::move(code)),
      initial_(std::move(initial)),
      rates_(code_->rates),
      laws_(code_->laws.values),
      place_(code_->place) {
  for (const RobotCode::Port& p : code_->ports) {
    ports_.emplace_back(p.holds ? p.holds->terms : p.values);
    if (p.name == "target" && p.port.settable) target_ = p.set;
  }
  for (const RobotCode::Event& e : code_->events) {
    conditions_.emplace_back(e.condition.terms);
    updates_.emplace_back(e.update.values);
  }
}

std::vector<BodyParameter> ModelledBody::Parameters() const {
  return {
      {"radius", 0.25, "m"}, {"tolerance", 0.1, "m"}, {"waypoint_tolerance", 0.2, "m"}, {"dwell", 0.5, "s"}};
}

void ModelledBody::Reset(const Point& position, double yaw) {
  const size_t none = code_->variables.size();
  x_.assign(none, 0);
  changed_ = 0;
  // Where a model says itself where it is, the fleet decides only what it has states for.
  const bool tells = FindPort("psn") || FindPort("position") || FindPort("pos");
  offset_ = tells ? Point{} : position;
  for (size_t i = 0; i < 3; ++i) {
    if (code_->position[i] == none) continue;
    x_[code_->position[i]] = position[i];
    offset_[i] = 0;
  }
  turned_ = tells ? 0 : yaw;
  if (code_->heading != none) {
    x_[code_->heading] = yaw;
    turned_ = 0;
  }
  for (const auto& [name, value] : initial_) {
    const size_t at = code_->Find(name);
    if (at < none) x_[at] = value;
  }
  // Constants that nobody knows, and disturbances: any value that they may have.
  for (size_t v = code_->states + code_->memory + code_->inputs; v < none; ++v) {
    const RobotVariable& variable = code_->variables[v];
    if (!initial_.contains(variable.name))
      x_[v] = variable.low + (variable.high - variable.low) * base::Uniform(random_);
  }
  Disturb(std::numeric_limits<double>::infinity());
  states_.assign(x_.begin(), x_.begin() + static_cast<ptrdiff_t>(code_->states));
  time_ = 0;
  samples_ = 0;
  was_broken_.assign(none, false);
  broken_.clear();
  state_.assign(3, 0);
  FindPlace();
}

// In about `dt` of a second each disturbance gets another value.
void ModelledBody::Disturb(double dt) {
  for (const size_t v : code_->disturbances) {
    if (base::Uniform(random_) >= dt) continue;
    const RobotVariable& d = code_->variables[v];
    const double choice = base::Uniform(random_);
    x_[v] = choice < 0.25 ? d.low : choice < 0.5 ? d.high : d.low + (d.high - d.low) * base::Uniform(random_);
  }
}

void ModelledBody::Control(const Point& target, bool, double) {
  for (size_t i = 0; i < target_.size(); ++i) {
    if (target_[i] < x_.size()) x_[target_[i]] = target[i];
  }
}

void ModelledBody::Rate(std::span<const double> x, std::span<double> dx) const {
  all_ = x_;
  std::copy(x.begin(), x.end(), all_.begin());
  rates_(all_, dx);
}

void ModelledBody::Apply(const RobotUpdate& update, reach::Evaluator& evaluator) {
  constexpr double kSame = 1e-9;
  outputs_.resize(update.set.size());
  evaluator(x_, outputs_);
  for (size_t i = 0; i < update.set.size(); ++i) {
    if (std::fabs(x_[update.set[i]] - outputs_[i]) > kSame) changed_ = time_;
    x_[update.set[i]] = outputs_[i];
  }
}

bool ModelledBody::Holds(const RobotFormula& formula, reach::Evaluator& evaluator) const {
  outputs_.resize(formula.formula.terms.size());
  evaluator(x_, outputs_);
  return formula.formula.Miss([&](size_t t) {
    // Without a value, a comparison is false.
    return std::isnan(outputs_[t]) ? std::numeric_limits<double>::infinity() : outputs_[t];
  }) <= 0;
}

// Events happen one after the other, until none can; false if that does not end.
bool ModelledBody::Settle() {
  constexpr int kMost = 100;
  for (int n = 0; n < kMost; ++n) {
    bool any = false;
    for (size_t e = 0; e < code_->events.size() && !any; ++e) {
      if (!Holds(code_->events[e].condition, conditions_[e])) continue;
      const std::vector<double> before = x_;
      Apply(code_->events[e].update, updates_[e]);
      any = x_ != before;
    }
    if (!any) return true;
  }
  return false;
}

// Integrates for `step` seconds, or up to where an event happens that does not at the start; `step` becomes how long.
bool ModelledBody::Flow(double& step, Integrator integrator) {
  const auto begin = x_.begin();
  states_.assign(begin, begin + static_cast<ptrdiff_t>(code_->states));
  const std::vector<double> start = states_;
  const Derivative f = [this](std::span<const double> x, std::span<double> dx) { Rate(x, dx); };
  const auto go = [&](double length) {
    states_ = start;
    if (!Integrate(integrator, f, states_, length)) return false;
    std::ranges::copy(states_, begin);
    return true;
  };
  const auto happens = [&] {
    for (size_t e = 0; e < code_->events.size(); ++e) {
      if (Holds(code_->events[e].condition, conditions_[e])) return true;
    }
    return false;
  };
  const bool from_the_start = happens();
  if (!go(step)) return false;
  if (from_the_start || !happens()) return true;
  constexpr int kHalvings = 40;
  double before = 0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (before + step) / 2;
    if (!go(middle)) return false;
    (happens() ? step : before) = middle;
  }
  return go(step);
}

bool ModelledBody::Advance(double dt, Integrator integrator) {
  Disturb(dt);
  constexpr double kTiny = 1e-12;  // seconds: sums of steps are not exact
  double left = dt;
  while (left > kTiny) {
    double step = left;
    if (code_->period) {
      const double next = static_cast<double>(samples_) * *code_->period;
      if (time_ >= next - kTiny) {
        Apply(code_->laws, laws_);
        ++samples_;
      }
      step = std::min(step, static_cast<double>(samples_) * *code_->period - time_);
    }
    if (!Settle()) return false;
    if (step > kTiny && !Flow(step, integrator)) return false;
    time_ += step;
    left -= step;
  }
  if (!Settle()) return false;
  FindPlace();
  Watch();
  return true;
}

void ModelledBody::FindPlace() {
  place_(x_, frame_);
  for (size_t i = 0; i < 3; ++i) state_[i] = frame_[i] + offset_[i];
}

// Does a variable leave the range that its model says it never leaves?
void ModelledBody::Watch() {
  for (size_t v = 0; v < x_.size(); ++v) {
    const RobotVariable& variable = code_->variables[v];
    const double slack = 1e-9 * std::max(1.0, std::fabs(x_[v]));
    if (was_broken_[v] || (x_[v] >= variable.low - slack && x_[v] <= variable.high + slack)) continue;
    was_broken_[v] = true;
    broken_.push_back(fmt::format("`{}` in [{:.6g}, {:.6g}]", variable.name, variable.low, variable.high));
  }
}

std::vector<std::string> ModelledBody::TakeBroken() { return std::exchange(broken_, {}); }

double ModelledBody::yaw() const { return turned_ + std::atan2(frame_[6], frame_[3]); }

// The quaternion of a rotation matrix, from the largest of its four numbers.
std::array<double, 4> ModelledBody::rotation() const {
  const auto m = [&](size_t i, size_t k) { return frame_[3 + 3 * i + k]; };
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  std::array<double, 4> q{};
  if (trace > 0) {
    const double s = 2 * std::sqrt(1 + trace);
    q = {(m(2, 1) - m(1, 2)) / s, (m(0, 2) - m(2, 0)) / s, (m(1, 0) - m(0, 1)) / s, s / 4};
  } else {
    const size_t i = m(1, 1) > m(0, 0) ? (m(2, 2) > m(1, 1) ? 2 : 1) : (m(2, 2) > m(0, 0) ? 2 : 0);
    const size_t j = (i + 1) % 3;
    const size_t k = (i + 2) % 3;
    const double s = 2 * std::sqrt(std::max(0.0, 1 + m(i, i) - m(j, j) - m(k, k)));
    q[i] = s / 4;
    q[j] = (m(j, i) + m(i, j)) / s;
    q[k] = (m(k, i) + m(i, k)) / s;
    q[3] = (m(k, j) - m(j, k)) / s;
  }
  const double c = std::cos(turned_ / 2);
  const double s = std::sin(turned_ / 2);
  return {c * q[0] - s * q[1], c * q[1] + s * q[0], c * q[2] + s * q[3], c * q[3] - s * q[2]};
}

Point ModelledBody::velocity() const {
  outputs_.resize(code_->states);
  Rate(states_, outputs_);
  Point v{};
  for (size_t i = 0; i < 3; ++i) {
    if (code_->position[i] < code_->states) v[i] = outputs_[code_->position[i]];
  }
  return v;
}

bool ModelledBody::AtRest() const {
  // A controller that goes on counting will do something.
  if (!Body::AtRest() || time_ - changed_ < 2 * code_->period.value_or(0)) return false;
  constexpr double kStill = 1e-6;  // per second, of what is no position
  outputs_.resize(code_->states);
  Rate(states_, outputs_);
  for (size_t v = 0; v < code_->states; ++v) {
    const bool position = std::ranges::find(code_->position, v) != code_->position.end();
    if (!position && std::fabs(outputs_[v]) > kStill) return false;
  }
  return true;
}

std::optional<BodyPort> ModelledBody::FindPort(std::string_view name) const {
  for (const RobotCode::Port& p : code_->ports) {
    if (p.name == name) return p.port;
  }
  return std::nullopt;
}

void ModelledBody::ReadPort(const BodyPort& port, std::span<double> values) const {
  const RobotCode::Port& p = code_->ports[port.number];
  if (p.holds)
    values[0] = Holds(*p.holds, ports_[port.number]) ? 1 : 0;
  else
    ports_[port.number](x_, values);
}

void ModelledBody::WritePort(const BodyPort& port, std::span<const double> values) {
  const RobotCode::Port& p = code_->ports[port.number];
  for (size_t i = 0; i < p.set.size() && i < values.size(); ++i) {
    if (p.set[i] < x_.size()) x_[p.set[i]] = values[i];
  }
  Watch();
}

}  // namespace rondo::sim
