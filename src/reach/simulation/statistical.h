#pragma once

#include <cstdint>
#include <functional>

#include "base/stop.h"
#include "interval/interval.h"
#include "reach/simulation/simulator.h"

/// What runs alone can say: learned tubes, and bounds on the probability of failure. Nothing here is a proof.
namespace rondo::reach {

/// Is a tube learned from runs: around the run from the centre, by how much runs from other starts were apart
/// from it. Boxes for each step [k dt, (k + 1) dt]. Not guaranteed to hold anything.
struct SampledTube {
  double dt = 0;  ///< seconds
  std::vector<interval::Box> steps;
};

/// Says how a tube is learned.
enum class Learning : uint8_t {
  /// Verse's formula, for comparison: ten runs from points at random, the upper convex hull of
  /// log-sensitivities.
  kCompat,
  /// The same with runs from corners and centres of faces, too, and slack between samples.
  kCareful,
};

/// Says from how many runs a tube is learned, and how long it is.
struct LearnOptions {
  Learning learning = Learning::kCareful;
  size_t runs = 10;  ///< from points at random
  uint64_t seed = 1;
  double dt = 0.02;  ///< seconds
  size_t steps = 250;
};

/// Learns a tube from runs that begin in `initial`. @error of a run.
/// @source Verse (CAV 2023), DryVR (CAV 2017): piecewise exponential discrepancy.
base::Result<SampledTube> Learn(Simulator& simulator, const interval::Box& initial,
                                const LearnOptions& options);

/// Returns at least the probability that a start leaves the property, with the stated confidence, after
/// `failures` of `runs` independent runs failed: the exact one-sided bound of Clopper and Pearson.
double ClopperPearson(size_t failures, size_t runs, double confidence);
/// Returns how many runs without failure show that the probability of failure is below `epsilon`.
size_t RunsNeeded(double epsilon, double confidence);

/// Tells what independent runs showed.
struct Calibration {
  size_t runs = 0;
  size_t failures = 0;
  double epsilon = 1;  ///< the probability of failure is at most this, with that confidence
  double confidence = 0;
  uint64_t seed = 0;
  std::vector<double> worst;  ///< the first start that failed, if there is one
};

/// Judges a group of starts: failed[i] says whether the run from starts[i] does not do what it should.
using Judge =
    std::function<base::Result<bool>(std::span<const std::vector<double>> starts, std::span<bool> failed)>;

/// Runs from independent starts, uniform in `initial`, judged in groups of at most `group`. Each judge runs
/// in a thread of its own; the starts do not depend on how many there are.
///
/// @error of a judge, or if `stop` asked for the end.
base::Result<Calibration> Calibrate(std::span<const Judge> judges, const interval::Box& initial, size_t runs,
                                    size_t group, double confidence, uint64_t seed,
                                    const base::StopToken& stop);

/// Reports whether the trace stays in the tube at all sampled instants.
bool Inside(const SampledTube& tube, const Trace& trace);

}  // namespace rondo::reach
