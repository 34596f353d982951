#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/result.h"
#include "reach/problem/formula.h"
#include "reach/problem/problem.h"

/// Many simulated runs at once, for statistics.
namespace rondo::reach {

/// Runs eight starts of a problem at once, by fourth-order Runge-Kutta, and says which of them break a claim
/// at one of the instants 0, dt, 2 dt, ... Inputs are drawn anew at sixteen instants, uniformly in their
/// bounds, by the start: equal starts have equal runs. Not rigorous.
class BatchJudge {
 public:
  static constexpr size_t kLanes = 8;

  /// Compiles the problem, which must outlive the result. @error if the problem cannot be evaluated.
  static base::Result<BatchJudge> Of(const Problem& problem);

  /// Judges at most kLanes starts: failed[i] for each. A start that is not assumed cannot fail, a run that is
  /// not finite does. `dt` in seconds.
  void Run(std::span<const std::vector<double>> starts, double dt, size_t steps, std::span<bool> failed);

 private:
  using Lanes = std::array<double, kLanes>;
  struct Code {
    Program program;
    std::vector<Lanes> values;
  };
  static void Evaluate(Code& code, std::span<const Lanes> variables);
  void Judge(double time, std::span<const Lanes> x, std::span<bool> failed);

  const Problem* problem_ = nullptr;
  Code rates_, updates_, observed_, assumed_;
  struct Judged {
    Formula formula;
    size_t first = 0;
    double from = 0, to = 0;
  };
  std::vector<Judged> claims_;
  Formula assumption_;
};

}  // namespace rondo::reach
