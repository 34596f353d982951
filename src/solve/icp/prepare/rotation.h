#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/stop.h"
#include "solve/icp/prepare/polynomial.h"

/// Coordinates in rotated frames, which robots' formulas are full of.
namespace rondo::solve::icp {

/// States that constant + the sum of coefficient * term is 0, whatever the values of the variables. The terms
/// are kept whole, so that they are shared with the rest of the formula.
struct Lemma {
  std::vector<std::pair<expr::Rational, expr::TermId>> parts;
  expr::Rational constant;
};

/// Finds coordinates of rotated vectors in sums: A cos u + B sin u and B cos u - A sin u, and their linear
/// combinations, for vectors (A, B) of polynomials. Sums are rewritten over these coordinates, so that all
/// sums about one vector share them, and the lemma |rotated vector|^2 = |vector|^2 ties them to the vector:
/// without it, interval arithmetic must split the angle to learn that a rotation moves nothing away from the
/// origin. In a chain of frames, |v + d|^2 = |v|^2 + 2 d v + d^2 ties the vector that leaves one frame to the
/// one that enters the next, a link further.
class Rotations {
 public:
  /// @param stop  leaves sums as they are once it asks for that.
  explicit Rotations(expr::Arena& arena, base::StopToken stop = {}) : arena_(arena), stop_(std::move(stop)) {}

  /// Returns an equal formula, its sums rewritten.
  expr::TermId Rewrite(expr::TermId formula);

  /// Returns what ties the frames to each other: of each vector of which both coordinates were met.
  std::vector<Lemma> Lemmas();
  /// Returns what ties the sums of what was rewritten to coordinates, where these say it more shortly than the
  /// sums do, and adds frames for that, of which `Lemmas` tells: lengths of vectors become lengths of the
  /// vectors that they are turned into, one frame after the other.
  std::vector<Lemma> Links();

 private:
  using Rational = expr::Rational;
  using TermId = expr::TermId;
  using Complex = std::pair<Rational, Rational>;
  /// Is A + i B, by monomial.
  using Vector = std::map<expr::Monomial, Complex>;

  /// Is common * (a vector, turned by an angle) + rest: its first coordinate there.
  struct Split {
    TermId angle;
    expr::Monomial common;
    Vector vector;
    expr::Polynomial rest;
  };

  struct Frame {
    Vector vector;
    TermId a, b;  ///< the vector
    TermId p, q;  ///< its coordinates in the rotated frame
    bool both = false;
    mutable std::optional<expr::Polynomial> length;  ///< once it was asked for; see LengthOf
  };

  /// Is the square of a vector: a sum of two squares of monic terms, with their factors.
  struct Norm {
    std::array<std::pair<Rational, TermId>, 2> squares;
    TermId sum;
  };

  static constexpr size_t kMostMonomials = 64;

  bool IsTotal(TermId term) const;
  bool IsWave(TermId t) const;  // a sine or cosine
  std::set<TermId> AnglesOf(const expr::Polynomial& polynomial) const;
  TermId RewriteSum(TermId sum);
  TermId RewriteAngle(const expr::Polynomial& polynomial, TermId angle);
  Frame& FrameOf(TermId angle, const Vector& vector, Complex& ratio);
  TermId Square(TermId term);
  Norm NormOf(TermId a, TermId b);
  void Translations(const std::vector<Norm>& norms, std::vector<Lemma>& lemmas);
  TermId Part(const Vector& vector, bool imaginary);

  // In rotation_links.cc.
  bool IsPlace(const expr::Monomial& m) const;
  std::optional<expr::Polynomial> Over(TermId term);
  std::optional<expr::Polynomial> NewOver(TermId term);
  std::optional<expr::Polynomial> Expanded(TermId term);
  std::optional<Split> Outermost(const expr::Polynomial& polynomial);
  std::optional<Split> SplitBy(const expr::Polynomial& polynomial, TermId angle);
  expr::Polynomial Turned(Split split);
  void Turn(expr::Polynomial& sum);
  bool TurnTwice(expr::Polynomial& sum);
  static std::pair<expr::Polynomial, expr::Polynomial> PartsOf(const Vector& vector);
  static const expr::Polynomial& LengthOf(const Frame& frame);
  static std::optional<Rational> TimesIn(const expr::Polynomial& polynomial, const expr::Polynomial& length);
  void Shorten(expr::Polynomial& polynomial);
  Lemma Link(TermId sum, const expr::Polynomial& polynomial);

  expr::Arena& arena_;
  base::StopToken stop_;
  std::map<TermId, std::deque<Frame>> frames_;  // by angle
  std::vector<TermId> rewritten_;
  std::map<TermId, std::optional<expr::Polynomial>> over_, expanded_;
};

}  // namespace rondo::solve::icp
