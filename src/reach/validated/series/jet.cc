#include "reach/validated/series/jet.h"

#include <cmath>

#include "base/check.h"

namespace rondo::reach {

namespace {

Interval Exactly(double x) { return Interval::Point(x); }
double Whole(size_t k) { return static_cast<double>(k); }

}  // namespace

bool Jet(CodeOp function, Interval at, std::span<Interval> out) {
  if (!std::isfinite(at.lo) || !std::isfinite(at.hi)) return false;
  switch (function) {
    case CodeOp::kReciprocal:
      if (at.Contains(0)) return false;
      out[0] = Exactly(1) / at;
      for (size_t k = 1; k < out.size(); ++k) out[k] = -(out[k - 1] / at);
      return true;
    case CodeOp::kRoot:
      if (at.lo <= 0) return false;
      out[0] = interval::Sqrt(at);
      for (size_t k = 1; k < out.size(); ++k)
        out[k] = out[k - 1] * (Exactly(1.5 - Whole(k)) / (Exactly(Whole(k)) * at));
      return true;
    case CodeOp::kExp:
      out[0] = interval::Exp(at);
      for (size_t k = 1; k < out.size(); ++k) out[k] = out[k - 1] / Exactly(Whole(k));
      return true;
    case CodeOp::kLog: {
      if (at.lo <= 0) return false;
      out[0] = interval::Log(at);
      Interval power = Exactly(1) / at;
      for (size_t k = 1; k < out.size(); ++k) {
        out[k] = power / Exactly(k % 2 == 1 ? Whole(k) : -Whole(k));
        power = power / at;
      }
      return true;
    }
    case CodeOp::kSine:
    case CodeOp::kCosine: {
      const Interval s = interval::Sin(at);
      const Interval c = interval::Cos(at);
      const Interval cycle[4] = {s, c, -s, -c};
      const size_t first = function == CodeOp::kSine ? 0 : 1;
      Interval factorial = Exactly(1);
      for (size_t k = 0; k < out.size(); ++k) {
        if (k > 1) factorial = factorial * Exactly(Whole(k));
        out[k] = cycle[(first + k) % 4] / factorial;
      }
      return true;
    }
    case CodeOp::kAtan: {
      out[0] = interval::Atan(at);
      const Interval w = Exactly(1) + interval::Sqr(at);
      const Interval w1 = Exactly(2) * at;
      for (size_t k = 1; k < out.size(); ++k) {
        Interval sum = Exactly(k == 1 ? 1 : 0);
        if (k >= 2) sum = sum - Exactly(Whole(k - 1)) * out[k - 1] * w1 / Exactly(Whole(k));
        if (k >= 3) sum = sum - Exactly(Whole(k - 2)) * out[k - 2] / Exactly(Whole(k));
        out[k] = sum / w;
      }
      return true;
    }
    case CodeOp::kVariable:
    case CodeOp::kLinear:
    case CodeOp::kProduct:
    case CodeOp::kAtan2:
    case CodeOp::kAbs:
    case CodeOp::kMax:
    case CodeOp::kChoose:
      break;
  }
  CHECK(false) << "no function of one variable";
  return false;
}

}  // namespace rondo::reach
