#pragma once

#include "base/stop.h"
#include "reach/validated/flow/stepper.h"

/// Validated integration over many steps: the lengths of steps and the degrees of polynomials are found on
/// the way.
namespace rondo::reach {

/// Says how to integrate. The defaults suit sets of any size; an engine that knows better may change them.
struct FlowOptions {
  size_t order = 0;         ///< of Taylor series in time; 0: 8, or 20 for a single point
  size_t least_degree = 1;  ///< of polynomials in the initial state
  size_t most_degree = 10;
  size_t most_monomials = 800;   ///< a bound on the cost of a degree
  size_t cheap_monomials = 400;  ///< degrees with more are only for errors far beyond the tolerance
  double first_step = 1e-3;      ///< seconds, as the next two
  double most_step = 0.25;
  double least_step = 1e-9;
  /// How much one step may add to errors, for its share of the horizon: relative to the set's radius, by the
  /// rest of the series in time, by the truncation of degrees and by the width of the linear part, ...
  double series_tolerance = 1e-5;
  double degree_tolerance = 0.0012;
  double linear_tolerance = 0.05;
  /// ... or to the state's magnitude, whatever is more.
  double floor = 1e-11;
  Eigen::Index generators_per_state = 100;  ///< how many generators are kept, for each state
};

/// Follows a set along the flow, with step and degree as they are needed.
class Flow {
 public:
  /// @param horizon  seconds, > 0; what tolerances are shares of.
  Flow(const Dynamics& dynamics, std::shared_ptr<Monomials> monomials, FlowOptions options, double horizon);

  /// Begins with this set at this time, in seconds.
  void Start(FlowSet set, double time);
  /// Takes one step, at most to `until`; meeting it, the set encloses the states at the instant that `until`
  /// is the rounded value of. Returns false if no step of the least length can be enclosed: the set is lost.
  bool Step(double until);

  const FlowSet& set() const { return set_; }
  FlowSet& set() { return set_; }
  double time() const { return time_; }    ///< after the step, in seconds
  double begin() const { return begin_; }  ///< of the step
  Stepper& stepper() { return stepper_; }
  size_t steps() const { return steps_; }
  /// Encloses the states now.
  interval::Box Now() const;
  /// Returns what the length of the next step should be like, in seconds.
  double next_step() const { return h_; }
  /// Makes `set` usable elsewhere, where it is what the last step began with: the roundings of the steps up
  /// to there become errors.
  void Settle(FlowSet& set) const { Settle(set, begin_); }

 private:
  void Settle(FlowSet& set, double time) const;
  bool IsWorthIt(double excess) const;
  void AdaptDegree();

  FlowOptions options_;
  double horizon_;
  Stepper stepper_;
  FlowSet set_, next_;
  double time_ = 0, begin_ = 0, h_;
  size_t steps_ = 0;
  size_t since_event_ = 0;  ///< steps since `until` was met
  double largest_ = 0;      ///< magnitude of any state in the last step
  size_t calm_ = 0;         ///< steps since the degree was more than needed
};

}  // namespace rondo::reach
