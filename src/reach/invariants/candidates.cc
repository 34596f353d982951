#include "reach/invariants/candidates.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "reach/problem/formula.h"

namespace rondo::reach::invariants {

namespace {

constexpr size_t kRuns = 24;
constexpr size_t kSlots = 16;
constexpr size_t kMostInstants = 1000;  // of a run that are looked at: long runs with many events say no more
constexpr double kAround[] = {0.01, 0.05, 0.2, 1};  // shares of what was visited

double Uniform(std::mt19937_64& random, Interval side) {
  if (side.IsPoint()) return side.lo;
  const double share = static_cast<double>(random() >> 11) * 0x1p-53;
  return std::clamp(side.lo + share * side.Width(), side.lo, side.hi);
}

Execution RandomExecution(const Problem& problem, std::mt19937_64& random) {
  Execution execution;
  const bool corner = random() % 2 == 0;
  for (const Interval& side : problem.initial) {
    execution.start.push_back(corner ? (random() % 2 == 0 ? side.lo : side.hi) : Uniform(random, side));
  }
  for (size_t i = 0; i < problem.copy_of.size(); ++i) {
    if (problem.copy_of[i]) execution.start[i] = execution.start[*problem.copy_of[i]];
  }
  execution.input_period = problem.horizon.ToDouble() / kSlots;
  const bool steady = random() % 2 == 0;
  for (size_t slot = 0; slot < kSlots && !problem.inputs.empty(); ++slot) {
    std::vector<double>& values = execution.inputs.emplace_back();
    for (const Input& input : problem.inputs)
      values.push_back(random() % 2 == 0 ? input.bounds.lo : input.bounds.hi);
    if (steady) execution.inputs.back() = execution.inputs.front();
  }
  return execution;
}

}  // namespace

std::vector<interval::Box> Visited(const Problem& problem, const Modes& modes, const std::vector<Mode>& all,
                                   Trajectories& trajectories, uint64_t seed, const base::StopToken& stop) {
  std::vector<std::vector<double>> values;
  for (const Mode& mode : all) {
    std::vector<double>& numbers = values.emplace_back();
    for (const TermId value : mode) numbers.push_back(NearestConstant(problem.arena->number(value)).factor);
  }
  std::vector<interval::Box> visited(all.size());
  std::mt19937_64 random(seed);
  for (size_t run = 0; run < kRuns; ++run) {
    const Execution execution = RandomExecution(problem, random);
    if (trajectories.MissAssumed(execution.start) > 1e-9) continue;
    size_t instants = 0;
    trajectories.Run(
        execution, problem.horizon.ToDouble() / 400,
        [&](double, std::span<const double> state) {
          for (size_t m = 0; m < all.size(); ++m) {
            bool here = true;
            for (size_t k = 0; k < modes.states().size(); ++k)
              here = here && state[modes.states()[k]] == values[m][k];
            if (!here) continue;
            if (visited[m].empty()) visited[m].assign(state.size(), Interval::Empty());
            for (size_t i = 0; i < state.size(); ++i)
              visited[m][i] = {std::min(visited[m][i].lo, state[i]), std::max(visited[m][i].hi, state[i])};
          }
          return ++instants < kMostInstants && !stop.StopRequested();
        },
        1e-9);
  }
  return visited;
}

std::vector<Conjunct> CandidatesFor(const Problem& problem, const Modes& modes, const Mode& mode,
                                    const interval::Box& visited) {
  using Source = Conjunct::Source;
  std::vector<Conjunct> all;
  const auto comparisons = [&](Source source, size_t index, TermId formula) {
    const auto normal = Normalise(*problem.arena, modes.In(mode, formula));
    if (!normal.ok()) return;
    for (size_t k = 0; k < normal.value().terms.size(); ++k) {
      for (const bool negated : {false, true})
        all.push_back({.source = source, .index = index, .comparison = k, .negated = negated});
    }
  };
  for (size_t c = 0; c < problem.claims.size(); ++c)
    comparisons(Source::kClaim, c, problem.claims[c].formula);
  for (size_t e = 0; e < problem.events.size(); ++e)
    comparisons(Source::kEvent, e, problem.events[e].condition);
  const auto bounds = [&](size_t i, Interval side) {
    if (std::isfinite(side.hi)) all.push_back({.index = i, .bound = side.hi});
    if (std::isfinite(side.lo)) all.push_back({.index = i, .negated = true, .bound = -side.lo});
  };
  for (size_t i = 0; i < problem.states.size(); ++i) {
    if (std::ranges::find(modes.states(), i) != modes.states().end()) continue;
    bounds(i, problem.initial[i]);
    if (visited.empty()) continue;
    for (const double share : kAround) {
      const double more = share * visited[i].Width();
      bounds(i, {visited[i].lo - more, visited[i].hi + more});
    }
  }
  return all;
}

}  // namespace rondo::reach::invariants
