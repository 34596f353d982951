#pragma once

#include "reach/certify/models/errors.h"
#include "reach/certify/models/evaluate.h"
#include "reach/certify/models/reach_set.h"

/// One step of validated integration as the checker does it: by the defect of any polynomial.
namespace rondo::reach::certify {

/// States the differential equation x' = f(x, w), time in seconds, with inputs w that may change at any time.
/// Variables of the program: states, then inputs; outputs: the derivatives.
struct Dynamics {
  Program rates;
  size_t states = 0;
  interval::Box inputs;  ///< bounds of each input
};

/// Says how long a step lasts: `length` seconds, or, where there is a polynomial in s, length * (polynomial
/// +- error): another time for each start.
struct Pace {
  double length = 0;
  std::vector<double> polynomial;
  double error = 0;
};

/// Shows one step of the flow after the fact: any polynomial p(s, t) will do; what it leaves of the equation
/// (its defect, p' - f(p)) and how errors grow is bounded.
///
/// Nothing here is shared with `reach/validated`, which bounds the rest of a Taylor series.
/// @source Corliss & Rihm, Validating an a priori enclosure using high-order Taylor series (1996), for the
/// enclosure; the defect as in Eble & Neher, ACETAF (2003).
class Step {
 public:
  /// @param order  of p in time.
  Step(const Dynamics& dynamics, size_t order);

  /// Follows all of the set for that long. Returns false if that cannot be shown; then the results below mean
  /// nothing.
  bool Take(const ReachSet& set, const Pace& pace);

  /// Returns models of the states and inputs during the step, errors included. Time runs from 0 to 1.
  const std::vector<Model>& during() const { return during_; }
  const Algebra& algebra() const { return *algebra_; }
  /// Encloses states and inputs during the step.
  const interval::Box& region() const { return region_; }
  /// Encloses the derivatives during the step, per second.
  const interval::Box& rates() const { return rates_; }
  /// Returns the set at the end of the step.
  const ReachSet& end() const { return end_; }
  /// Returns how much of the errors at the end is new, by state, roughly: a step that adds much is too long.
  const Eigen::VectorXd& added() const { return added_; }

 private:
  std::optional<std::vector<Model>> Rates(const OnBox& on, std::optional<std::vector<Model>>* lower);
  bool Nominal(const ReachSet& set, const OnBox& on);
  bool Defect(const OnBox& on);
  bool Bound(const ReachSet& set, const OnBox& on, ErrorFlow& flow) const;
  interval::Box Ranges() const;

  const Dynamics& dynamics_;
  size_t order_;
  bool kinks_;
  std::optional<Algebra> algebra_;
  std::vector<Model> during_;
  interval::Box region_, rates_;
  double length_ = 0;
  std::optional<Model> factor_;  ///< by which rates are multiplied, besides the length
  Interval span_;                ///< what the step lasts, seconds
  Push push_;
  Nearby nearby_;
  ReachSet end_;
  Eigen::VectorXd added_;
};

}  // namespace rondo::reach::certify
