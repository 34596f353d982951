#pragma once

#include <optional>
#include <span>
#include <vector>

#include "reach/certify/models/basis.h"
#include "reach/certify/models/upward.h"
#include "reach/problem/program.h"

/// Taylor models in the start and the time of a step, and rigorous arithmetic with them.
namespace rondo::reach::certify {

/// Is a Taylor model in the symbols s in [-1, 1]^m and the time t in [0, 1] of a step: the functions f with
/// |f(s, t) - p(s, t)| <= error everywhere, where p is a polynomial.
struct Model {
  std::vector<double> polynomial;  ///< by monomial in s: by power of t (`order` + 1 of them)
  double error = 0;
  // Derived from the polynomial (Algebra::Seal).
  std::vector<uint8_t> length;  ///< by monomial: powers of t that may occur are below this
  std::vector<double> norms;    ///< sums of magnitudes, by degree in s and power of t
  double norm = 0;              ///< at least the sum of all magnitudes
  std::vector<Model> stages;    ///< of a function: the results of Horner's scheme, for the next limit
};

/// Computes with models, rigorously: what is cut off and every rounding go to the errors.
/// @source Berz & Makino, Verified integration of ODEs and flows using differential algebraic methods on
/// high-order Taylor models (1998); Makino & Berz, Taylor models and other validated functional inclusion
/// methods (2003).
class Algebra {
 public:
  static constexpr size_t kMostOrder = 31;
  /// @param order  highest power of t, below 32.
  Algebra(const Basis& basis, size_t order) : basis_(basis), order_(order), limit_(order) {}

  const Basis& basis() const { return basis_; }
  size_t order() const { return order_; }
  /// Cuts off powers of t above this from now on; at most `order`.
  void Limit(size_t limit) { limit_ = limit; }

  /// Derives the rest of the model from its polynomial. To be called after a polynomial has been written.
  void Seal(Model& model) const;
  /// Returns the model of a number that lies in the interval, at all symbols and times.
  Model Constant(Interval value) const;
  /// Returns the model of a polynomial in s, whose degree is not above that of the basis; by monomial.
  Model InSymbols(std::span<const double> polynomial) const;
  /// Returns constant + the sum of factor * models[node].
  Model Linear(std::span<const LinearPart> parts, const LinearPart& constant,
               const std::vector<Model>& models) const;
  /// Returns the model of a * b: whatever a and b hold, their product is in it.
  Model Product(const Model& a, const Model& b) const;
  /// Returns the same, roughly: errors are not bounded. `lower`: what it was at the limit before, of which
  /// all powers of t are taken over.
  Model NextPower(const Model& a, const Model& b, const Model& lower) const;
  /// Returns the model of a function of one variable (kReciprocal ... kAtan); nothing if it is not defined
  /// everywhere on the argument. Its Taylor polynomial about a number, with Lagrange's remainder.
  ///
  /// @param lower  what it was at the limit before: then it is found roughly, as by NextPower.
  std::optional<Model> Function(CodeOp function, const Model& a, const Model* lower = nullptr) const;
  /// Returns the angle of (x, y) in (-pi, pi), radians; nothing if it cannot be told to stay in there.
  std::optional<Model> Angle(const Model& y, const Model& x) const;
  /// Returns slope * a + offset.
  Model Affine(double slope, const Model& a, Interval offset) const;
  /// Returns a model that holds whatever a or b hold.
  Model Either(const Model& a, const Model& b) const;

  /// Encloses the values over all symbols and times, at little cost.
  Interval Bounds(const Model& model) const;
  /// Encloses the values for t in [from, to], parts of [0, 1], over all symbols.
  Interval Range(const Model& model, double from, double to) const;

 private:
  size_t stride() const { return order_ + 1; }
  Model Empty() const;
  Interval RangeFrom(size_t first, const Model& model, double from, double to) const;
  double CutOff(const Model& a, const Model& b) const;

  const Basis& basis_;
  size_t order_, limit_;
};

/// Encloses g^(k)(x) / k! for every x in `at`, for k = 0 .. out.size() - 1. Returns false if the function g
/// is not smooth on all of `at`.
bool TaylorCoefficients(CodeOp function, Interval at, std::span<Interval> out);
/// Returns at least |g^(k)(x) / k!| for every x in `at`, k >= 1, g the arctangent: sharper than
/// TaylorCoefficients.
double ArctangentBound(Interval at, size_t k);

}  // namespace rondo::reach::certify
