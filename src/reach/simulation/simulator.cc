#include "reach/simulation/simulator.h"

#include <cmath>

namespace rondo::reach {

namespace {

class ModelSimulator final : public Simulator {
 public:
  ModelSimulator(const Problem& problem, Program rates, Program updates, size_t substeps)
      : problem_(problem), rates_(std::move(rates)), updates_(std::move(updates)), substeps_(substeps) {}

  size_t dimension() const override { return problem_.states.size(); }

  base::Result<Trace> Run(std::span<const double> start, double dt, size_t steps) override {
    const size_t n = dimension();
    const size_t inputs = problem_.inputs.size();
    Evaluator rate(rates_), update(updates_);
    std::vector<double> x(start.begin(), start.end()), at(n + inputs), k[4], next(n);
    for (auto& slope : k) slope.resize(n);
    for (size_t i = 0; i < inputs; ++i) at[n + i] = problem_.inputs[i].bounds.Middle();
    Trace trace;
    trace.reserve((steps + 1) * n);
    const auto keep = [&] { trace.insert(trace.end(), x.begin(), x.end()); };
    const double period = problem_.controller ? problem_.controller->period.ToDouble() : 0;
    size_t sample = 0;
    const size_t samples = Samples(problem_);
    const auto control = [&](double t) {
      if (sample >= samples || t < period * static_cast<double>(sample) - 1e-9) return;
      ++sample;
      std::copy(x.begin(), x.end(), at.begin());
      update(at, next);
      x = next;
    };
    keep();
    const auto integrate = [&](double h) {
      constexpr double kAt[4] = {0, 0.5, 0.5, 1};
      for (int s = 0; s < 4; ++s) {
        for (size_t i = 0; i < n; ++i) at[i] = x[i] + (s == 0 ? 0 : kAt[s] * h * k[s - 1][i]);
        rate(at, k[s]);
      }
      for (size_t i = 0; i < n; ++i) x[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    };
    for (size_t step = 0; step < steps; ++step) {
      double t = dt * static_cast<double>(step);
      const double end = dt * static_cast<double>(step + 1);
      while (t < end - 1e-9) {
        control(t);
        double until = end;
        if (sample < samples) until = std::min(until, period * static_cast<double>(sample));
        for (size_t s = 0; s < substeps_; ++s) integrate((until - t) / static_cast<double>(substeps_));
        t = until;
      }
      for (const double v : x) {
        if (!std::isfinite(v)) return base::Error{"a run is not finite"};
      }
      keep();
    }
    return trace;
  }

 private:
  const Problem& problem_;
  Program rates_, updates_;
  size_t substeps_;
};

}  // namespace

base::Result<std::unique_ptr<Simulator>> SimulatorOf(const Problem& problem, size_t substeps) {
  if (!problem.events.empty()) return base::Error{"a model with events has no runs with steps of one length"};
  std::vector<TermId> variables = problem.states;
  for (const Input& i : problem.inputs) variables.push_back(i.term);
  auto rates = Compile(*problem.arena, variables, problem.rates);
  if (!rates.ok()) return rates.error();
  auto map = Compile(*problem.arena, variables, Updated(problem));
  if (!map.ok()) return map.error();
  return std::unique_ptr<Simulator>(
      std::make_unique<ModelSimulator>(problem, std::move(rates).value(), std::move(map).value(), substeps));
}

}  // namespace rondo::reach
