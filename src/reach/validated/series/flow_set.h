#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "reach/problem/program.h"
#include "reach/validated/series/monomials.h"

/// Sets of states as the engine follows them.
namespace rondo::reach {

/// Is a set of states: { P(s) + G g + b : s in [-1, 1]^m, g in [-1, 1]^k, |b_i| <= slack_i }. P: polynomials
/// in the symbols of the initial set, which keep how states depend on it. G: errors that are carried along
/// linearly (symbolic remainder). slack: errors since the last step.
/// @source Chen & Sankaranarayanan, Decomposed reachability analysis for nonlinear systems (RTSS 2016).
struct FlowSet {
  size_t dimension = 0;
  size_t degree = 1;
  size_t count = 0;                 ///< monomials of degree <= degree
  std::vector<double> polynomials;  ///< by state, `count` each
  Eigen::MatrixXd generators;       ///< G: dimension rows; columns from `used` on mean nothing
  Eigen::Index used = 0;            ///< k: how many columns count
  std::vector<double> slack;        ///< by state

  std::span<const double> Polynomial(size_t i) const {
    return std::span(polynomials).subspan(i * count, count);
  }
  std::span<double> Polynomial(size_t i) { return std::span(polynomials).subspan(i * count, count); }

  /// Returns at least the sum of all errors of state i.
  double Error(size_t i) const;
  /// Raises the degree; the set stays the same.
  void Raise(const Monomials& monomials, size_t to);
  /// Lowers the degree: what was above becomes an error.
  void Lower(const Monomials& monomials, size_t to);
  /// Returns the sum of magnitudes of the terms of the highest degree, of state i.
  double Top(const Monomials& monomials, size_t i) const;

  /// Makes the errors those of { centre x + error }: centre is a double matrix by which errors are mapped,
  /// and the caller replaces P by its image. `errors` are added, by state; roundings are accounted for. The
  /// old slack becomes generators. No more than `capacity` generators stay.
  void Transform(const Eigen::MatrixXd& centre, std::span<const double> errors, Eigen::Index capacity);
  /// Adds a column to G (dimension entries): the set grows by it in both directions.
  void AddGenerator(const Eigen::VectorXd& column);

 private:
  void Compress(Eigen::Index capacity);
};

/// Returns the box as polynomials of degree 1; a symbol for each side that is not a point. symbol_of: by
/// state, -1 for none.
FlowSet FromBox(const interval::Box& box, const Monomials& monomials, const std::vector<int>& symbol_of);

/// Returns the part of the set whose symbol `symbol` is in [-1, 0] or (upper) [0, 1], with a symbol of its
/// own for it.
FlowSet Half(const FlowSet& set, const Monomials& monomials, size_t symbol, bool upper);

/// Encloses a polynomial over [-1, 1]^m.
Interval RangeOf(const Monomials& monomials, std::span<const double> polynomial);

}  // namespace rondo::reach
