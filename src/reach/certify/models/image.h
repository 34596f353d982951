#pragma once

#include "reach/certify/models/evaluate.h"
#include "reach/certify/models/linearise.h"
#include "reach/certify/models/reach_set.h"

/// What a controller or a condition makes of a set, for the checker.
namespace rondo::reach::certify {

/// Encloses the image of a set under a program at one instant. Variables: states, then inputs; each input is
/// any value within its bounds. Maxima and absolute values are sums with an error where their side is open.
class Image {
 public:
  /// Computes the image; the results are below. Returns false if a function is not defined on all of the set.
  bool Of(const Program& program, const ReachSet& set, const interval::Box& inputs);

  /// Encloses an output on the set.
  Interval Range(size_t output) const;
  /// Returns all outputs as a set, in the symbols of the one that was given.
  ReachSet Set() const;

 private:
  bool OfStraight(Program program, uint32_t open, const OnBox& on, const ReachSet& set,
                  const interval::Box& inputs);

  std::shared_ptr<const Basis> basis_;
  std::vector<Model> outputs_;
  std::vector<Interval> boxes_;  ///< of outputs, from intervals
  Eigen::MatrixXd generators_;   ///< by output
  Eigen::VectorXd errors_;       ///< by output, the models' included
};

}  // namespace rondo::reach::certify
