#pragma once

#include <Eigen/Dense>
#include <vector>

namespace rondo::reach::certify {

/// Rates of errors over a step whose time runs from 0 to 1: |A - centre| <= radius by entry.
struct ErrorRates {
  Eigen::MatrixXd centre, radius;
};

/// What pushes: |d(t)| <= sum over a of by_power[a] t^a, by state.
struct Push {
  std::vector<Eigen::VectorXd> by_power;
};

struct ErrorFlow {
  Eigen::MatrixXd generators;  ///< at the end
  Eigen::VectorXd most;        ///< |e(t)| for all t in [0, 1]
  Eigen::VectorXd added;       ///< what is new among the errors at the end, roughly
};

/// Encloses every solution of e' = A(t) e + d(t), with A and d as above, that starts in { G g : |g| <= 1 }.
///
/// For pieces of [0, 1]: e = M(t) G g + r, where M is a polynomial near exp(centre t). Then r' = A r + (A M -
/// M') G g + d and r(0) = 0, so that |r| grows no faster than its bound with |A| (Gronwall).
/// @return false if rates are so large that too many pieces were needed.
bool PropagateErrors(const ErrorRates& rates, const Eigen::MatrixXd& generators, const Push& push,
                     ErrorFlow& out);

}  // namespace rondo::reach::certify
