#pragma once

#include <cmath>
#include <limits>

/// Internal to `interval`: N doubles in plain C++. Rounding is always to nearest; bounds are widened
/// afterwards.
namespace rondo::interval::portable {

/// Is the instruction set as `Widened` expects it, for any machine: arithmetic, comparisons and selection on
/// `N` doubles, lane by lane.
template <int N>
struct Isa {
  static constexpr int kLanes = N;
  struct V {
    double v[N];
  };
  struct M {
    bool m[N];
  };

  template <typename F>
  static V Map(F f) {
    V r;
    for (int i = 0; i < N; ++i) r.v[i] = f(i);
    return r;
  }
  template <typename F>
  static M Test(F f) {
    M r;
    for (int i = 0; i < N; ++i) r.m[i] = f(i);
    return r;
  }

  static V Set(double d) {
    return Map([&](int) { return d; });
  }
  static V Load(const double* p) {
    return Map([&](int i) { return p[i]; });
  }
  static void Store(double* p, V a) {
    for (int i = 0; i < N; ++i) p[i] = a.v[i];
  }

  static V Add(V a, V b) {
    return Map([&](int i) { return a.v[i] + b.v[i]; });
  }
  static V Sub(V a, V b) {
    return Map([&](int i) { return a.v[i] - b.v[i]; });
  }
  static V Mul(V a, V b) {
    return Map([&](int i) { return a.v[i] * b.v[i]; });
  }
  static V Div(V a, V b) {
    return Map([&](int i) { return a.v[i] / b.v[i]; });
  }
  static V Sqrt(V a) {
    return Map([&](int i) { return std::sqrt(a.v[i]); });
  }
  static V Neg(V a) {
    return Map([&](int i) { return -a.v[i]; });
  }
  static V Abs(V a) {
    return Map([&](int i) { return std::fabs(a.v[i]); });
  }
  static V Max(V a, V b) {
    return Map([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
  }
  static V Min(V a, V b) {
    return Map([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
  }
  static V Rint(V a) {
    return Map([&](int i) { return std::nearbyint(a.v[i]); });
  }
  static V Floor(V a) {
    return Map([&](int i) { return std::floor(a.v[i]); });
  }
  static M Lt(V a, V b) {
    return Test([&](int i) { return a.v[i] < b.v[i]; });
  }
  static M Le(V a, V b) {
    return Test([&](int i) { return a.v[i] <= b.v[i]; });
  }
  static M Eq(V a, V b) {
    return Test([&](int i) { return a.v[i] == b.v[i]; });
  }
  static M IsNan(V a) {
    return Test([&](int i) { return a.v[i] != a.v[i]; });
  }
  static M And(M a, M b) {
    return Test([&](int i) { return a.m[i] && b.m[i]; });
  }
  static M Or(M a, M b) {
    return Test([&](int i) { return a.m[i] || b.m[i]; });
  }
  static M Not(M a) {
    return Test([&](int i) { return !a.m[i]; });
  }
  static V Select(M m, V yes, V no) {
    return Map([&](int i) { return m.m[i] ? yes.v[i] : no.v[i]; });
  }
  static unsigned Bits(M m) {
    unsigned bits = 0;
    for (int i = 0; i < N; ++i) bits |= static_cast<unsigned>(m.m[i]) << i;
    return bits;
  }
};

}  // namespace rondo::interval::portable
