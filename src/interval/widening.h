#pragma once

#include <limits>

/// Internal to `interval`: directed rounding for instruction sets that round to nearest.
namespace rondo::interval {

/// Adds upward-rounded operations to an instruction set. For every double x, `Up(x)` is at least the next
/// double above x: ulp(x) <= |x| 2^-52 for normal x, and the smallest subnormal covers the rest; sums of
/// doubles are monotone under rounding to nearest, so rounding does not undo the step.
template <typename Base>
struct Widened : Base {
  using V = typename Base::V;
  using M = typename Base::M;

  /// Returns at least the next double above x.
  static V Up(V x) {
    // An overflow to -infinity stands for something at least as large as the smallest double.
    x = Base::Max(Base::Set(-std::numeric_limits<double>::max()), x);
    const V step = Base::Add(Base::Mul(Base::Abs(x), Base::Set(0x1p-52)), Base::Set(0x1p-1074));
    return Base::Add(x, step);
  }
  // A rounded sum that is zero is exact. (inf - inf comes from empty operands only.)
  static V AddUp(V a, V b) {
    const V s = Base::Add(a, b);
    return Base::Select(Base::Eq(s, Base::Set(0)), s, Up(s));
  }
  static V MulUp(V a, V b) {
    const V zero = Base::Set(0);
    const M exact = Base::Or(Base::Eq(a, zero), Base::Eq(b, zero));
    return Base::Select(exact, zero, Up(Base::Mul(a, b)));
  }
  // inf / inf: 0 is in the closure of the quotients, the other pairs of bounds cover the rest.
  static V DivUp(V a, V b) {
    const V zero = Base::Set(0);
    const M exact = Base::Or(Base::Eq(a, zero),
                             Base::Eq(Base::Abs(b), Base::Set(std::numeric_limits<double>::infinity())));
    return Base::Select(exact, zero, Up(Base::Div(a, b)));
  }
  static V SqrtUp(V a) {
    const V r = Base::Sqrt(a);
    return Base::Select(Base::Eq(a, Base::Set(0)), r, Up(r));
  }
  static V SqrtDown(V a) {
    const V r = Base::Sqrt(a);
    return Base::Max(Base::Set(0), Base::Neg(Up(Base::Neg(r))));
  }
};

}  // namespace rondo::interval
