#pragma once

#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "reach/certify/models/model.h"

namespace rondo::reach::certify {

/// A set of states: { P(s) + G g : s in [-1, 1]^m, g in [-1, 1]^k }. P: a polynomial for each state; the
/// columns of G are errors that go the way of the states.
struct ReachSet {
  std::shared_ptr<const Basis> basis;
  std::vector<std::vector<double>> polynomials;  ///< by state, by monomial
  Eigen::MatrixXd generators;

  /// How many columns are worth their time.
  static Eigen::Index MostColumns(size_t states) { return 100 * static_cast<Eigen::Index>(states); }

  size_t states() const { return polynomials.size(); }
  /// At least how far a member is from its polynomial, by state.
  Eigen::VectorXd Errors() const;
  /// Further errors, by state, that have nothing to do with one another.
  void AddErrors(const Eigen::VectorXd& errors);
  /// If there are more columns than this: the smaller ones become a box.
  /// @source Girard, Reachability of uncertain linear systems using zonotopes (HSCC 2005).
  void Reduce(Eigen::Index most);
  /// Other monomials: of a higher degree, or what is above becomes an error.
  void SetBasis(std::shared_ptr<const Basis> to);
  /// The part whose symbol is in [-1, 0] or [0, 1], with a symbol of its own in its place.
  ReachSet Half(size_t symbol, bool upper) const;
  /// The polynomial of a state at no particular time.
  Interval RangeOf(size_t state) const;
  /// Encloses the set.
  interval::Box Box() const;
};

/// At least how far each state gets in this time.
Eigen::VectorXd DistanceIn(double seconds, const interval::Box& rates);

}  // namespace rondo::reach::certify
