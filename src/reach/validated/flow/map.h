#pragma once

#include <memory>
#include <vector>

#include "reach/validated/series/box_series.h"
#include "reach/validated/series/flow_set.h"

/// What happens to a set at one instant: controllers, and expressions about the state.
namespace rondo::reach {

/// Computes images of sets under a program: what a controller computes at an instant, or an expression about
/// the state. Variables: states, then inputs that can be anything within their bounds. Where it is not known on
/// which side of a kink the set lies, a maximum or an absolute value is one linear function for polynomials and
/// errors alike, and a number that may be different at each point (`ReplaceKink`); a choice is either value.
class Map {
 public:
  Map(const Program& program, size_t states, std::vector<Interval> inputs,
      std::shared_ptr<Monomials> monomials);

  /// Computes the images of the set; the results are below. Returns false if some function is not defined on
  /// all of the set.
  bool Apply(const FlowSet& set);
  /// Encloses an output on the set, correlations of errors included.
  Interval Range(size_t output) const;
  /// Makes `next` the set of outputs, which must be as many as the states. No more than `capacity` generators
  /// stay.
  void Finish(const FlowSet& set, FlowSet& next, Eigen::Index capacity) const;

 private:
  bool Replace(const FlowSet& set);

  /// Takes the place of this one while kinks are replaced.
  std::unique_ptr<Map> replacement_;
  Program replaced_;  ///< what that computes
  const Program& program_;
  size_t states_;
  std::vector<Interval> inputs_;
  std::shared_ptr<Monomials> monomials_;
  ModelSeries models_;
  BoxSeries box_;
  std::vector<Branch> branches_;
  std::vector<Interval> held_;
  std::vector<Interval> gradient_;
  Eigen::MatrixXd centre_, radius_;
  Eigen::VectorXd error_;
  Eigen::MatrixXd images_;    ///< of generators and slack
  std::vector<double> more_;  ///< errors that are new, by output
};

}  // namespace rondo::reach
