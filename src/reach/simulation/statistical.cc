#include "reach/simulation/statistical.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <memory>
#include <mutex>
#include <random>

#include "base/parallel.h"

namespace rondo::reach {

namespace {

constexpr size_t kGroups = 64;  // of starts that each judge gets at once

double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::vector<double> Draw(const interval::Box& box, std::mt19937_64& random) {
  std::vector<double> x;
  for (const interval::Interval& side : box) x.push_back(side.lo + Uniform(random) * (side.hi - side.lo));
  return x;
}

// The upper convex hull of (time, value) points, evaluated at the points' times.
std::vector<double> UpperHull(const std::vector<double>& time, const std::vector<double>& value) {
  std::vector<size_t> hull;
  for (size_t i = 0; i < time.size(); ++i) {
    while (hull.size() >= 2) {
      const size_t a = hull[hull.size() - 2];
      const size_t b = hull.back();
      const double cross =
          (time[b] - time[a]) * (value[i] - value[a]) - (value[b] - value[a]) * (time[i] - time[a]);
      if (cross < 0) break;
      hull.pop_back();
    }
    hull.push_back(i);
  }
  std::vector<double> result(time.size());
  size_t edge = 0;
  for (size_t i = 0; i < time.size(); ++i) {
    while (edge + 2 < hull.size() && time[hull[edge + 1]] <= time[i]) ++edge;
    if (hull.size() == 1) {
      result[i] = value[hull[0]];
      continue;
    }
    const size_t a = hull[edge];
    const size_t b = hull[edge + 1];
    result[i] = value[a] + (value[b] - value[a]) * (time[i] - time[a]) / (time[b] - time[a]);
  }
  return result;
}

}  // namespace

base::Result<SampledTube> Learn(Simulator& simulator, const interval::Box& initial,
                                const LearnOptions& options) {
  const size_t n = initial.size();
  std::vector<double> centre, radius;
  for (const interval::Interval& side : initial) {
    centre.push_back(side.Middle());
    radius.push_back(side.Width() / 2);
  }
  const double largest = *std::max_element(radius.begin(), radius.end());
  std::vector<std::vector<double>> starts{centre};
  std::mt19937_64 random(options.seed);
  for (size_t k = 0; k < options.runs; ++k) starts.push_back(Draw(initial, random));
  const bool careful = options.learning == Learning::kCareful;
  if (careful) {
    for (size_t i = 0; i < n; ++i) {
      if (radius[i] == 0) continue;
      for (const double sign : {-1.0, 1.0}) {
        starts.push_back(centre);
        starts.back()[i] += sign * radius[i];
      }
    }
    for (size_t k = 0; k < 64; ++k) {
      std::vector<double> corner = centre;
      for (size_t i = 0; i < n; ++i)
        corner[i] += ((n <= 6 ? k >> i : random()) & 1) != 0 ? radius[i] : -radius[i];
      if (n > 6 || k < (size_t{1} << n)) starts.push_back(corner);
    }
  }
  std::vector<Trace> traces;
  for (const auto& start : starts) {
    auto trace = simulator.Run(start, options.dt, options.steps);
    if (!trace.ok()) return trace.error();
    traces.push_back(std::move(trace).value());
  }
  // Distances of starts: the largest over the sides that have a width, in units of half of it.
  const auto apart = [&](size_t a, size_t b) {
    double d = 0;
    for (size_t i = 0; i < n; ++i) {
      if (radius[i] > 0) d = std::max(d, std::fabs(starts[a][i] - starts[b][i]) / radius[i]);
    }
    return d + 1e-10;
  };
  std::vector<std::vector<double>> width(n, std::vector<double>(options.steps + 1));
  std::vector<double> time(options.steps + 1), value(options.steps + 1);
  for (size_t k = 0; k <= options.steps; ++k) time[k] = options.dt * static_cast<double>(k);
  for (size_t i = 0; i < n; ++i) {
    const double unit = radius[i] > 0 ? radius[i] : std::max(largest, 1e-12);
    for (size_t k = 0; k <= options.steps; ++k) {
      double most = 1e-6;
      for (size_t a = 0; a < traces.size(); ++a) {
        for (size_t b = a + 1; b < traces.size(); ++b)
          most = std::max(most, std::fabs(traces[a][k * n + i] - traces[b][k * n + i]) / unit / apart(a, b));
      }
      if (k == 0 && radius[i] > 0) most = 1;
      value[k] = std::log(most);
    }
    const std::vector<double> hull = UpperHull(time, value);
    for (size_t k = 0; k <= options.steps; ++k) width[i][k] = unit * std::exp(hull[k]) * (1 + 1e-9);
  }
  SampledTube tube;
  tube.dt = options.dt;
  for (size_t k = 0; k < options.steps; ++k) {
    interval::Box box(n);
    for (size_t i = 0; i < n; ++i) {
      const double a = traces[0][k * n + i];
      const double b = traces[0][(k + 1) * n + i];
      double slack = 0;
      if (careful) {
        // Between two samples a run bends by about an eighth of its second difference; twice that.
        for (const Trace& t : traces) {
          const size_t j = std::min(std::max<size_t>(k, 1), options.steps - 1);
          const double bend = t[(j - 1) * n + i] - 2 * t[j * n + i] + t[(j + 1) * n + i];
          slack = std::max(slack, std::fabs(bend) / 4);
        }
      }
      box[i] = {std::min(a - width[i][k], b - width[i][k + 1]) - slack,
                std::max(a + width[i][k], b + width[i][k + 1]) + slack};
    }
    tube.steps.push_back(std::move(box));
  }
  return tube;
}

double ClopperPearson(size_t failures, size_t runs, double confidence) {
  if (runs == 0 || failures >= runs) return 1;
  return boost::math::ibeta_inv(static_cast<double>(failures) + 1, static_cast<double>(runs - failures),
                                confidence);
}

size_t RunsNeeded(double epsilon, double confidence) {
  return static_cast<size_t>(std::ceil(std::log(1 - confidence) / std::log1p(-epsilon)));
}

base::Result<Calibration> Calibrate(std::span<const Judge> judges, const interval::Box& initial, size_t runs,
                                    size_t group, double confidence, uint64_t seed,
                                    const base::StopToken& stop) {
  Calibration result;
  result.confidence = confidence;
  result.seed = seed;
  std::mutex mutex;
  std::string trouble;
  size_t first_failure = runs;
  // All starts come from one stream, whatever the number of threads; some at a time, so that many of them need no memory and
  // nobody waits for them.
  std::mt19937_64 random(seed);
  std::vector<std::vector<double>> starts;
  const size_t most = judges.size() * group * kGroups;
  for (size_t begin = 0; begin < runs && trouble.empty(); begin += most) {
    starts.clear();
    for (size_t r = begin; r < std::min(runs, begin + most); ++r) starts.push_back(Draw(initial, random));
    const size_t groups = (starts.size() + group - 1) / group;
    base::ParallelFor(judges.size(), static_cast<unsigned>(judges.size()), [&](size_t j) {
      const auto failed = std::make_unique<bool[]>(group);
      for (size_t g = j; g < groups; g += judges.size()) {
        const size_t first = g * group;
        const size_t count = std::min(group, starts.size() - first);
        const bool stopped = stop.StopRequested();
        const auto judged =
            stopped ? base::Result<bool>(base::Error{"stopped"})
                    : judges[j](std::span(starts).subspan(first, count), std::span(failed.get(), count));
        const std::scoped_lock lock(mutex);
        if (!judged.ok()) {
          trouble = judged.error().message;
          return;
        }
        result.runs += count;
        for (size_t i = 0; i < count; ++i) {
          if (!failed[i]) continue;
          ++result.failures;
          if (begin + first + i > first_failure) continue;
          first_failure = begin + first + i;
          result.worst = starts[first + i];
        }
      }
    });
  }
  if (!trouble.empty()) return base::Error{trouble};
  result.epsilon = ClopperPearson(result.failures, result.runs, confidence);
  return result;
}

bool Inside(const SampledTube& tube, const Trace& trace) {
  if (tube.steps.empty()) return true;
  const size_t n = tube.steps[0].size();
  for (size_t k = 0; k <= tube.steps.size(); ++k) {
    const interval::Box& box = tube.steps[std::min(k, tube.steps.size() - 1)];
    for (size_t i = 0; i < n; ++i) {
      if (!box[i].Contains(trace[k * n + i])) return false;
    }
  }
  return true;
}

}  // namespace rondo::reach
