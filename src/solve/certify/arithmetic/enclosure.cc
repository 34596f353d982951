#include "solve/certify/arithmetic/enclosure.h"

#include <algorithm>
#include <string>

namespace rondo::solve::certify {

Enclosure::Enclosure() {
  mpfr_custom_init(digits_[0], kBits);
  mpfr_custom_init(digits_[1], kBits);
  mpfr_custom_init_set(lo_, -MPFR_INF_KIND, 0, kBits, digits_[0]);
  mpfr_custom_init_set(hi_, MPFR_INF_KIND, 0, kBits, digits_[1]);
}

Enclosure::Enclosure(const expr::Rational& value) : Enclosure() {
  mpq_t q;
  mpq_init(q);
  const std::string text = value.Numerator() + "/" + value.Denominator();
  mpq_set_str(q, text.c_str(), 10);
  mpfr_set_q(lo_, q, MPFR_RNDD);
  mpfr_set_q(hi_, q, MPFR_RNDU);
  mpq_clear(q);
}

Enclosure::Enclosure(const Enclosure& other) : Enclosure() { *this = other; }

Enclosure& Enclosure::operator=(const Enclosure& other) {
  if (this == &other) return *this;
  mpfr_set(lo_, other.lo_, MPFR_RNDD);
  mpfr_set(hi_, other.hi_, MPFR_RNDU);
  return *this;
}

Enclosure Enclosure::Interval(long lo, long hi) {
  Enclosure r;
  mpfr_set_si(r.lo_, lo, MPFR_RNDD);
  mpfr_set_si(r.hi_, hi, MPFR_RNDU);
  return r;
}

Enclosure Enclosure::Empty() {
  Enclosure r;
  r.Clear();
  return r;
}

Enclosure Enclosure::Pi() {
  Enclosure r;
  mpfr_const_pi(r.lo_, MPFR_RNDD);
  mpfr_const_pi(r.hi_, MPFR_RNDU);
  return r;
}

std::pair<Enclosure, Enclosure> Enclosure::Halves() const {
  std::pair<Enclosure, Enclosure> halves(*this, *this);
  mpfr_t& middle = halves.first.hi_;
  mpfr_add(middle, lo_, hi_, MPFR_RNDN);
  mpfr_div_2ui(middle, middle, 1, MPFR_RNDN);
  mpfr_set(halves.second.lo_, middle, MPFR_RNDN);
  return halves;
}

double Enclosure::Share(const Enclosure& before) const {
  if (!before.IsBounded()) {
    const bool moved = mpfr_equal_p(lo_, before.lo_) == 0 || mpfr_equal_p(hi_, before.hi_) == 0;
    return moved ? 0.5 : 1;
  }
  const Enclosure now = *this - *this;
  const Enclosure then = before - before;
  const double width = mpfr_get_d(then.hi_, MPFR_RNDN);
  return width > 0 ? mpfr_get_d(now.hi_, MPFR_RNDN) / width : 1;
}

void Enclosure::Clear() {
  mpfr_set_inf(lo_, 1);
  mpfr_set_inf(hi_, -1);
}

void Enclosure::Meet(const Enclosure& other) {
  mpfr_max(lo_, lo_, other.lo_, MPFR_RNDD);
  mpfr_min(hi_, hi_, other.hi_, MPFR_RNDU);
}

void Enclosure::Join(const Enclosure& other) {
  if (other.IsEmpty()) return;
  if (IsEmpty()) {
    *this = other;
    return;
  }
  mpfr_min(lo_, lo_, other.lo_, MPFR_RNDD);
  mpfr_max(hi_, hi_, other.hi_, MPFR_RNDU);
}

void Enclosure::AtMost(const Enclosure& bound) { mpfr_min(hi_, hi_, bound.hi_, MPFR_RNDU); }
void Enclosure::AtLeast(const Enclosure& bound) { mpfr_max(lo_, lo_, bound.lo_, MPFR_RNDD); }

void Enclosure::Integers() {
  mpfr_rint_ceil(lo_, lo_, MPFR_RNDD);
  mpfr_rint_floor(hi_, hi_, MPFR_RNDU);
}

namespace {

// 0 * inf is 0 here: an infinite end is never met.
void Product(mpfr_t out, const mpfr_t a, const mpfr_t b, mpfr_rnd_t round) {
  if (mpfr_zero_p(a) != 0 || mpfr_zero_p(b) != 0) {
    mpfr_set_zero(out, 1);
  } else {
    mpfr_mul(out, a, b, round);
  }
}

}  // namespace

Enclosure operator+(const Enclosure& a, const Enclosure& b) {
  if (a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  Enclosure r;
  mpfr_add(r.lo_, a.lo_, b.lo_, MPFR_RNDD);
  mpfr_add(r.hi_, a.hi_, b.hi_, MPFR_RNDU);
  return r;
}

Enclosure operator-(const Enclosure& a, const Enclosure& b) {
  if (a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  Enclosure r;
  mpfr_sub(r.lo_, a.lo_, b.hi_, MPFR_RNDD);
  mpfr_sub(r.hi_, a.hi_, b.lo_, MPFR_RNDU);
  return r;
}

Enclosure operator*(const Enclosure& a, const Enclosure& b) {
  if (a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  Enclosure r;
  Enclosure t;
  const auto both = [&](const mpfr_t x, const mpfr_t y, bool first) {
    Product(t.lo_, x, y, MPFR_RNDD);
    Product(t.hi_, x, y, MPFR_RNDU);
    if (first) {
      r = t;
    } else {
      mpfr_min(r.lo_, r.lo_, t.lo_, MPFR_RNDD);
      mpfr_max(r.hi_, r.hi_, t.hi_, MPFR_RNDU);
    }
  };
  both(a.lo_, b.lo_, true);
  both(a.lo_, b.hi_, false);
  both(a.hi_, b.lo_, false);
  both(a.hi_, b.hi_, false);
  return r;
}

Enclosure operator/(const Enclosure& a, const Enclosure& b) {
  if (a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  Enclosure r;
  if (b.HasZero()) return r;
  mpfr_ui_div(r.lo_, 1, b.hi_, MPFR_RNDD);
  mpfr_ui_div(r.hi_, 1, b.lo_, MPFR_RNDU);
  return a * r;
}

Enclosure Power(const Enclosure& a, unsigned n) {
  if (a.IsEmpty()) return a;
  Enclosure r;
  if (n % 2 == 1 || mpfr_sgn(a.lo_) >= 0) {
    mpfr_pow_ui(r.lo_, a.lo_, n, MPFR_RNDD);
    mpfr_pow_ui(r.hi_, a.hi_, n, MPFR_RNDU);
  } else if (mpfr_sgn(a.hi_) <= 0) {
    mpfr_pow_ui(r.lo_, a.hi_, n, MPFR_RNDD);
    mpfr_pow_ui(r.hi_, a.lo_, n, MPFR_RNDU);
  } else {
    mpfr_set_zero(r.lo_, 1);
    const bool left = mpfr_cmpabs(a.lo_, a.hi_) > 0;
    mpfr_pow_ui(r.hi_, left ? a.lo_ : a.hi_, n, MPFR_RNDU);
  }
  return r;
}

// For a > 0 it is monotone in a for each b, and in b for each a, so that its ends lie in corners; at the
// corners where a is 0 or infinite, MPFR gives the limits.
Enclosure RealPower(const Enclosure& a, const Enclosure& b) {
  if (a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  if (mpfr_sgn(a.lo_) < 0) {
    // A whole exponent of a negative base, if it is the only one.
    const bool whole = mpfr_equal_p(b.lo_, b.hi_) != 0 && mpfr_integer_p(b.lo_) != 0 &&
                       mpfr_sgn(b.lo_) >= 0 && mpfr_cmp_ui(b.lo_, 1000) <= 0;
    if (!whole) return Enclosure();
    const auto n = static_cast<unsigned>(mpfr_get_ui(b.lo_, MPFR_RNDN));
    return n == 0 ? Enclosure::Interval(1, 1) : Power(a, n);
  }
  const bool zero = a.HasZero();
  if (zero && mpfr_sgn(b.lo_) < 0) return Enclosure();
  Enclosure r = Enclosure::Empty();
  if (zero && mpfr_sgn(b.hi_) > 0) r.Join(Enclosure::Interval(0, 0));
  if (b.HasZero()) r.Join(Enclosure::Interval(1, 1));
  if (mpfr_sgn(a.hi_) <= 0) return r;
  Enclosure t;
  for (const mpfr_t* base : {&a.lo_, &a.hi_}) {
    for (const mpfr_t* exponent : {&b.lo_, &b.hi_}) {
      mpfr_pow(t.lo_, *base, *exponent, MPFR_RNDD);
      mpfr_pow(t.hi_, *base, *exponent, MPFR_RNDU);
      if (mpfr_nan_p(t.lo_) != 0 || mpfr_nan_p(t.hi_) != 0) return Enclosure();
      r.Join(t);
    }
  }
  return r;
}

Enclosure Root(const Enclosure& a, unsigned n) {
  if (a.IsEmpty() || mpfr_sgn(a.hi_) < 0) return Enclosure::Empty();
  Enclosure r = a;
  if (mpfr_sgn(r.lo_) < 0) mpfr_set_zero(r.lo_, 1);
  mpfr_rootn_ui(r.lo_, r.lo_, n, MPFR_RNDD);
  mpfr_rootn_ui(r.hi_, r.hi_, n, MPFR_RNDU);
  return r;
}

Enclosure Abs(const Enclosure& a) {
  if (a.IsEmpty()) return a;
  const Enclosure negative = Enclosure::Interval(0, 0) - a;
  Enclosure r = Max(a, negative);
  if (mpfr_sgn(r.lo_) < 0) mpfr_set_zero(r.lo_, 1);
  return r;
}

Enclosure Min(const Enclosure& a, const Enclosure& b) {
  if (a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  Enclosure r = a;
  mpfr_min(r.lo_, a.lo_, b.lo_, MPFR_RNDD);
  mpfr_min(r.hi_, a.hi_, b.hi_, MPFR_RNDU);
  return r;
}

Enclosure Max(const Enclosure& a, const Enclosure& b) {
  if (a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  Enclosure r = a;
  mpfr_max(r.lo_, a.lo_, b.lo_, MPFR_RNDD);
  mpfr_max(r.hi_, a.hi_, b.hi_, MPFR_RNDU);
  return r;
}

Enclosure Increasing(const Enclosure& a, Enclosure::Monotone f) {
  if (a.IsEmpty()) return a;
  Enclosure r;
  f(r.lo_, a.lo_, MPFR_RNDD);
  f(r.hi_, a.hi_, MPFR_RNDU);
  return r;
}

Enclosure Decreasing(const Enclosure& a, Enclosure::Monotone f) {
  if (a.IsEmpty()) return a;
  Enclosure r;
  f(r.lo_, a.hi_, MPFR_RNDD);
  f(r.hi_, a.lo_, MPFR_RNDU);
  return r;
}

Enclosure Log(const Enclosure& a) {
  if (a.IsEmpty() || mpfr_sgn(a.hi_) <= 0) return Enclosure::Empty();
  Enclosure r = a;
  if (mpfr_sgn(r.lo_) < 0) mpfr_set_zero(r.lo_, 1);
  return Increasing(r, mpfr_log);
}

namespace {

/// Angles whose size is no concern: beyond, sine and cosine are enclosed by [-1, 1].
constexpr double kLargestAngle = 1e9;

bool IsLarge(const mpfr_t x) {
  return mpfr_number_p(x) == 0 || mpfr_cmp_d(x, kLargestAngle) > 0 || mpfr_cmp_d(x, -kLargestAngle) < 0;
}

}  // namespace

// Monotone between the extrema at (k + 1/2) pi; which of them may lie in `a` is told from an enclosure of
// a / pi - 1/2.
Enclosure Sin(const Enclosure& a) {
  if (a.IsEmpty()) return a;
  if (IsLarge(a.lo_) || IsLarge(a.hi_)) return Enclosure::Interval(-1, 1);
  Enclosure r;
  Enclosure t;
  mpfr_sin(r.lo_, a.lo_, MPFR_RNDD);
  mpfr_sin(r.hi_, a.lo_, MPFR_RNDU);
  mpfr_sin(t.lo_, a.hi_, MPFR_RNDD);
  mpfr_sin(t.hi_, a.hi_, MPFR_RNDU);
  r.Join(t);
  const Enclosure turns = a / Enclosure::Pi() - Enclosure(expr::Rational(1) / expr::Rational(2));
  const long first = mpfr_get_si(turns.lo_, MPFR_RNDU);
  const long last = mpfr_get_si(turns.hi_, MPFR_RNDD);
  for (long k = first; k <= last && k <= first + 1; ++k)
    r.Join(Enclosure::Interval(k % 2 == 0 ? 1 : -1, k % 2 == 0 ? 1 : -1));
  return r;
}

Enclosure Cos(const Enclosure& a) { return Sin(a + Enclosure::Pi() / Enclosure::Interval(2, 2)); }

Enclosure Tan(const Enclosure& a) {
  if (a.IsEmpty()) return a;
  Enclosure r;
  if (IsLarge(a.lo_) || IsLarge(a.hi_)) return r;
  const Enclosure turns = a / Enclosure::Pi() - Enclosure(expr::Rational(1) / expr::Rational(2));
  if (mpfr_get_si(turns.lo_, MPFR_RNDU) <= mpfr_get_si(turns.hi_, MPFR_RNDD)) return r;
  return Increasing(a, mpfr_tan);
}

// On a box away from the cut {y = 0, x <= 0}, extrema lie in its corners; also on one that touches the cut
// from above, without the origin: on the cut the angle is pi.
Enclosure Atan2(const Enclosure& y, const Enclosure& x) {
  if (y.IsEmpty() || x.IsEmpty()) return Enclosure::Empty();
  Enclosure r;
  const bool origin = y.HasZero() && x.HasZero();
  const bool below = mpfr_sgn(y.lo_) < 0;
  if (origin || (below && y.HasZero() && mpfr_sgn(x.lo_) <= 0)) {
    r = Enclosure::Pi();
    mpfr_neg(r.lo_, r.hi_, MPFR_RNDD);
    return r;
  }
  r.Clear();
  Enclosure t;
  Enclosure from = y;
  if (!below && mpfr_zero_p(from.lo_) != 0) mpfr_set_zero(from.lo_, 1);
  if (!below && mpfr_zero_p(from.hi_) != 0) mpfr_set_zero(from.hi_, 1);
  for (const mpfr_t* v : {&from.lo_, &from.hi_}) {
    for (const mpfr_t* u : {&x.lo_, &x.hi_}) {
      mpfr_atan2(t.lo_, *v, *u, MPFR_RNDD);
      mpfr_atan2(t.hi_, *v, *u, MPFR_RNDU);
      r.Join(t);
    }
  }
  return r;
}

// sin x = z on the k-th monotone piece [(k - 1/2) pi, (k + 1/2) pi]: x = k pi + (-1)^k asin z.
Enclosure WhereSin(const Enclosure& z, const Enclosure& x) {
  Enclosure inside = z;
  inside.Meet(Enclosure::Interval(-1, 1));
  if (inside.IsEmpty() || x.IsEmpty()) return Enclosure::Empty();
  if (IsLarge(x.lo_) || IsLarge(x.hi_)) return x;
  const Enclosure base = Increasing(inside, mpfr_asin);
  const Enclosure turns = x / Enclosure::Pi() + Enclosure(expr::Rational(1) / expr::Rational(2));
  const long first = mpfr_get_si(turns.lo_, MPFR_RNDD);
  const long last = mpfr_get_si(turns.hi_, MPFR_RNDU);
  const auto piece = [&](long k) {
    const Enclosure middle = Enclosure::Pi() * Enclosure::Interval(k, k);
    Enclosure p = k % 2 == 0 ? middle + base : middle - base;
    p.Meet(x);
    return p;
  };
  // Pieces in the middle of `x` hold a solution each: only those at its ends are of interest.
  constexpr long kEndPieces = 4;
  Enclosure r = Enclosure::Empty();
  for (long k = first; k <= last; ++k) {
    if (k == first + kEndPieces && last - first > 2 * kEndPieces) k = last - kEndPieces;
    r.Join(piece(k));
  }
  return r;
}

Enclosure WhereTimes(const Enclosure& z, const Enclosure& b, const Enclosure& a) {
  if (z.IsEmpty() || a.IsEmpty() || b.IsEmpty()) return Enclosure::Empty();
  Enclosure r = a;
  if (!b.HasZero()) {
    r.Meet(z / b);
    return r;
  }
  if (z.HasZero()) return a;
  // 1 / b on either side of 0.
  const auto side = [&](const mpfr_t end, bool positive) {
    Enclosure inverse;
    if (positive) {
      mpfr_ui_div(inverse.lo_, 1, end, MPFR_RNDD);
    } else {
      mpfr_ui_div(inverse.hi_, 1, end, MPFR_RNDU);
    }
    Enclosure part = z * inverse;
    part.Meet(a);
    return part;
  };
  r = Enclosure::Empty();
  if (mpfr_sgn(b.hi_) > 0) r.Join(side(b.hi_, true));
  if (mpfr_sgn(b.lo_) < 0) r.Join(side(b.lo_, false));
  return r;
}

Enclosure WherePower(const Enclosure& z, unsigned n, const Enclosure& a) {
  const Enclosure zero = Enclosure::Interval(0, 0);
  Enclosure up = Root(z, n);
  Enclosure down = zero - (n % 2 == 0 ? up : Root(zero - z, n));
  up.Meet(a);
  down.Meet(a);
  Enclosure r = Enclosure::Empty();
  r.Join(up);
  r.Join(down);
  return r;
}

}  // namespace rondo::solve::certify
