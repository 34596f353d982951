#pragma once

#ifdef __AVX2__

#include <immintrin.h>

/// Internal to `interval`: eight doubles in two AVX2 registers. Rounding is always to nearest; bounds are
/// widened afterwards.
namespace rondo::interval::avx2 {

/// Is the instruction set as `Widened` expects it: arithmetic, comparisons and selection, lane by lane.
struct Isa {
  static constexpr int kLanes = 8;
  struct V {
    __m256d a, b;
  };
  using M = V;  // all bits of a lane set or clear

  static V Set(double d) { return {_mm256_set1_pd(d), _mm256_set1_pd(d)}; }
  static V Load(const double* p) { return {_mm256_load_pd(p), _mm256_load_pd(p + 4)}; }
  static void Store(double* p, V x) {
    _mm256_store_pd(p, x.a);
    _mm256_store_pd(p + 4, x.b);
  }

  static V Add(V x, V y) { return {_mm256_add_pd(x.a, y.a), _mm256_add_pd(x.b, y.b)}; }
  static V Sub(V x, V y) { return {_mm256_sub_pd(x.a, y.a), _mm256_sub_pd(x.b, y.b)}; }
  static V Mul(V x, V y) { return {_mm256_mul_pd(x.a, y.a), _mm256_mul_pd(x.b, y.b)}; }
  static V Div(V x, V y) { return {_mm256_div_pd(x.a, y.a), _mm256_div_pd(x.b, y.b)}; }
  static V Sqrt(V x) { return {_mm256_sqrt_pd(x.a), _mm256_sqrt_pd(x.b)}; }
  static V Neg(V x) {
    const V s = Set(-0.0);
    return {_mm256_xor_pd(x.a, s.a), _mm256_xor_pd(x.b, s.b)};
  }
  static V Abs(V x) {
    const V s = Set(-0.0);
    return {_mm256_andnot_pd(s.a, x.a), _mm256_andnot_pd(s.b, x.b)};
  }
  static V Max(V x, V y) { return {_mm256_max_pd(x.a, y.a), _mm256_max_pd(x.b, y.b)}; }
  static V Min(V x, V y) { return {_mm256_min_pd(x.a, y.a), _mm256_min_pd(x.b, y.b)}; }
  static V Rint(V x) {
    return {_mm256_round_pd(x.a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC),
            _mm256_round_pd(x.b, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)};
  }
  static V Floor(V x) { return {_mm256_floor_pd(x.a), _mm256_floor_pd(x.b)}; }
  static M Lt(V x, V y) { return {_mm256_cmp_pd(x.a, y.a, _CMP_LT_OQ), _mm256_cmp_pd(x.b, y.b, _CMP_LT_OQ)}; }
  static M Le(V x, V y) { return {_mm256_cmp_pd(x.a, y.a, _CMP_LE_OQ), _mm256_cmp_pd(x.b, y.b, _CMP_LE_OQ)}; }
  static M Eq(V x, V y) { return {_mm256_cmp_pd(x.a, y.a, _CMP_EQ_OQ), _mm256_cmp_pd(x.b, y.b, _CMP_EQ_OQ)}; }
  static M IsNan(V x) {
    return {_mm256_cmp_pd(x.a, x.a, _CMP_UNORD_Q), _mm256_cmp_pd(x.b, x.b, _CMP_UNORD_Q)};
  }
  static M And(M x, M y) { return {_mm256_and_pd(x.a, y.a), _mm256_and_pd(x.b, y.b)}; }
  static M Or(M x, M y) { return {_mm256_or_pd(x.a, y.a), _mm256_or_pd(x.b, y.b)}; }
  static M Not(M x) {
    const __m256d ones = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
    return {_mm256_xor_pd(x.a, ones), _mm256_xor_pd(x.b, ones)};
  }
  static V Select(M m, V yes, V no) {
    return {_mm256_blendv_pd(no.a, yes.a, m.a), _mm256_blendv_pd(no.b, yes.b, m.b)};
  }
  static unsigned Bits(M m) {
    return static_cast<unsigned>(_mm256_movemask_pd(m.a)) |
           (static_cast<unsigned>(_mm256_movemask_pd(m.b)) << 4);
  }
};

}  // namespace rondo::interval::avx2

#endif  // __AVX2__
