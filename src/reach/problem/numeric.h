#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/stop.h"
#include "reach/problem/formula.h"
#include "reach/problem/problem.h"

/// Trajectories in double precision: they find refutations and samples, and prove nothing.
namespace rondo::reach {

/// Evaluates programs in double precision: for search, samples and pictures. Nothing here is rigorous.
class Evaluator {
 public:
  explicit Evaluator(const Program& program) : program_(program), values_(program.code.size()) {}
  /// Computes the outputs for these values of the variables; NaN where a function has no value.
  void operator()(std::span<const double> variables, std::span<double> outputs);

 private:
  const Program& program_;
  std::vector<double> values_;
};

/// Says how a trajectory is chosen among those that are possible.
struct Execution {
  std::vector<double> start;  ///< the value of each state at time 0
  /// Values of the inputs, held for `input_period` seconds each; the last one stays. Empty: the middles.
  std::vector<std::vector<double>> inputs;
  double input_period = 0.1;
};

/// Is the instant at which a claim fails by a margin, along a trajectory; or, where none does, at which one
/// came nearest to failing.
struct Violation {
  size_t claim = 0;  ///< its index in the problem
  double time = 0;   ///< seconds
  double miss = 0;   ///< by how much the claim fails (`Formula::Miss`); 0 or less: it holds
  std::vector<double> state;
};

/// Integrates trajectories of a problem to near machine precision (Runge-Kutta-Fehlberg 7(8), Boost.Odeint).
/// Not rigorous; serves one thread.
class Trajectories {
 public:
  /// Compiles the problem, which must outlive the result. @error if the problem uses what cannot be
  /// evaluated.
  static base::Result<Trajectories> Of(const Problem& problem);

  /// Calls `visit` with increasing times, the start (as the controller leaves it), both sides of each later
  /// sampling instant and of each event and the horizon included, at most `resolution` seconds apart, until
  /// it returns false. An event whose condition holds for less than that may be missed. False if the state is
  /// not finite any more, or if events follow one another without end, or as if.
  bool Run(const Execution& execution, double resolution,
           const std::function<bool(double, std::span<const double>)>& visit, double tolerance = 1e-13);
  /// Returns how far claim `c` is from holding in this state; 0 or less if it holds.
  double Miss(size_t c, std::span<const double> state);
  /// Returns how far the start is from what is assumed; 0 or less if it is.
  double MissAssumed(std::span<const double> state);
  size_t claims() const { return claims_.size(); }
  const Problem& problem() const { return *problem_; }
  /// Returns the worst miss over all claims along a trajectory, at the instants that `Run` visits; stops at
  /// the first that exceeds `margin`. If nothing was looked at, its miss is -1e300.
  Violation Worst(const Execution& execution, double resolution, double margin, double tolerance,
                  const base::StopToken& stop);

 private:
  struct Compiled {
    Formula formula;
    Program program;
  };
  struct Happening {
    Compiled condition;
    Program after;
  };
  double MissOf(const Compiled& compiled, std::span<const double> state);
  bool Happens(const std::vector<double>& state, std::vector<double>& next);
  bool Settle(std::vector<double>& state);

  const Problem* problem_ = nullptr;
  Program rates_, updates_;
  std::vector<Compiled> claims_;
  std::vector<Compiled> assumed_;
  std::vector<Happening> events_;
};

}  // namespace rondo::reach
