#pragma once

#ifdef __AVX512F__

#include <immintrin.h>

/// Internal to `interval`: eight doubles in one AVX-512 register; every operation carries its rounding.
namespace rondo::interval::avx512 {

/// Is the instruction set as `Operations` expects it: `AddUp`, `MulUp`, `DivUp` and `SqrtUp` round upwards,
/// `SqrtDown` rounds downwards. A product or quotient that is NaN (0 * inf, inf / inf) is 0.
struct Isa {
  static constexpr int kLanes = 8;
  using V = __m512d;
  using M = __mmask8;
  static constexpr int kUpward = _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC;
  static constexpr int kDownward = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;

  static V Set(double d) { return _mm512_set1_pd(d); }
  static V Load(const double* p) { return _mm512_load_pd(p); }
  static void Store(double* p, V a) { _mm512_store_pd(p, a); }

  static V Add(V a, V b) { return _mm512_add_pd(a, b); }
  static V Sub(V a, V b) { return _mm512_sub_pd(a, b); }
  static V Mul(V a, V b) { return _mm512_mul_pd(a, b); }
  static V Div(V a, V b) { return _mm512_div_pd(a, b); }
  static V Sqrt(V a) { return _mm512_sqrt_pd(a); }
  static V Neg(V a) { return _mm512_xor_pd(a, Set(-0.0)); }
  static V Abs(V a) { return _mm512_andnot_pd(Set(-0.0), a); }
  static V Max(V a, V b) { return _mm512_max_pd(a, b); }
  static V Min(V a, V b) { return _mm512_min_pd(a, b); }
  static V Rint(V a) { return _mm512_roundscale_pd(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }
  static V Floor(V a) { return _mm512_roundscale_pd(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
  static M Lt(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
  static M Le(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
  static M Eq(V a, V b) { return _mm512_cmp_pd_mask(a, b, _CMP_EQ_OQ); }
  static M IsNan(V a) { return _mm512_cmp_pd_mask(a, a, _CMP_UNORD_Q); }
  static M And(M a, M b) { return static_cast<M>(a & b); }
  static M Or(M a, M b) { return static_cast<M>(a | b); }
  static M Not(M a) { return static_cast<M>(~a); }
  static V Select(M m, V yes, V no) { return _mm512_mask_blend_pd(m, no, yes); }
  static unsigned Bits(M m) { return m; }

  static V AddUp(V a, V b) { return _mm512_add_round_pd(a, b, kUpward); }
  static V MulUp(V a, V b) {
    const V p = _mm512_mul_round_pd(a, b, kUpward);
    return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(p, p, _CMP_ORD_Q), p);
  }
  static V DivUp(V a, V b) {
    const V q = _mm512_div_round_pd(a, b, kUpward);
    return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(q, q, _CMP_ORD_Q), q);
  }
  static V SqrtUp(V a) { return _mm512_sqrt_round_pd(a, kUpward); }
  static V SqrtDown(V a) { return _mm512_sqrt_round_pd(a, kDownward); }
};

}  // namespace rondo::interval::avx512

#endif  // __AVX512F__
