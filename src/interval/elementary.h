#pragma once

#include <cmath>
#include <limits>

/// Internal to `interval`: elementary functions at points, computed with rounding to nearest by range
/// reduction and Taylor series, each with a bound of its error. The bounds are twice what the analysis beside
/// each function gives, u = 2^-53; the tests measure them against MPFR.
namespace rondo::interval {

/// Computes the functions lane by lane, for the instruction set `S`: `V` holds doubles, `M` truth values.
template <typename S>
struct Elementary {
  using V = typename S::V;
  using M = typename S::M;

  /// Is a value and a bound of its distance from the exact one.
  struct Approx {
    V value;
    V error;
  };

  static constexpr double kPi = 0x1.921fb54442d18p+1;
  static constexpr double kHalfPi = 0x1.921fb54442d18p+0;
  /// Beyond this, sine and cosine are not reduced and enclosed by [-1, 1].
  static constexpr double kLargestAngle = 0x1p16;

  static V C(double d) { return S::Set(d); }
  // c0 + x (c1 + x (c2 + ...))
  template <int Count>
  static V Poly(V x, const double (&c)[Count]) {
    V r = C(c[Count - 1]);
    for (int i = Count - 2; i >= 0; --i) r = S::Add(S::Mul(r, x), C(c[i]));
    return r;
  }

  /// Computes sin x and cos x for |x| <= kLargestAngle (radians). Reduction x - k pi/2 in three parts (Cody
  /// and Waite): the first product and difference are exact, the other two differences are rounded once each,
  /// so the reduced argument is off by at most 2u. Series to r^17 and r^18, |r| <= 0.79: remainders below
  /// 2^-62; rounding below 2u.
  static void SinCos(V x, Approx& sine, Approx& cosine) {
    const V k = S::Rint(S::Mul(x, C(0x1.45f306dc9c883p-1)));
    V r = S::Sub(x, S::Mul(k, C(1.57079632673412561417e+00)));
    r = S::Sub(r, S::Mul(k, C(6.07710050630396597660e-11)));
    r = S::Sub(r, S::Mul(k, C(2.02226624879595063154e-21)));
    const V r2 = S::Mul(r, r);
    static constexpr double kSin[] = {-1.0 / 6,
                                      1.0 / 120,
                                      -1.0 / 5040,
                                      1.0 / 362880,
                                      -1.0 / 39916800,
                                      1.0 / 6227020800.0,
                                      -1.0 / 1307674368000.0,
                                      1.0 / 355687428096000.0};
    static constexpr double kCos[] = {-0.5,
                                      1.0 / 24,
                                      -1.0 / 720,
                                      1.0 / 40320,
                                      -1.0 / 3628800,
                                      1.0 / 479001600.0,
                                      -1.0 / 87178291200.0,
                                      1.0 / 20922789888000.0,
                                      -1.0 / 6402373705728000.0};
    const V s = S::Add(r, S::Mul(r, S::Mul(r2, Poly(r2, kSin))));
    const V c = S::Add(C(1), S::Mul(r2, Poly(r2, kCos)));
    // k mod 4 decides which of s, c, -s, -c.
    const V quarter = S::Sub(k, S::Mul(C(4), S::Floor(S::Mul(k, C(0.25)))));
    const M swap = S::Or(S::Eq(quarter, C(1)), S::Eq(quarter, C(3)));
    const M minus_sine = S::Or(S::Eq(quarter, C(2)), S::Eq(quarter, C(3)));
    const M minus_cosine = S::Or(S::Eq(quarter, C(1)), S::Eq(quarter, C(2)));
    const V a = S::Select(swap, c, s);
    const V b = S::Select(swap, s, c);
    sine.value = S::Select(minus_sine, S::Neg(a), a);
    cosine.value = S::Select(minus_cosine, S::Neg(b), b);
    // Without reduction the sine is accurate relative to itself.
    const V flat = C(0x1p-50);
    const V relative = S::Add(S::Mul(S::Abs(sine.value), flat), C(0x1p-1074));
    sine.error = S::Select(S::Eq(k, C(0)), relative, flat);
    cosine.error = flat;
  }

  /// Computes atan x. |x| > 1 by atan x = pi/2 - atan 1/x, then t > tan(pi/8) by the addition theorem: |t| <=
  /// 0.4143, series to t^43 with remainder below 2^-59 relative; all steps keep the relative error below 6u.
  static Approx Atan(V x) {
    const V t0 = S::Abs(x);
    const M inverse = S::Lt(C(1), t0);
    const V t1 = S::Select(inverse, S::Div(C(1), t0), t0);
    static constexpr double kTan = 0.41421356237309504880;  // tan(pi/8)
    const M shifted = S::Lt(C(kTan), t1);
    const V t = S::Select(shifted, S::Div(S::Sub(t1, C(kTan)), S::Add(C(1), S::Mul(t1, C(kTan)))), t1);
    static constexpr double kSeries[] = {-1.0 / 3,  1.0 / 5,  -1.0 / 7,  1.0 / 9,  -1.0 / 11, 1.0 / 13,
                                         -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23, 1.0 / 25,
                                         -1.0 / 27, 1.0 / 29, -1.0 / 31, 1.0 / 33, -1.0 / 35, 1.0 / 37,
                                         -1.0 / 39, 1.0 / 41, -1.0 / 43};
    const V t2 = S::Mul(t, t);
    V r = S::Add(t, S::Mul(t, S::Mul(t2, Poly(t2, kSeries))));
    r = S::Select(shifted, S::Add(C(kPi / 8), r), r);
    r = S::Select(inverse, S::Sub(C(kHalfPi), r), r);
    const M negative = S::Lt(x, C(0));
    const V value = S::Select(negative, S::Neg(r), r);
    return {value, S::Add(S::Mul(r, C(0x1p-49)), C(0x1p-1074))};
  }

  /// Computes asin x for |x| <= 1, as atan(x / sqrt(1 - x^2)): the argument is off by 5u relative, which atan
  /// does not increase.
  static Approx Asin(V x) {
    const V root = S::Sqrt(S::Mul(S::Sub(C(1), x), S::Add(C(1), x)));
    Approx r = Atan(S::Div(x, root));
    r.error = S::Add(S::Mul(S::Abs(r.value), C(0x1p-48)), C(0x1p-1074));
    return r;
  }
  /// Computes acos x for |x| <= 1, as pi/2 - asin x; its error is absolute.
  static Approx Acos(V x) { return {S::Sub(C(kHalfPi), Asin(x).value), C(0x1p-49)}; }

  /// Computes exp x for -745 <= x <= 709. x - k ln 2 in two parts, the first product exact: off by u; series
  /// to r^14, |r| <= 0.35: remainder below 2^-58.
  static Approx Exp(V x) {
    const V k = S::Rint(S::Mul(x, C(0x1.71547652b82fep+0)));
    V r = S::Sub(x, S::Mul(k, C(6.93147180369123816490e-01)));
    r = S::Sub(r, S::Mul(k, C(1.90821492927058770002e-10)));
    static constexpr double kSeries[] = {1.0,
                                         1.0,
                                         1.0 / 2,
                                         1.0 / 6,
                                         1.0 / 24,
                                         1.0 / 120,
                                         1.0 / 720,
                                         1.0 / 5040,
                                         1.0 / 40320,
                                         1.0 / 362880,
                                         1.0 / 3628800,
                                         1.0 / 39916800,
                                         1.0 / 479001600.0,
                                         1.0 / 6227020800.0,
                                         1.0 / 87178291200.0};
    const V p = Poly(r, kSeries);
    const V value = PerLane(p, k, [](double m, double e) { return std::ldexp(m, static_cast<int>(e)); });
    return {value, S::Add(S::Mul(value, C(0x1p-49)), C(0x1p-1073))};
  }

  /// Computes log x for finite x > 0: x = 2^k m with m in [sqrt 1/2, sqrt 2], log m = 2 atanh((m-1)/(m+1)); m
  /// - 1 is exact.
  static Approx Log(V x) {
    const V k = PerLane(x, x, [](double v, double) {
      int e = 0;
      const double m = std::frexp(v, &e);
      return static_cast<double>(m < 0.70710678118654752440 ? e - 1 : e);
    });
    const V m = PerLane(x, k, [](double v, double e) { return std::ldexp(v, -static_cast<int>(e)); });
    const V s = S::Div(S::Sub(m, C(1)), S::Add(m, C(1)));
    const V s2 = S::Mul(s, s);
    static constexpr double kSeries[] = {1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13,
                                         1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23, 1.0 / 25};
    const V log_m = S::Mul(C(2), S::Add(s, S::Mul(s, S::Mul(s2, Poly(s2, kSeries)))));
    const V value = S::Add(S::Mul(k, C(6.93147180369123816490e-01)),
                           S::Add(log_m, S::Mul(k, C(1.90821492927058770002e-10))));
    // Parts of opposite sign cancel by at most half: |k ln 2| >= 2 |log m|.
    return {value, S::Add(S::Mul(S::Abs(value), C(0x1p-49)), C(0x1p-1074))};
  }

  /// Applies `f` to each lane in turn: for what the instruction set does not have.
  static V PerLane(V a, V b, double (*f)(double, double)) {
    alignas(64) double x[S::kLanes];
    alignas(64) double y[S::kLanes];
    S::Store(x, a);
    S::Store(y, b);
    for (int i = 0; i < S::kLanes; ++i) x[i] = f(x[i], y[i]);
    return S::Load(x);
  }
};

}  // namespace rondo::interval
