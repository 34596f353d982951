#pragma once

#include "interval/batch.h"
#include "interval/inverse.h"

/// Internal to `interval`: the kernels for one instruction set, made from the operations on intervals.
namespace rondo::interval {

/// Makes the table of kernels for the instruction set `S`, which has at least the lanes of a Batch.
template <typename S>
struct BatchImpl {
  using I = Inverse<S>;
  using O = Operations<S>;
  using Iv = typename O::Iv;

  static Iv Load(const Batch& b) { return {S::Load(b.nl), S::Load(b.hi)}; }
  static void Store(Iv a, Batch& b) {
    S::Store(b.nl, a.nl);
    S::Store(b.hi, a.hi);
  }
  template <Iv (*F)(Iv)>
  static void Apply1(const Batch& a, Batch& out) {
    Store(F(Load(a)), out);
  }
  template <Iv (*F)(Iv, Iv)>
  static void Apply2(const Batch& a, const Batch& b, Batch& out) {
    Store(F(Load(a), Load(b)), out);
  }
  static void Power(const Batch& a, int n, Batch& out) { Store(O::Pow(Load(a), n), out); }

  template <Iv (*F)(Iv, Iv)>
  static void Invert1(const Batch& z, Batch& x) {
    Store(F(Load(z), Load(x)), x);
  }
  // F contracts its second argument, given the third.
  template <Iv (*F)(Iv, Iv, Iv), Iv (*G)(Iv, Iv, Iv)>
  static void Invert2(const Batch& z, Batch& x, Batch& y) {
    const Iv r = Load(z);
    const Iv a = Load(x);
    const Iv b = Load(y);
    Store(F(r, a, b), x);  // if x and y are one object, the other contraction stays
    Store(G(r, a, b), y);
  }
  static Iv AddRight(Iv z, Iv x, Iv y) { return I::Add(z, y, x); }
  static Iv SubLeft(Iv z, Iv x, Iv y) { return O::Meet(x, O::Add(z, y)); }
  static Iv SubRight(Iv z, Iv x, Iv y) { return O::Meet(y, O::Sub(x, z)); }
  static Iv MulRight(Iv z, Iv x, Iv y) { return I::Mul(z, y, x); }
  static Iv MinRight(Iv z, Iv x, Iv y) { return I::Min(z, y, x); }
  static Iv MaxRight(Iv z, Iv x, Iv y) { return I::Max(z, y, x); }
  static Iv NegArg(Iv z, Iv x) { return O::Meet(x, O::Neg(z)); }
  static void InvertPower(const Batch& z, Batch& x, int n) { Store(I::Pow(Load(z), Load(x), n), x); }
  static unsigned EmptyLanes(const Batch& a) { return S::Bits(O::IsEmpty(Load(a))) & 0xffu; }

  /// Returns the table, under this name.
  static constexpr Kernels Table(const char* name) {
    Kernels k{};
    k.name = name;
    k.neg = Apply1<O::Neg>;
    k.sqr = Apply1<O::Sqr>;
    k.sqrt = Apply1<O::Sqrt>;
    k.abs = Apply1<O::Abs>;
    k.sin = Apply1<O::Sin>;
    k.cos = Apply1<O::Cos>;
    k.tan = Apply1<O::Tan>;
    k.asin = Apply1<O::Asin>;
    k.acos = Apply1<O::Acos>;
    k.atan = Apply1<O::Atan>;
    k.exp = Apply1<O::Exp>;
    k.log = Apply1<O::Log>;
    k.add = Apply2<O::Add>;
    k.sub = Apply2<O::Sub>;
    k.mul = Apply2<O::Mul>;
    k.div = Apply2<O::Div>;
    k.min = Apply2<O::Min>;
    k.max = Apply2<O::Max>;
    k.atan2 = Apply2<O::Atan2>;
    k.meet = Apply2<O::Meet>;
    k.hull = Apply2<O::Hull>;
    k.pow = Power;
    k.neg_inverse = Invert1<NegArg>;
    k.sqr_inverse = Invert1<I::Sqr>;
    k.sqrt_inverse = Invert1<I::Sqrt>;
    k.abs_inverse = Invert1<I::Abs>;
    k.sin_inverse = Invert1<I::Sin>;
    k.cos_inverse = Invert1<I::Cos>;
    k.asin_inverse = Invert1<I::Asin>;
    k.acos_inverse = Invert1<I::Acos>;
    k.atan_inverse = Invert1<I::Atan>;
    k.exp_inverse = Invert1<I::Exp>;
    k.log_inverse = Invert1<I::Log>;
    k.add_inverse = Invert2<I::Add, AddRight>;
    k.sub_inverse = Invert2<SubLeft, SubRight>;
    k.mul_inverse = Invert2<I::Mul, MulRight>;
    k.div_inverse = Invert2<I::Dividend, I::Divisor>;
    k.min_inverse = Invert2<I::Min, MinRight>;
    k.max_inverse = Invert2<I::Max, MaxRight>;
    k.pow_inverse = InvertPower;
    k.empty = EmptyLanes;
    return k;
  }
};

}  // namespace rondo::interval
