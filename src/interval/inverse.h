#pragma once

#include "interval/operations.h"

/// Internal to `interval`: contraction of arguments. Given z = f(x, y), each function removes from x (and y)
/// only values that no z can explain, wherever f is defined; outside the domain of a partial function nothing
/// is kept, because the caller requires the result to exist.
namespace rondo::interval {

/// Contracts arguments lane by lane, for the instruction set `S` (HC4's backward step, Benhamou et al. 1999).
template <typename S>
struct Inverse : Operations<S> {
  using O = Operations<S>;
  using O::C;
  using typename O::E;
  using typename O::Iv;
  using typename O::M;
  using typename O::V;

  /// Contracts x of x + y.
  static Iv Add(Iv z, Iv x, Iv y) { return O::Meet(x, O::Sub(z, y)); }

  /// Contracts x of x * y: by extended division, so y may contain 0.
  static Iv Mul(Iv z, Iv x, Iv y) {
    const M y_has_zero = O::Has(y, 0);
    const Iv plain = O::Meet(x, O::Quotient(z, O::Select(y_has_zero, O::Const(1, 1), y)));
    // 0 in y: if z can be 0 nothing follows, else |x| is at least as large as the quotients with the ends of
    // y.
    const M z_has_zero = O::Has(z, 0);
    const M z_negative = S::Lt(z.hi, C(0));
    const Iv w = O::Select(z_negative, O::Neg(z), z);  // w > 0
    const Iv d = O::Select(z_negative, O::Neg(y), y);
    const V low = O::Lo(w);
    // x >= low / d.hi if d.hi > 0; x <= low / d.lo if d.lo < 0. Bounds in terms of (-lo, hi).
    const V at_least = S::DivUp(S::Neg(low), S::Select(S::Lt(C(0), d.hi), d.hi, C(1)));  // -(low / d.hi), up
    const V at_most = S::DivUp(low, S::Select(S::Lt(C(0), d.nl), S::Neg(d.nl), C(-1)));  // low / d.lo, up
    const Iv right = O::Select(S::Lt(C(0), d.hi), O::Meet(x, {at_least, C(O::kInf)}), O::Empty());
    const Iv left = O::Select(S::Lt(C(0), d.nl), O::Meet(x, {C(O::kInf), at_most}), O::Empty());
    const Iv extended = O::HullOfParts(left, right);
    return O::Select(y_has_zero, O::Select(z_has_zero, x, extended), plain);
  }

  /// Contract x and y of x / y. Division by zero can give anything, so nothing follows if 0 is in y.
  static Iv Dividend(Iv z, Iv x, Iv y) { return O::Select(O::Has(y, 0), x, O::Meet(x, O::Mul(z, y))); }
  static Iv Divisor(Iv z, Iv x, Iv y) { return O::Select(O::Has(y, 0), y, Mul(x, y, z)); }

  /// Contracts x of |x| in m, where m has no negative numbers.
  static Iv Symmetric(Iv m, Iv x) {
    const Iv right = O::Meet(x, m);
    const Iv left = O::Meet(x, O::Neg(m));
    return O::HullOfParts(left, right);
  }
  static Iv Abs(Iv z, Iv x) { return Symmetric(O::Meet(z, O::Const(0, O::kInf)), x); }
  static Iv Sqr(Iv z, Iv x) { return Symmetric(O::Sqrt(z), x); }
  /// Contracts x of x^n, n >= 2.
  static Iv Pow(Iv z, Iv x, int n) {
    if (n == 2) return Sqr(z, x);
    if (n == 4) return Symmetric(O::Sqrt(O::Sqrt(z)), x);
    if (n % 2 == 0) return Symmetric(Root(O::Meet(z, O::Const(0, O::kInf)), n), x);
    const V zl = O::Lo(z);
    const Iv lower = Root(O::Abs(O::Point(zl)), n);
    const Iv upper = Root(O::Abs(O::Point(z.hi)), n);
    const V nl = S::Select(S::Lt(zl, C(0)), lower.hi, lower.nl);
    const V hi = S::Select(S::Lt(z.hi, C(0)), upper.nl, upper.hi);
    return O::Meet(x, {nl, hi});
  }
  /// Encloses the n-th roots of m >= 0: a guess, checked by its powers.
  static Iv Root(Iv m, int n) {
    const V exponent = C(n);
    const V guess_lo = E::PerLane(O::Lo(m), exponent, [](double v, double k) { return std::pow(v, 1 / k); });
    const V guess_hi = E::PerLane(m.hi, exponent, [](double v, double k) { return std::pow(v, 1 / k); });
    const V lo = S::Mul(guess_lo, C(1 - 0x1p-44));
    const V hi = S::Mul(guess_hi, C(1 + 0x1p-44));
    // lo^n <= m.lo and hi^n >= m.hi must be certain; else the bound is dropped.
    const M lo_good = S::Le(O::PowUp(lo, n), O::Lo(m));
    const M hi_good = S::Le(m.hi, S::Neg(O::PowNegUp(hi, n)));
    return O::Select(O::IsEmpty(m), O::Empty(),
                     {S::Select(lo_good, S::Neg(lo), C(0)), S::Select(hi_good, hi, C(O::kInf))});
  }
  static Iv Sqrt(Iv z, Iv x) {
    const Iv r = O::Meet(x, O::Sqr(O::Meet(z, O::Const(0, O::kInf))));
    return O::Select(S::Lt(z.hi, C(0)), O::Empty(), r);
  }

  /// Contracts x of min(x, y).
  static Iv Min(Iv z, Iv x, Iv y) {
    Iv r = {S::Min(x.nl, z.nl), x.hi};  // x >= min >= z.lo
    // If y is above z, x is the minimum.
    r.hi = S::Select(S::Lt(z.hi, O::Lo(y)), S::Min(r.hi, z.hi), r.hi);
    return r;
  }
  static Iv Max(Iv z, Iv x, Iv y) { return O::Neg(Min(O::Neg(z), O::Neg(x), O::Neg(y))); }

  static Iv Exp(Iv z, Iv x) { return O::Meet(x, O::Log(z)); }
  static Iv Log(Iv z, Iv x) { return O::Meet(x, O::Exp(z)); }
  static Iv Asin(Iv z, Iv x) {
    return O::Meet(x, O::Sin(O::Meet(z, O::Const(-E::kHalfPi - 0x1p-50, E::kHalfPi + 0x1p-50))));
  }
  static Iv Acos(Iv z, Iv x) { return O::Meet(x, O::Cos(O::Meet(z, O::Const(0, E::kPi + 0x1p-50)))); }
  static Iv Atan(Iv z, Iv x) {
    // Near +-pi/2 the tangent is left unbounded.
    const double limit = E::kHalfPi - 0x1p-40;
    const V lo = O::Lo(z);
    const Iv t_lo = O::TanAt(O::Clamp(lo, -limit, limit));
    const Iv t_hi = O::TanAt(O::Clamp(z.hi, -limit, limit));
    const V nl = S::Select(S::Le(C(-limit), lo), t_lo.nl, C(O::kInf));
    const V hi = S::Select(S::Le(z.hi, C(limit)), t_hi.hi, C(O::kInf));
    return O::Meet(x, {nl, hi});
  }

  /// Returns the hull of the part of x in the union over integers k of branch + period * k.
  static Iv Periodic(Iv branch, Iv x, double period) {
    const V slack = S::Add(C(0x1p-46), S::Mul(O::Mag(x), C(0x1p-48)));
    // The first copy that ends at or after x.lo, the last that begins at or before x.hi.
    const V xl = O::Lo(x);
    const V bl = O::Lo(branch);
    const V per = C(1 / period);
    const V first =
        S::Neg(S::Floor(S::Neg(S::Sub(S::Mul(S::Sub(S::Sub(xl, branch.hi), slack), per), C(0x1p-46)))));
    const V last = S::Floor(S::Add(S::Mul(S::Add(S::Sub(x.hi, bl), slack), per), C(0x1p-46)));
    const V lo = S::Sub(S::Add(bl, S::Mul(first, C(period))), slack);
    const V hi = S::Add(S::Add(branch.hi, S::Mul(last, C(period))), slack);
    return {S::Min(x.nl, S::Neg(lo)), S::Min(x.hi, hi)};
  }
  /// Contracts x of sin x; empty if z does not meet [-1, 1].
  static Iv Sin(Iv z, Iv x) {
    const Iv a = O::Asin(z);
    const Iv b = O::Sub(O::Const(E::kPi, 0x1.921fb54442d19p+1), a);
    return Wave(z, x, a, b);
  }
  static Iv Cos(Iv z, Iv x) {
    const Iv a = O::Acos(z);
    return Wave(z, x, a, O::Neg(a));
  }
  /// Contracts x to the copies of the branches a and b, a full turn apart: what sine and cosine share.
  static Iv Wave(Iv z, Iv x, Iv a, Iv b) {
    const double turn = 2 * E::kPi;
    const Iv p = Periodic(a, x, turn);
    const Iv q = Periodic(b, x, turn);
    const Iv r = O::HullOfParts(p, q);
    const M keep = S::Or(O::AngleTooLarge(x), O::IsEmpty(a));
    return O::Select(O::MissesUnit(z), O::Empty(), O::Select(keep, x, r));
  }
};

}  // namespace rondo::interval
