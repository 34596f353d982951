#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "reach/problem/numeric.h"

/// What can be run, and how: models, programs and libraries of the user's.
namespace rondo::reach {

/// Holds the states of one run at the instants 0, dt, 2 dt, ...: one row of `dimension` numbers for each.
using Trace = std::vector<double>;

/// Is something that can be run from a start: a model, or a black box. Nothing is known of it but its runs.
class Simulator {
 public:
  Simulator() = default;
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;
  virtual ~Simulator() = default;
  /// Returns the number of states.
  virtual size_t dimension() const = 0;
  /// Runs it once and returns `steps` + 1 rows, `dt` seconds apart, of which the first is the start.
  ///
  /// @error if the run ends early or its numbers are not finite.
  virtual base::Result<Trace> Run(std::span<const double> start, double dt, size_t steps) = 0;
};

/// Returns a problem as a simulator: fourth-order Runge-Kutta with `substeps` in each step, inputs in the
/// middle of their bounds. Many of them may run at once.
///
/// @error if the problem cannot be evaluated, or has events.
base::Result<std::unique_ptr<Simulator>> SimulatorOf(const Problem& problem, size_t substeps = 1);

/// Returns a program of the user's. For each run one line is written to its standard input: the number of
/// steps, dt in seconds, and the start; it answers with steps + 1 lines, the state at each instant. It is
/// started once and ends when its input does.
///
/// @error if it cannot be started.
base::Result<std::unique_ptr<Simulator>> ProcessSimulator(const std::string& command, size_t dimension);

/// Returns a shared library of the user's with the function of rondo_simulator.h.
///
/// @error if it cannot be loaded or lacks the function.
base::Result<std::unique_ptr<Simulator>> LibrarySimulator(const std::string& path, size_t dimension);

}  // namespace rondo::reach
