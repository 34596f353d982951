#include "interval/interval.h"

#include <fmt/format.h>

#include <cmath>

#include "interval/isa_portable.h"
#include "interval/operations.h"
#include "interval/widening.h"

namespace rondo::interval {
namespace {

using S = Widened<portable::Isa<1>>;
using O = Operations<S>;

O::Iv In(Interval a) { return {S::Set(-a.lo), S::Set(a.hi)}; }
// Adding zero turns -0 into 0.
Interval Out(O::Iv a) { return {-a.nl.v[0] + 0.0, a.hi.v[0] + 0.0}; }

}  // namespace

double Interval::Middle() const {
  constexpr double kMax = std::numeric_limits<double>::max();
  if (lo == hi) return lo;
  const double a = std::max(lo, -kMax);
  const double b = std::min(hi, kMax);
  if (a < 0 && b > 0 && (lo < -kMax || hi > kMax)) {
    if (lo < -kMax && hi > kMax) return 0;
    return lo < -kMax ? std::max(a, -2 * b - 1) : std::min(b, -2 * a + 1);
  }
  const double middle = a * 0.5 + b * 0.5;
  return std::min(b, std::max(a, middle));
}

Interval operator-(Interval a) { return {-a.hi, -a.lo}; }
Interval operator+(Interval a, Interval b) { return Out(O::Add(In(a), In(b))); }
Interval operator-(Interval a, Interval b) { return Out(O::Sub(In(a), In(b))); }
Interval operator*(Interval a, Interval b) { return Out(O::Mul(In(a), In(b))); }
Interval operator/(Interval a, Interval b) { return Out(O::Div(In(a), In(b))); }
Interval Meet(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)}; }
Interval Hull(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
Interval Abs(Interval a) { return Out(O::Abs(In(a))); }
Interval Sqr(Interval a) { return Out(O::Sqr(In(a))); }
Interval Pow(Interval a, int n) { return Out(O::Pow(In(a), n)); }
Interval Sqrt(Interval a) { return Out(O::Sqrt(In(a))); }
Interval Min(Interval a, Interval b) { return Out(O::Min(In(a), In(b))); }
Interval Max(Interval a, Interval b) { return Out(O::Max(In(a), In(b))); }
Interval Sin(Interval a) { return Out(O::Sin(In(a))); }
Interval Cos(Interval a) { return Out(O::Cos(In(a))); }
Interval Tan(Interval a) { return Out(O::Tan(In(a))); }
Interval Asin(Interval a) { return Out(O::Asin(In(a))); }
Interval Acos(Interval a) { return Out(O::Acos(In(a))); }
Interval Atan(Interval a) { return Out(O::Atan(In(a))); }
Interval Atan2(Interval y, Interval x) { return Out(O::Atan2(In(y), In(x))); }
Interval Exp(Interval a) { return Out(O::Exp(In(a))); }
Interval Log(Interval a) { return Out(O::Log(In(a))); }

std::string ToString(Interval a) { return fmt::format("[{}, {}]", a.lo, a.hi); }

}  // namespace rondo::interval
