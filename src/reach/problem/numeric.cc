#include "reach/problem/numeric.h"

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cmath>

namespace rondo::reach {

namespace odeint = boost::numeric::odeint;

namespace {

constexpr size_t kMostCrowded = 50;
constexpr double kCrowded = 1e-9;  // of the horizon

}  // namespace

void Evaluator::operator()(std::span<const double> variables, std::span<double> outputs) {
  const Program& p = program_;
  for (size_t n = 0; n < p.code.size(); ++n) {
    const Code& c = p.code[n];
    double& out = values_[n];
    switch (c.op) {
      case CodeOp::kVariable:
        out = variables[c.a];
        break;
      case CodeOp::kLinear:
        out = p.constants[n].factor;
        for (uint32_t i = c.a; i < c.a + c.b; ++i) out += p.parts[i].factor * values_[p.parts[i].node];
        break;
      case CodeOp::kProduct:
        out = values_[c.a] * values_[c.b];
        break;
      case CodeOp::kReciprocal:
        out = 1 / values_[c.a];
        break;
      case CodeOp::kRoot:
        out = std::sqrt(values_[c.a]);
        break;
      case CodeOp::kSine:
        out = std::sin(values_[c.a]);
        break;
      case CodeOp::kCosine:
        out = std::cos(values_[c.a]);
        break;
      case CodeOp::kExp:
        out = std::exp(values_[c.a]);
        break;
      case CodeOp::kLog:
        out = std::log(values_[c.a]);
        break;
      case CodeOp::kAtan:
        out = std::atan(values_[c.a]);
        break;
      case CodeOp::kAtan2:
        out = std::atan2(values_[c.a], values_[c.b]);
        break;
      case CodeOp::kAbs:
        out = std::fabs(values_[c.a]);
        break;
      case CodeOp::kMax:
        out = std::fmax(values_[c.a], values_[c.b]);
        break;
      case CodeOp::kChoose:
        out = values_[c.a] <= 0 ? values_[c.b] : values_[c.c];
        break;
    }
  }
  for (size_t i = 0; i < outputs.size(); ++i) outputs[i] = values_[p.outputs[i]];
}

base::Result<Trajectories> Trajectories::Of(const Problem& problem) {
  Trajectories t;
  t.problem_ = &problem;
  std::vector<TermId> variables = problem.states;
  for (const Input& i : problem.inputs) variables.push_back(i.term);
  auto rates = Compile(*problem.arena, variables, problem.rates);
  if (!rates.ok()) return rates.error();
  t.rates_ = std::move(rates).value();
  if (problem.controller) {
    auto program = Compile(*problem.arena, variables, Updated(problem));
    if (!program.ok()) return program.error();
    t.updates_ = std::move(program).value();
  }
  const auto compile = [&](TermId term) -> base::Result<Compiled> {
    auto formula = Normalise(*problem.arena, term);
    if (!formula.ok()) return formula.error();
    auto program = Compile(*problem.arena, problem.states, formula.value().terms);
    if (!program.ok()) return program.error();
    return Compiled{std::move(formula).value(), std::move(program).value()};
  };
  for (const Event& e : problem.events) {
    auto condition = compile(e.condition);
    if (!condition.ok()) return condition.error();
    std::vector<TermId> values = problem.states;
    for (size_t i = 0; i < values.size(); ++i) values[i] = e.updates[i].value_or(values[i]);
    auto after = Compile(*problem.arena, problem.states, values);
    if (!after.ok()) return after.error();
    t.events_.push_back({std::move(condition).value(), std::move(after).value()});
  }
  for (const Claim& c : problem.claims) {
    auto compiled = compile(c.formula);
    if (!compiled.ok()) return compiled.error();
    t.claims_.push_back(std::move(compiled).value());
  }
  auto assumed = compile(problem.assume);
  if (!assumed.ok()) return assumed.error();
  t.assumed_.push_back(std::move(assumed).value());
  return t;
}

double Trajectories::MissOf(const Compiled& compiled, std::span<const double> state) {
  Evaluator evaluate(compiled.program);
  std::vector<double> values(compiled.program.outputs.size());
  evaluate(state, values);
  return compiled.formula.Miss([&](size_t atom) { return std::isnan(values[atom]) ? 1e300 : values[atom]; });
}

double Trajectories::Miss(size_t c, std::span<const double> state) { return MissOf(claims_[c], state); }
double Trajectories::MissAssumed(std::span<const double> state) { return MissOf(assumed_[0], state); }

// Does some event happen in this state, and change it to `next`?
bool Trajectories::Happens(const std::vector<double>& state, std::vector<double>& next) {
  next.resize(state.size());
  for (const Happening& e : events_) {
    if (MissOf(e.condition, state) > 0) continue;
    Evaluator after(e.after);
    after(state, next);
    if (next != state) return true;
  }
  return false;
}

// All that happens in this state, one after the other. False if there is no end to it.
bool Trajectories::Settle(std::vector<double>& state) {
  std::vector<double> next;
  for (int round = 0; round < 32; ++round) {
    if (!Happens(state, next)) return true;
    state = next;
  }
  return false;
}

bool Trajectories::Run(const Execution& execution, double resolution,
                       const std::function<bool(double, std::span<const double>)>& visit, double tolerance) {
  const size_t n = problem_->states.size();
  const size_t inputs = problem_->inputs.size();
  const double horizon = problem_->horizon.ToDouble();
  std::vector<double> x = execution.start;
  std::vector<double> all(n + inputs);
  Evaluator rate(rates_), update(updates_);
  const auto set_inputs = [&](double t) {
    for (size_t i = 0; i < inputs; ++i) {
      const auto slot = static_cast<size_t>(std::max(0.0, t / execution.input_period + 1e-9));
      all[n + i] = execution.inputs.empty()
                       ? problem_->inputs[i].bounds.Middle()
                       : execution.inputs[std::min(slot, execution.inputs.size() - 1)][i];
    }
  };
  const auto system = [&](const std::vector<double>& state, std::vector<double>& derivative, double) {
    std::copy(state.begin(), state.end(), all.begin());
    rate(all, derivative);
  };
  const double period = problem_->controller ? problem_->controller->period.ToDouble() : horizon;
  double suggested = 1e-7 * horizon;
  double t = 0;
  double last_event = -horizon;
  size_t crowded = 0;  // events, one after the other with hardly any time between them
  const size_t samples = Samples(*problem_);
  if (!problem_->controller) {
    if (!Settle(x)) return false;
    if (!visit(0, x)) return true;
  }
  std::vector<double> after;
  // From t to `next`.
  const auto integrate = [&](std::vector<double>& state, double from, double next) {
    auto stepper =
        odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<std::vector<double>>());
    double at = from;
    double dt = std::min(suggested, next - from);  // too long a step of a stiff system has no end
    int tries = 0;
    while (at < next) {
      dt = std::min(dt, next - at);
      const bool good = stepper.try_step(system, state, at, dt) == odeint::success;
      if (++tries > 2'000'000 || (!good && dt < 1e-16)) return false;
      if (good) suggested = std::max(dt, 1e-9 * horizon);
      if (next - at < 1e-14) break;
    }
    return std::ranges::all_of(state, [](double v) { return std::isfinite(v); });
  };
  // The instant at which the first event of (t, next] happens, and the state then: `x` at t, `end` at next.
  const auto locate = [&](double from, double& next, std::vector<double>& end) {
    while (next - from > 1e-12 * (1 + std::fabs(next))) {
      const double middle = from + (next - from) / 2;
      std::vector<double> there = x;
      if (middle <= from || middle >= next || !integrate(there, from, middle)) return;
      if (Happens(there, after)) {
        next = middle;
        end = there;
      } else {
        from = middle;
        x = there;
      }
    }
  };
  for (size_t sample = 0; t < horizon; ++sample) {
    set_inputs(t);
    if (sample < samples) {
      std::copy(x.begin(), x.end(), all.begin());
      std::vector<double> next(n);
      update(all, next);
      x = next;
      if (!Settle(x)) return false;
      if (!visit(t, x)) return true;
    }
    const double end =
        sample + 1 < samples ? std::min(horizon, period * static_cast<double>(sample + 1)) : horizon;
    while (t < end - 1e-12) {
      double next = std::min(end, t + resolution);
      if (inputs > 0 && !execution.inputs.empty())
        next = std::min(next, execution.input_period * (std::floor(t / execution.input_period + 1e-9) + 1));
      set_inputs(t);
      std::vector<double> end_state = x;
      if (!integrate(end_state, t, next)) return false;
      if (Happens(end_state, after)) {
        locate(t, next, end_state);
        crowded = next - last_event < kCrowded * (1 + horizon) ? crowded + 1 : 0;
        last_event = next;
        if (crowded > kMostCrowded) return false;
        if (!visit(next, end_state)) return true;
        if (!Settle(end_state)) return false;
      }
      x = std::move(end_state);
      t = next;
      if (!visit(t, x)) return true;
    }
    t = end;
  }
  return true;
}

Violation Trajectories::Worst(const Execution& execution, double resolution, double margin, double tolerance,
                              const base::StopToken& stop) {
  Violation worst;
  worst.miss = -1e300;
  const double slack = 1e-9;
  (void)Run(
      execution, resolution,
      [&](double t, std::span<const double> x) {
        for (size_t c = 0; c < claims_.size(); ++c) {
          const Claim& claim = problem_->claims[c];
          if (t < claim.from.ToDouble() - slack || t > claim.to.ToDouble() + slack) continue;
          const double miss = Miss(c, x);
          if (miss > worst.miss) worst = {c, t, miss, {x.begin(), x.end()}};
        }
        return worst.miss <= margin && !stop.StopRequested();
      },
      tolerance);
  return worst;
}

}  // namespace rondo::reach
