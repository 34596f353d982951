#pragma once

#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "reach/certify/models/model.h"

/// Sets of states as the checker follows them.
namespace rondo::reach::certify {

/// Is a set of states: { P(s) + G g : s in [-1, 1]^m, g in [-1, 1]^k }. P: a polynomial for each state, which
/// keeps how states depend on the start; the columns of G are errors that go the way of the states.
struct ReachSet {
  std::shared_ptr<const Basis> basis;
  std::vector<std::vector<double>> polynomials;  ///< by state, by monomial
  Eigen::MatrixXd generators;                    ///< G: a row for each state, a column for each error

  /// Returns how many columns are worth their time, for so many states.
  static Eigen::Index MostColumns(size_t states) { return 100 * static_cast<Eigen::Index>(states); }

  size_t states() const { return polynomials.size(); }
  /// Returns, by state, at least how far a member is from its polynomial.
  Eigen::VectorXd Errors() const;
  /// Adds errors, at most these by state, that have nothing to do with one another: a column for each.
  void AddErrors(const Eigen::VectorXd& errors);
  /// Makes a box of the smaller columns if there are more than `most`. The set becomes no smaller.
  /// @source Girard, Reachability of uncertain linear systems using zonotopes (HSCC 2005).
  void Reduce(Eigen::Index most);
  /// Rewrites the polynomials over other monomials: of a higher degree, or what is above becomes an error.
  void SetBasis(std::shared_ptr<const Basis> to);
  /// Returns the part whose symbol is in [-1, 0] or (upper) [0, 1], with a symbol of its own in its place.
  ReachSet Half(size_t symbol, bool upper) const;
  /// Encloses the polynomial of a state, errors left out.
  Interval RangeOf(size_t state) const;
  /// Encloses the set, errors included.
  interval::Box Box() const;
};

/// Returns, by state, at least how far it gets in this time (seconds) at these rates (per second).
Eigen::VectorXd DistanceIn(double seconds, const interval::Box& rates);

}  // namespace rondo::reach::certify
