#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "reach/validated/series/box_series.h"
#include "reach/validated/series/flow_set.h"
#include "reach/validated/series/model_series.h"
#include "reach/validated/series/transition.h"

/// One step of validated integration as the engine does it: a Taylor series and an a-priori enclosure of its
/// rest.
namespace rondo::reach {

/// States the differential equation x' = f(x, w), time in seconds: states, and inputs that may change at any
/// time within their bounds. The first outputs of the program are the derivatives of the states, in order;
/// further outputs are observed. Variables: states, then inputs.
struct Dynamics {
  Program program;
  size_t states = 0;
  std::vector<Interval> inputs;

  size_t observed() const { return program.outputs.size() - states; }
};

/// Holds what one step needs to be repeated or evaluated again.
struct StepShape {
  double h = 0;      ///< its length in seconds
  size_t order = 8;  ///< of the Taylor series in time
};

/// Takes one step of validated integration. Owns the memory that steps need; one object serves one thread.
/// @source Nedialkov, Jackson & Pryce, An effective high-order interval method for validating existence and
/// uniqueness (2001), for the enclosure; Makino & Berz (2003) for the series.
class Stepper {
 public:
  Stepper(const Dynamics& dynamics, std::shared_ptr<Monomials> monomials, size_t max_order,
          Eigen::Index capacity);

  /// Encloses the flow from `set` for h' <= h seconds, h' as large as it is possible to prove. Returns false
  /// if that is not even so for `least`, or a function is not defined. The results are below.
  bool Advance(const FlowSet& set, double h, double least, size_t order);

  double h() const { return h_; }
  /// Encloses each state during the whole step.
  const interval::Box& during() const { return during_; }
  /// Tell how much the rest of the series in time, the truncation of degrees, and the width of the linear
  /// part added to the error of each state.
  double SeriesError(size_t state) const { return series_error_[state]; }
  double DegreeError(size_t state) const { return degree_error_[state]; }
  double LinearError(size_t state) const { return linear_error_[state]; }
  /// Reports whether some node without derivative is held constant in this step.
  bool HoldsKinks() const { return !sources_.empty(); }
  /// Tells what inputs and held nodes add to the error of a state.
  double InputError(size_t state) const { return input_error_[state]; }
  /// Encloses the derivative of a state during the step, whatever inputs and held nodes do.
  Interval Rate(size_t state) const { return Enclosure().Of(dynamics_.program.outputs[state], 0); }
  /// Encloses output `observed` of the program during [from, to] of the step, loosely (cheap) or by its
  /// polynomial.
  Interval Observed(size_t observed, double from, double to, bool tight);
  /// Encloses the derivative of an output during the step, for all inputs.
  Interval ObservedRate(size_t observed);
  /// Encloses the second derivative of an output during the step; everything, if inputs or held nodes have
  /// anything to do with it.
  Interval ObservedSecond(size_t observed);
  /// Reports whether an output g that is not positive when the step begins stays so, for sure. Shown by g' <=
  /// r g along every trajectory, for some number r: then g(t) <= exp(r t) g(0) (Gronwall). Only for outputs
  /// that are linear in the states, or fall anyway.
  bool StaysBelow(size_t observed);
  /// Makes `next` the set at the end of the step.
  void Finish(const FlowSet& set, FlowSet& next);
  /// Encloses where state i of the solution with these symbols lies at time t (seconds) of the step: for
  /// audits.
  Interval StateAt(size_t state, std::span<const double> symbols, double t) const;

  Monomials& monomials() const { return *monomials_; }

 private:
  /// Computes what `Observed` needs. Returns false if some function is not defined.
  bool Observe();
  bool Series(const FlowSet& set, size_t order);
  bool Begin(const FlowSet& set);
  void Decide(const interval::Box& box);
  /// Reports whether anything but the states drives them. Then `wide_` is the enclosure for all of it.
  bool Driven() const { return !dynamics_.inputs.empty() || !sources_.empty(); }
  const BoxSeries& Enclosure() const { return Driven() ? wide_ : rest_; }
  bool Try(const FlowSet& set, double h);
  bool RangeSeries(double h);
  void GuessBox();
  void GrowBox();
  bool KeepBranches(const FlowSet& set, double h);
  bool EncloseRest();
  bool EncloseLinear(double h);
  std::optional<bool> StaysInside(double h);
  void SumInputErrors(double h);
  Interval Polynomial(size_t node, double from, double to, bool tight) const;
  Interval Rest(size_t node, double to) const;

  const Dynamics& dynamics_;
  std::shared_ptr<Monomials> monomials_;
  size_t order_ = 0;
  size_t states_;
  Eigen::Index capacity_;
  ModelSeries models_;
  BoxSeries rest_;  // nominal inputs, on the enclosure
  BoxSeries wide_;  // all inputs, on the enclosure
  std::vector<Branch> branches_;
  std::vector<Interval> held_;
  std::vector<uint32_t> sources_;
  std::vector<Interval> ranges_;  // of the states' coefficients, by state and order
  std::vector<Interval> gradient_, rates_, observed_gradient_;
  std::vector<Interval> nominal_;
  std::vector<uint32_t> core_outputs_;
  enum class Known : uint8_t { kNot, kDefined, kUndefined } observed_ = Known::kNot;
  Transition transition_;
  double h_ = 0;
  interval::Box series_;  // the polynomials during the step, without errors
  interval::Box box_;     // that the flow does not leave during the step
  interval::Box during_;
  Eigen::VectorXd error_;  // at the start
  Eigen::VectorXd push_;   // how fast inputs drive the state from its nominal trajectory
  Eigen::VectorXd drift_;  // errors during the step
  std::vector<double> input_error_;
  std::vector<double> series_error_, degree_error_, linear_error_;
};

}  // namespace rondo::reach
