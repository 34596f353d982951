#pragma once

#include <mpfr.h>

#include <utility>

#include "expr/rational.h"

/// Interval arithmetic of the checker of certificates, which shares none with the search.
namespace rondo::solve::certify {

/// Is an interval with ends of kBits bits (MPFR), rounded outward by every operation. Ends may be infinite;
/// empty if the lower end is above the upper one. Functions that are not defined everywhere are taken over
/// the part of their domain that is met.
class Enclosure {
 public:
  static constexpr mpfr_prec_t kBits = 64;

  Enclosure();  ///< the whole line
  /// Encloses one number.
  explicit Enclosure(const expr::Rational& value);
  Enclosure(const Enclosure& other);
  Enclosure& operator=(const Enclosure& other);

  bool IsEmpty() const { return mpfr_greater_p(lo_, hi_) != 0; }
  bool HasZero() const { return mpfr_sgn(lo_) <= 0 && mpfr_sgn(hi_) >= 0; }
  bool IsBounded() const { return mpfr_number_p(lo_) != 0 && mpfr_number_p(hi_) != 0; }
  /// Returns two enclosures that together are all of this one, which must be bounded.
  std::pair<Enclosure, Enclosure> Halves() const;
  /// Returns how much of `before` is left, from 0 to 1: for decisions, rounded in any way.
  double Share(const Enclosure& before) const;

  void Clear();  ///< makes it empty
  /// Keeps what is in `other`, too.
  void Meet(const Enclosure& other);
  /// Grows to the smallest interval that holds `other`, too.
  void Join(const Enclosure& other);
  void AtMost(const Enclosure& bound);   ///< meets (-inf, the upper end of `bound`]
  void AtLeast(const Enclosure& bound);  ///< meets [the lower end of `bound`, inf)
  void Integers();                       ///< ends move inward to integers

  // Is something in this below (equal to, above) something in `other`, as far as the ends tell?
  bool MayBeBelow(const Enclosure& other) const { return mpfr_less_p(lo_, other.hi_) != 0; }
  bool MayBeAbove(const Enclosure& other) const { return mpfr_greater_p(hi_, other.lo_) != 0; }
  bool MayBeEqual(const Enclosure& other) const {
    return mpfr_lessequal_p(lo_, other.hi_) != 0 && mpfr_greaterequal_p(hi_, other.lo_) != 0;
  }

  friend Enclosure operator+(const Enclosure& a, const Enclosure& b);
  friend Enclosure operator-(const Enclosure& a, const Enclosure& b);
  friend Enclosure operator*(const Enclosure& a, const Enclosure& b);
  friend Enclosure operator/(const Enclosure& a, const Enclosure& b);  ///< the line if `b` has 0
  friend Enclosure Power(const Enclosure& a, unsigned n);
  /// Encloses a^b as docs/adr/0017-powers.md defines it, "some number" being any.
  friend Enclosure RealPower(const Enclosure& a, const Enclosure& b);
  friend Enclosure Root(const Enclosure& a, unsigned n);  ///< of the part that is not negative
  friend Enclosure Abs(const Enclosure& a);
  friend Enclosure Min(const Enclosure& a, const Enclosure& b);
  friend Enclosure Max(const Enclosure& a, const Enclosure& b);
  /// Is a function of MPFR that is increasing (decreasing) on `a`.
  using Monotone = int (*)(mpfr_t, const mpfr_t, mpfr_rnd_t);
  friend Enclosure Increasing(const Enclosure& a, Monotone f);
  friend Enclosure Decreasing(const Enclosure& a, Monotone f);
  friend Enclosure Log(const Enclosure& a);
  friend Enclosure Sin(const Enclosure& a);
  friend Enclosure Cos(const Enclosure& a);
  friend Enclosure Tan(const Enclosure& a);
  /// Encloses the angle of (x, y), radians: all angles, if they are not told apart; atan2(0, 0) is some
  /// angle.
  friend Enclosure Atan2(const Enclosure& y, const Enclosure& x);
  /// Returns the part of `x` where sin x can lie in `z`: ends are moved over at most a few periods.
  friend Enclosure WhereSin(const Enclosure& z, const Enclosure& x);
  /// Return the part of `a` where a * b can lie in `z`, and where a^n can.
  friend Enclosure WhereTimes(const Enclosure& z, const Enclosure& b, const Enclosure& a);
  friend Enclosure WherePower(const Enclosure& z, unsigned n, const Enclosure& a);

  static Enclosure Interval(long lo, long hi);
  static Enclosure Pi();
  static Enclosure Empty();

 private:
  // The digits lie beside the numbers: nothing is allocated.
  static constexpr size_t kLimbs = (kBits + GMP_NUMB_BITS - 1) / GMP_NUMB_BITS;
  mp_limb_t digits_[2][kLimbs];
  mpfr_t lo_, hi_;
};

}  // namespace rondo::solve::certify
