#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "solve/icp/polynomial.h"

namespace rondo::solve::icp {

/// Finds coordinates of rotated vectors in sums: A cos u + B sin u and B cos u - A sin u, and their linear
/// combinations, for vectors (A, B) of polynomials. Sums are rewritten over these coordinates, so that all
/// sums about one vector share them, and the lemma |rotated vector|^2 = |vector|^2 ties them to the vector:
/// without it, interval arithmetic must split the angle to learn that a rotation moves nothing away from the
/// origin.
class Rotations {
 public:
  explicit Rotations(expr::Arena& arena) : arena_(arena) {}

  /// An equal formula, its sums rewritten.
  expr::TermId Rewrite(expr::TermId formula);

  /// Equations that hold for all values: one for each vector of which both coordinates were met.
  std::vector<expr::TermId> Lemmas();

 private:
  using Rational = expr::Rational;
  using TermId = expr::TermId;
  using Complex = std::pair<Rational, Rational>;
  /// A + i B, by monomial.
  using Vector = std::map<Monomial, Complex>;

  struct Frame {
    Vector vector;
    TermId a, b;  ///< the vector
    TermId p, q;  ///< its coordinates in the rotated frame
    bool both = false;
  };

  bool IsTotal(TermId term) const;
  TermId RewriteSum(TermId sum);
  TermId RewriteAngle(const Polynomial& polynomial, TermId angle);
  Frame& FrameOf(TermId angle, const Vector& vector, Complex& ratio);
  TermId Square(TermId term);
  TermId Part(const Vector& vector, bool imaginary);

  expr::Arena& arena_;
  std::map<TermId, std::vector<Frame>> frames_;  // by angle
};

}  // namespace rondo::solve::icp
