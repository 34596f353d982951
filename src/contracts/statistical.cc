#include "contracts/statistical.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "reach/simulation/batch.h"
#include "reach/simulation/statistical.h"

namespace rondo::contracts {

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

// A model with events: one precise trajectory after the other, with inputs at random.
base::Result<reach::Judge> OfTrajectories(const reach::Problem& problem, double dt, uint64_t seed) {
  auto made = reach::Trajectories::Of(problem);
  if (!made.ok()) return made.error();
  auto judge = std::make_shared<reach::Trajectories>(std::move(made).value());
  auto random = std::make_shared<std::mt19937_64>(seed);
  return reach::Judge([=, &problem](std::span<const std::vector<double>> starts, std::span<bool> failed) {
    constexpr int kSlots = 16;
    for (size_t i = 0; i < starts.size(); ++i) {
      failed[i] = false;
      if (judge->MissAssumed(starts[i]) > 0) continue;
      reach::Execution execution{starts[i], {}, problem.horizon.ToDouble() / kSlots};
      for (int slot = 0; slot < kSlots && !problem.inputs.empty(); ++slot) {
        auto& values = execution.inputs.emplace_back();
        for (const reach::Input& input : problem.inputs) {
          const double u = static_cast<double>((*random)() >> 11) * 0x1p-53;
          values.push_back(input.bounds.lo + u * (input.bounds.hi - input.bounds.lo));
        }
      }
      failed[i] = judge->Worst(execution, dt, 0, 1e-8, base::StopToken()).miss > 0;
    }
    return base::Result<bool>(true);
  });
}

// The user's simulator, or the model itself.
base::Result<std::unique_ptr<reach::Simulator>> SimulatorFor(const ContractResult& contract,
                                                             const StatisticalOptions& options) {
  const reach::Problem& problem = contract.made.problem;
  if (options.simulator.empty()) return reach::SimulatorOf(problem);
  auto box = options.simulator.ends_with(".so")
                 ? reach::LibrarySimulator(options.simulator, contract.made.robot_states)
                 : reach::ProcessSimulator(options.simulator, contract.made.robot_states);
  if (!box.ok()) return box.error();
  const auto clock = std::ranges::find(contract.made.names, "clock") - contract.made.names.begin();
  return std::unique_ptr<reach::Simulator>(
      std::make_unique<Padded>(std::move(box).value(), problem.states.size(), static_cast<size_t>(clock)));
}

base::Result<reach::Judge> OfSimulator(reach::Simulator* simulator, const reach::Problem& problem, double dt,
                                       size_t steps) {
  auto made = reach::Trajectories::Of(problem);
  if (!made.ok()) return made.error();
  auto judge = std::make_shared<reach::Trajectories>(std::move(made).value());
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

// Does the run leave a tube that was learned from others?
reach::Judge OfTube(reach::Simulator* simulator, const std::shared_ptr<const reach::SampledTube>& tube,
                    double dt, size_t steps) {
  return [=](std::span<const std::vector<double>> starts, std::span<bool> failed) {
    for (size_t i = 0; i < starts.size(); ++i) {
      const auto trace = simulator->Run(starts[i], dt, steps);
      if (!trace.ok()) return base::Result<bool>(trace.error());
      failed[i] = !reach::Inside(*tube, trace.value());
    }
    return base::Result<bool>(true);
  };
}

// By what runs are judged; a judge for each thread.
base::Result<std::vector<reach::Judge>> Judges(const ContractResult& contract,
                                               const StatisticalOptions& options, double dt, size_t steps,
                                               std::vector<std::unique_ptr<reach::Simulator>>& simulators,
                                               Statistical& result) {
  const reach::Problem& problem = contract.made.problem;
  const unsigned jobs = options.jobs > 0 ? options.jobs : std::max(1U, std::thread::hardware_concurrency());
  std::vector<reach::Judge> judges;
  std::shared_ptr<const reach::SampledTube> tube;
  for (unsigned j = 0; j < jobs; ++j) {
    const bool box = !options.simulator.empty() || !options.tube.empty();
    if (box) {
      auto simulator = SimulatorFor(contract, options);
      if (!simulator.ok()) return simulator.error();
      simulators.push_back(std::move(simulator).value());
    }
    if (!options.tube.empty()) {
      if (tube == nullptr) {
        reach::LearnOptions learn;
        learn.learning = options.tube == "compat" ? reach::Learning::kCompat : reach::Learning::kCareful;
        learn.seed = options.seed;
        learn.dt = dt;
        learn.steps = steps;
        auto learned = reach::Learn(*simulators[0], problem.initial, learn);
        if (!learned.ok()) return learned.error();
        tube = std::make_shared<reach::SampledTube>(std::move(learned).value());
        if (!tube->steps.empty()) result.final = tube->steps.back();
      }
      judges.push_back(OfTube(simulators.back().get(), tube, dt, steps));
      continue;
    }
    auto judge = box                      ? OfSimulator(simulators.back().get(), problem, dt, steps)
                 : problem.events.empty() ? OfModel(problem, dt, steps)
                                          : OfTrajectories(problem, dt, options.seed + j);
    if (!judge.ok()) return judge.error();
    judges.push_back(std::move(judge).value());
  }
  return judges;
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
  const double horizon = problem.horizon.ToDouble();
  const auto steps = static_cast<size_t>(std::ceil(horizon / options.dt - 1e-9));
  const double dt = horizon / static_cast<double>(steps);
  std::vector<std::unique_ptr<reach::Simulator>> simulators;
  auto made = Judges(contract, options, dt, steps, simulators, result);
  if (!made.ok()) {
    result.trouble = made.error().message;
    return result;
  }
  const std::vector<reach::Judge> judges = std::move(made).value();
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
  const bool tube = !s.final.empty();
  std::string text = fmt::format(
      "statistical  {}: {} of {} runs {}; with confidence {:g} at most {:.4g} of all starts do ({:.2f} s)\n",
      name, s.failures, s.runs, tube ? "leave the tube" : "fail", s.confidence, s.epsilon, s.seconds);
  for (size_t i = 0; tube && i < s.final.size(); ++i) {
    if (s.final[i].Width() > 0)
      text += fmt::format("             {} in [{:.6g}, {:.6g}] at the end\n", contract.made.names[i],
                          s.final[i].lo, s.final[i].hi);
  }
  if (s.corner_failures > 0)
    text += fmt::format("             {} of {} corners of the initial box {}\n", s.corner_failures, s.corners,
                        tube ? "leave it" : "fail");
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
  if (!s.final.empty()) {
    out["tube"] = options.tube;
    for (size_t i = 0; i < s.final.size(); ++i)
      out["final"][contract.made.names[i]] = {s.final[i].lo, s.final[i].hi};
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

}  // namespace rondo::contracts
