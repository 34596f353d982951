#include "driver/statistical.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "reach/simulation/batch.h"
#include "reach/simulation/statistical.h"

namespace rondo::driver {

namespace {

// A program that knows the states of the robot: the clock and what does not change are added.
class Padded final : public reach::Simulator {
 public:
  Padded(std::unique_ptr<reach::Simulator> inner, size_t dimension, size_t clock)
      : inner_(std::move(inner)), dimension_(dimension), clock_(clock) {}
  size_t dimension() const override { return dimension_; }
  base::Result<reach::Trace> Run(std::span<const double> start, double dt, size_t steps) override {
    auto inner = inner_->Run(start.first(inner_->dimension()), dt, steps);
    if (!inner.ok()) return inner.error();
    reach::Trace trace;
    for (size_t k = 0; k <= steps; ++k) {
      std::vector<double> row(start.begin(), start.end());
      const auto from = inner.value().begin() + static_cast<std::ptrdiff_t>(k * inner_->dimension());
      std::copy_n(from, inner_->dimension(), row.begin());
      if (clock_ < row.size()) row[clock_] = dt * static_cast<double>(k);
      trace.insert(trace.end(), row.begin(), row.end());
    }
    return trace;
  }

 private:
  std::unique_ptr<reach::Simulator> inner_;
  size_t dimension_, clock_;
};

base::Result<reach::Judge> OfModel(const reach::Problem& problem, double dt, size_t steps) {
  auto made = reach::BatchJudge::Of(problem);
  if (!made.ok()) return made.error();
  auto judge = std::make_shared<reach::BatchJudge>(std::move(made).value());
  return reach::Judge(
      [judge, dt, steps](std::span<const std::vector<double>> starts, std::span<bool> failed) {
        judge->Run(starts, dt, steps, failed);
        return base::Result<bool>(true);
      });
}

base::Result<reach::Judge> OfProcess(const ContractResult& contract, const StatisticalOptions& options,
                                     double dt, size_t steps,
                                     std::vector<std::unique_ptr<reach::Simulator>>& simulators) {
  const reach::Problem& problem = contract.made.problem;
  auto process = reach::ProcessSimulator(options.simulator, contract.made.robot_states);
  if (!process.ok()) return process.error();
  const auto clock = std::ranges::find(contract.made.names, "clock") - contract.made.names.begin();
  simulators.push_back(std::make_unique<Padded>(std::move(process).value(), problem.states.size(),
                                                static_cast<size_t>(clock)));
  auto made = reach::Trajectories::Of(problem);
  if (!made.ok()) return made.error();
  auto judge = std::make_shared<reach::Trajectories>(std::move(made).value());
  reach::Simulator* simulator = simulators.back().get();
  return reach::Judge([=, &problem](std::span<const std::vector<double>> starts, std::span<bool> failed) {
    const size_t n = problem.states.size();
    for (size_t i = 0; i < starts.size(); ++i) {
      failed[i] = false;
      if (judge->MissAssumed(starts[i]) > 0) continue;
      const auto trace = simulator->Run(starts[i], dt, steps);
      if (!trace.ok()) return base::Result<bool>(trace.error());
      for (size_t k = 0; k <= steps && !failed[i]; ++k) {
        const double t = dt * static_cast<double>(k);
        for (size_t c = 0; c < judge->claims() && !failed[i]; ++c) {
          const reach::Claim& claim = problem.claims[c];
          if (t < claim.from.ToDouble() - 1e-9 || t > claim.to.ToDouble() + 1e-9) continue;
          failed[i] = judge->Miss(c, std::span(trace.value()).subspan(k * n, n)) > 0;
        }
      }
    }
    return base::Result<bool>(true);
  });
}

}  // namespace

Statistical Sample(const ContractResult& contract, const StatisticalOptions& options,
                   const base::StopToken& stop) {
  Statistical result;
  const auto begin = std::chrono::steady_clock::now();
  const reach::Problem& problem = contract.made.problem;
  if (!contract.impossible.empty()) {
    result.trouble = contract.impossible;
    return result;
  }
  const unsigned jobs = options.jobs > 0 ? options.jobs : std::max(1U, std::thread::hardware_concurrency());
  const double horizon = problem.horizon.ToDouble();
  const auto steps = static_cast<size_t>(std::ceil(horizon / options.dt - 1e-9));
  const double dt = horizon / static_cast<double>(steps);
  std::vector<std::unique_ptr<reach::Simulator>> simulators;
  std::vector<reach::Judge> judges;
  for (unsigned j = 0; j < jobs; ++j) {
    auto judge = options.simulator.empty() ? OfModel(problem, dt, steps)
                                           : OfProcess(contract, options, dt, steps, simulators);
    if (!judge.ok()) {
      result.trouble = judge.error().message;
      return result;
    }
    judges.push_back(std::move(judge).value());
  }
  auto calibration = reach::Calibrate(judges, problem.initial, options.runs, reach::BatchJudge::kLanes,
                                      options.confidence, options.seed, stop);
  if (!calibration.ok()) {
    result.trouble = calibration.error().message;
    return result;
  }
  const reach::Calibration& c = calibration.value();
  result.runs = c.runs;
  result.failures = c.failures;
  result.epsilon = c.epsilon;
  result.confidence = c.confidence;
  result.worst = c.worst;
  // Corners have no probability, and are where things go wrong first.
  for (size_t corner = 0; corner < 64; ++corner) {
    std::vector<double> start;
    size_t bit = 0;
    for (const interval::Interval& side : problem.initial) {
      const bool free = side.Width() > 1e-13;
      start.push_back(!free                            ? side.Middle()
                      : (corner >> (bit % 6) & 1) != 0 ? side.hi - 1e-9 * side.Width()
                                                       : side.lo + 1e-9 * side.Width());
      bit += free ? 1 : 0;
    }
    if (bit < 6 && corner >= size_t{1} << bit) break;
    bool failed = false;
    if (!judges[0](std::span(&start, 1), std::span(&failed, 1)).ok()) break;
    ++result.corners;
    if (!failed) continue;
    ++result.corner_failures;
    if (result.worst.empty()) result.worst = start;
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

std::string StatisticalLine(const ContractResult& contract, const Statistical& s) {
  const std::string& name = contract.made.problem.name;
  if (!s.trouble.empty()) return fmt::format("unknown      {}: {}\n", name, s.trouble);
  std::string text = fmt::format(
      "statistical  {}: {} of {} runs fail; with confidence {:g} at most {:.4g} of all starts do ({:.2f} "
      "s)\n",
      name, s.failures, s.runs, s.confidence, s.epsilon, s.seconds);
  if (s.corner_failures > 0)
    text +=
        fmt::format("             {} of {} corners of the initial box fail\n", s.corner_failures, s.corners);
  return text;
}

nlohmann::json ToJson(const ContractResult& contract, const Statistical& s,
                      const StatisticalOptions& options) {
  nlohmann::json out{{"contract", contract.made.problem.name},
                     {"verdict", s.trouble.empty() ? "statistical" : "unknown"}};
  if (!s.trouble.empty()) {
    out["reason"] = s.trouble;
    return out;
  }
  out["runs"] = s.runs;
  out["failures"] = s.failures;
  out["epsilon"] = s.epsilon;
  out["confidence"] = s.confidence;
  out["corners"] = s.corners;
  out["corner_failures"] = s.corner_failures;
  out["distribution"] = "uniform on the initial box";
  out["seed"] = options.seed;
  out["seconds"] = s.seconds;
  if (!s.worst.empty()) out["start"] = s.worst;
  return out;
}

}  // namespace rondo::driver
