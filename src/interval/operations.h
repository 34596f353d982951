#pragma once

#include "interval/elementary.h"

/// Internal to `interval`: enclosures of the images of operations. An interval [lo, hi] is kept as (-lo, hi),
/// so that both bounds are rounded upwards. Empty: lo > hi; an operation on empty intervals may give
/// anything.
///
/// A partial function is enclosed over the part of its argument that lies in its domain: nothing, if no part
/// does. Division is total, as in SMT-LIB: a quotient by zero is some number, so it can be any.
namespace rondo::interval {

/// Encloses images lane by lane, for an instruction set `S` whose `AddUp`, `MulUp`, `DivUp` and `SqrtUp`
/// never return less than the exact result.
template <typename S>
struct Operations {
  using V = typename S::V;
  using M = typename S::M;
  using E = Elementary<S>;
  struct Iv {
    V nl, hi;  // -lo, hi
  };

  static constexpr double kInf = std::numeric_limits<double>::infinity();
  static V C(double d) { return S::Set(d); }
  static V Lo(Iv a) { return S::Neg(a.nl); }
  static Iv Const(double lo, double hi) { return {C(-lo), C(hi)}; }
  static Iv Whole() { return Const(-kInf, kInf); }
  static Iv Empty() { return {C(-kInf), C(-kInf)}; }
  static Iv Point(V x) { return {S::Neg(x), x}; }
  static Iv Select(M m, Iv yes, Iv no) { return {S::Select(m, yes.nl, no.nl), S::Select(m, yes.hi, no.hi)}; }
  static M Has(Iv a, double x) { return S::And(S::Le(C(-x), a.nl), S::Le(C(x), a.hi)); }
  static M IsEmpty(Iv a) { return S::Lt(a.hi, Lo(a)); }

  static Iv Meet(Iv a, Iv b) { return {S::Min(a.nl, b.nl), S::Min(a.hi, b.hi)}; }
  static Iv Hull(Iv a, Iv b) { return {S::Max(a.nl, b.nl), S::Max(a.hi, b.hi)}; }
  /// Returns the hull of two intervals of which either may be empty.
  static Iv HullOfParts(Iv a, Iv b) { return Select(IsEmpty(a), b, Select(IsEmpty(b), a, Hull(a, b))); }
  static Iv Neg(Iv a) { return {a.hi, a.nl}; }
  static Iv Add(Iv a, Iv b) { return {S::AddUp(a.nl, b.nl), S::AddUp(a.hi, b.hi)}; }
  static Iv Sub(Iv a, Iv b) { return Add(a, Neg(b)); }

  static V Max4(V a, V b, V c, V d) { return S::Max(S::Max(a, b), S::Max(c, d)); }
  static Iv Mul(Iv a, Iv b) {
    const V al = Lo(a);
    const V mah = S::Neg(a.hi);
    const V bl = Lo(b);
    return {Max4(S::MulUp(a.nl, bl), S::MulUp(a.nl, b.hi), S::MulUp(mah, bl), S::MulUp(mah, b.hi)),
            Max4(S::MulUp(al, bl), S::MulUp(al, b.hi), S::MulUp(a.hi, bl), S::MulUp(a.hi, b.hi))};
  }
  /// Encloses a / b, for 0 not in b.
  static Iv Quotient(Iv a, Iv b) {
    const V al = Lo(a);
    const V mah = S::Neg(a.hi);
    const V bl = Lo(b);
    return {Max4(S::DivUp(a.nl, bl), S::DivUp(a.nl, b.hi), S::DivUp(mah, bl), S::DivUp(mah, b.hi)),
            Max4(S::DivUp(al, bl), S::DivUp(al, b.hi), S::DivUp(a.hi, bl), S::DivUp(a.hi, b.hi))};
  }
  static Iv Div(Iv a, Iv b) { return Select(Has(b, 0), Whole(), Quotient(a, b)); }

  /// Returns the largest magnitude of a member.
  static V Mag(Iv a) { return S::Max(S::Abs(a.nl), S::Abs(a.hi)); }
  /// Returns the least magnitude of a member.
  static V Mig(Iv a) { return S::Max(C(0), S::Max(S::Neg(a.nl), S::Neg(a.hi))); }
  static Iv Abs(Iv a) { return {S::Neg(Mig(a)), Mag(a)}; }
  static Iv Sqr(Iv a) {
    const V small = Mig(a);
    const V large = Mag(a);
    return {S::MulUp(S::Neg(small), small), S::MulUp(large, large)};
  }
  // An upper bound of x^n for x >= 0; of -x^n, given -x.
  static V PowUp(V x, int n) {
    V r = x;
    for (int i = 1; i < n; ++i) r = S::MulUp(r, x);
    return r;
  }
  static V PowNegUp(V x, int n) {
    V r = S::Neg(x);
    for (int i = 1; i < n; ++i) r = S::MulUp(r, x);
    return r;
  }
  /// Encloses x^n, n >= 1.
  static Iv Pow(Iv a, int n) {
    if (n == 1) return a;
    const Iv magnitude = {PowNegUp(Mig(a), n), PowUp(Mag(a), n)};
    if (n % 2 == 0) return magnitude;
    // Odd: each bound by its own sign.
    const V al = Lo(a);
    const M negative_lo = S::Lt(al, C(0));
    const M negative_hi = S::Lt(a.hi, C(0));
    const V nl = S::Select(negative_lo, PowUp(S::Abs(al), n), PowNegUp(S::Abs(al), n));
    const V hi = S::Select(negative_hi, PowNegUp(S::Abs(a.hi), n), PowUp(S::Abs(a.hi), n));
    return {nl, hi};
  }
  static Iv Sqrt(Iv a) {
    const V lo = S::Max(C(0), Lo(a));
    const V hi = S::Max(C(0), a.hi);
    return Select(S::Lt(a.hi, C(0)), Empty(), {S::Neg(S::SqrtDown(lo)), S::SqrtUp(hi)});
  }
  static Iv Min(Iv a, Iv b) { return {S::Max(a.nl, b.nl), S::Min(a.hi, b.hi)}; }
  static Iv Max(Iv a, Iv b) { return {S::Min(a.nl, b.nl), S::Max(a.hi, b.hi)}; }

  /// Encloses what is as near to the value as the error says.
  static Iv Around(typename E::Approx a) {
    return {S::Add(a.error, S::Neg(a.value)), S::Add(a.error, a.value)};
  }
  /// Reports whether [lo, hi] contains (shift + k) / per_period for an integer k. Says yes when in doubt.
  static M Crosses(Iv a, double per_period, double shift) {
    const V lo = S::Sub(S::Mul(Lo(a), C(per_period)), C(shift));
    const V hi = S::Sub(S::Mul(a.hi, C(per_period)), C(shift));
    const V slack = S::Mul(S::Add(C(1), Mag(a)), C(0x1p-48));
    return S::Le(S::Sub(lo, slack), S::Floor(S::Add(hi, slack)));
  }
  static M AngleTooLarge(Iv a) { return S::Not(S::Le(Mag(a), C(E::kLargestAngle))); }

  enum class Wave { kSine, kCosine };
  static Iv SinOrCos(Iv a, Wave wave) {
    const M unreduced = AngleTooLarge(a);
    const V lo = S::Select(unreduced, C(0), Lo(a));
    const V hi = S::Select(unreduced, C(0), a.hi);
    typename E::Approx sine_lo, cosine_lo, sine_hi, cosine_hi;
    E::SinCos(lo, sine_lo, cosine_lo);
    E::SinCos(hi, sine_hi, cosine_hi);
    const bool is_sine = wave == Wave::kSine;
    const Iv at_lo = Around(is_sine ? sine_lo : cosine_lo);
    const Iv at_hi = Around(is_sine ? sine_hi : cosine_hi);
    const double peak = is_sine ? 0.25 : 0.0;
    const double per_turn = 1 / (2 * E::kPi);
    Iv r = Meet(Hull(at_lo, at_hi), Const(-1, 1));
    r.hi = S::Select(S::Or(unreduced, Crosses(a, per_turn, peak)), C(1), r.hi);
    r.nl = S::Select(S::Or(unreduced, Crosses(a, per_turn, peak + 0.5)), C(1), r.nl);
    return r;
  }
  static Iv Sin(Iv a) { return SinOrCos(a, Wave::kSine); }
  static Iv Cos(Iv a) { return SinOrCos(a, Wave::kCosine); }
  /// Encloses the tangent at a point, as a quotient of sine and cosine.
  static Iv TanAt(V x) {
    typename E::Approx sine, cosine;
    E::SinCos(x, sine, cosine);
    return Div(Around(sine), Around(cosine));
  }
  static Iv Tan(Iv a) {
    const M pole = S::Or(AngleTooLarge(a), Crosses(a, 1 / E::kPi, 0.5));
    const V lo = S::Select(pole, C(0), Lo(a));
    const V hi = S::Select(pole, C(0), a.hi);
    return Select(pole, Whole(), Hull(TanAt(lo), TanAt(hi)));
  }
  /// Encloses the image under an increasing function, from its values at both ends.
  static Iv Monotone(typename E::Approx at_lo, typename E::Approx at_hi) {
    return {Around(at_lo).nl, Around(at_hi).hi};
  }
  static Iv Atan(Iv a) { return Monotone(E::Atan(Lo(a)), E::Atan(a.hi)); }
  static V Clamp(V x, double lo, double hi) { return S::Min(C(hi), S::Max(C(lo), x)); }
  static M MissesUnit(Iv a) { return S::Or(S::Lt(C(1), Lo(a)), S::Lt(a.hi, C(-1))); }
  static Iv Asin(Iv a) {
    const Iv r = Monotone(E::Asin(Clamp(Lo(a), -1, 1)), E::Asin(Clamp(a.hi, -1, 1)));
    return Select(MissesUnit(a), Empty(), r);
  }
  static Iv Acos(Iv a) {
    const Iv r = Monotone(E::Acos(Clamp(a.hi, -1, 1)), E::Acos(Clamp(Lo(a), -1, 1)));
    return Select(MissesUnit(a), Empty(), {S::Min(r.nl, C(0)), r.hi});
  }
  static Iv Exp(Iv a) {
    Iv r = Monotone(E::Exp(Clamp(Lo(a), -745, 709)), E::Exp(Clamp(a.hi, -745, 709)));
    r.nl = S::Min(C(0), S::Select(S::Lt(Lo(a), C(-745)), C(0), r.nl));
    r.hi = S::Select(S::Lt(C(709), a.hi), C(kInf), r.hi);
    return r;
  }
  static Iv Log(Iv a) {
    const V tiny = C(0x1p-1074);
    const V huge = C(std::numeric_limits<double>::max());
    Iv r = Monotone(E::Log(S::Min(huge, S::Max(tiny, Lo(a)))), E::Log(S::Min(huge, S::Max(tiny, a.hi))));
    r.nl = S::Select(S::Le(Lo(a), C(0)), C(kInf), r.nl);
    r.hi = S::Select(S::Eq(a.hi, C(kInf)), C(kInf), r.hi);
    return Select(S::Le(a.hi, C(0)), Empty(), r);
  }
  // The angle of (x, y), which is not the origin.
  static Iv AngleAt(V y, V x) {
    const V ay = S::Abs(y);
    const V ax = S::Abs(x);
    const M steep = S::Lt(ax, ay);
    const Iv q = Quotient(Select(steep, Point(ax), Point(ay)), Select(steep, Point(ay), Point(ax)));
    Iv r = Atan(q);
    const Iv half_pi = Const(E::kHalfPi, 0x1.921fb54442d19p+0);
    const Iv pi = Const(E::kPi, 0x1.921fb54442d19p+1);
    r = Select(steep, Sub(half_pi, r), r);
    r = Select(S::Lt(x, C(0)), Sub(pi, r), r);
    return Select(S::Lt(y, C(0)), Neg(r), r);
  }
  /// Encloses the angle in (-pi, pi] of the point (x, y); at the origin it is some number in [-pi, pi].
  static Iv Atan2(Iv y, Iv x) {
    const double pi_up = 0x1.921fb54442d19p+1;
    const V yl = Lo(y);
    const V xl = Lo(x);
    // Around the origin, or across the cut: everything. Infinite corners: likewise.
    const M origin = S::And(Has(y, 0), Has(x, 0));
    const M cut = S::And(S::Lt(xl, C(0)), S::And(S::Lt(yl, C(0)), S::Le(C(0), y.hi)));
    const M infinite = S::Not(S::Lt(S::Max(Mag(x), Mag(y)), C(kInf)));
    const M all = S::Or(infinite, S::Or(origin, cut));
    const V one = C(1);
    const V x0 = S::Select(all, one, xl);
    const V x1 = S::Select(all, one, x.hi);
    const V y0 = S::Select(all, one, yl);
    const V y1 = S::Select(all, one, y.hi);
    const Iv r = Hull(Hull(AngleAt(y0, x0), AngleAt(y0, x1)), Hull(AngleAt(y1, x0), AngleAt(y1, x1)));
    return Select(all, Const(-pi_up, pi_up), Meet(r, Const(-pi_up, pi_up)));
  }
};

}  // namespace rondo::interval
