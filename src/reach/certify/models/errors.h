#pragma once

#include <Eigen/Dense>
#include <vector>

/// How errors grow along a step: linear differential inequalities in matrices of doubles.
namespace rondo::reach::certify {

/// Bounds the rates of errors over a step whose time runs from 0 to 1: |A - centre| <= radius by entry.
struct ErrorRates {
  Eigen::MatrixXd centre, radius;
};

/// Bounds what pushes the errors apart from themselves: |d(t)| <= sum over a of by_power[a] t^a, by state.
struct Push {
  std::vector<Eigen::VectorXd> by_power;
};

/// Is what errors become over a step.
struct ErrorFlow {
  /// Spans the errors at the end: the generators at the start, carried along, and new ones along the axes.
  Eigen::MatrixXd generators;
  Eigen::VectorXd most;   ///< by state: at least |e(t)| for all t in [0, 1]
  Eigen::VectorXd added;  ///< by state: what is new among the errors at the end, roughly
};

/// Encloses every solution of e' = A(t) e + d(t), with A and d as above, that starts in { G g : |g| <= 1 }.
///
/// For pieces of [0, 1]: e = M(t) G g + r, where M is a polynomial near exp(centre t). Then r' = A r + (A M -
/// M') G g + d and r(0) = 0, so that |r| grows no faster than its bound with |A| (Gronwall).
/// @return false if rates are so large that too many pieces were needed, or bounds are not finite.
bool PropagateErrors(const ErrorRates& rates, const Eigen::MatrixXd& generators, const Push& push,
                     ErrorFlow& out);

}  // namespace rondo::reach::certify
