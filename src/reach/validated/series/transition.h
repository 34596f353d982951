#pragma once

#include <Eigen/Dense>
#include <span>

#include "interval/interval.h"

/// How errors are carried along by a step: transition matrices of linear differential equations.
namespace rondo::reach {

using interval::Interval;

/// Encloses the solutions at time h of J' = A(t) J, J(0) = I, for every A(t) that stays in an interval
/// matrix.
struct Transition {
  Eigen::MatrixXd centre, radius;  ///< J(h) = centre +- radius
  Eigen::MatrixXd growth;          ///< |J(t)| <= growth for all t in [0, h]
};

/// Encloses these solutions for h seconds.
///
/// @param rates  n x n intervals, by rows, per second.
/// @source Peano-Baker series, halved until it converges fast, then squared.
void Propagate(std::span<const Interval> rates, size_t n, double h, Transition& out);

}  // namespace rondo::reach
