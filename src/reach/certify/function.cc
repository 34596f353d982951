#include <algorithm>
#include <cmath>

#include "reach/certify/model.h"

namespace rondo::reach::certify {

namespace {

constexpr size_t kMostTerms = 40;

// A double below pi.
constexpr double kBelowPi = 3.14159265358979;

}  // namespace

bool TaylorCoefficients(CodeOp function, Interval at, std::span<Interval> out) {
  const Interval one = Interval::Point(1);
  const auto number = [](size_t k) { return Interval::Point(static_cast<double>(k)); };
  switch (function) {
    case CodeOp::kReciprocal:
      if (!(at.lo > 0 || at.hi < 0)) return false;
      out[0] = one / at;
      for (size_t k = 1; k < out.size(); ++k) out[k] = -(out[k - 1] / at);
      return true;
    case CodeOp::kRoot:
      if (!(at.lo > 0)) return false;
      out[0] = interval::Sqrt(at);
      // (1/2 choose k) x^(1/2 - k)
      for (size_t k = 1; k < out.size(); ++k)
        out[k] = out[k - 1] * Interval::Point(1.5 - static_cast<double>(k)) / (number(k) * at);
      return true;
    case CodeOp::kExp:
      out[0] = interval::Exp(at);
      for (size_t k = 1; k < out.size(); ++k) out[k] = out[k - 1] / number(k);
      return true;
    case CodeOp::kLog: {
      if (!(at.lo > 0)) return false;
      out[0] = interval::Log(at);
      Interval power = -one;  // (-1)^(k - 1) / x^k
      for (size_t k = 1; k < out.size(); ++k) {
        power = -(power / at);
        out[k] = power / number(k);
      }
      return true;
    }
    case CodeOp::kSine:
    case CodeOp::kCosine: {
      const Interval sine = interval::Sin(at);
      const Interval cosine = interval::Cos(at);
      const Interval cycle[] = {sine, cosine, -sine, -cosine};
      const size_t first = function == CodeOp::kSine ? 0 : 1;
      Interval factorial = one;
      for (size_t k = 0; k < out.size(); ++k) {
        if (k > 1) factorial = factorial * number(k);
        out[k] = cycle[(first + k) % 4] / factorial;
      }
      return true;
    }
    case CodeOp::kAtan: {
      out[0] = interval::Atan(at);
      // The derivative is 1 / (w + 2 x u + u^2) at x + u, w = 1 + x^2: its series divides one by a quadratic.
      const Interval w = one + interval::Sqr(at);
      Interval last = one / w;
      Interval before = Interval::Point(0);
      for (size_t k = 1; k < out.size(); ++k) {
        out[k] = last / number(k);
        const Interval next = -((Interval::Point(2) * at * last + before) / w);
        before = last;
        last = next;
      }
      return true;
    }
    default:
      return false;
  }
}

double CoefficientBound(CodeOp function, Interval at, size_t k) {
  if (function == CodeOp::kAtan) {
    // |sin(k (pi/2 - a)) cos(a)^k| / k, a = atan x: at most (1 + x^2)^(-k/2) / k.
    const double least = at.Contains(0.0) ? 0 : std::fmin(std::fabs(at.lo), std::fabs(at.hi));
    return Up(std::pow(1 + least * least, -0.5 * static_cast<double>(k)) / static_cast<double>(k));
  }
  std::vector<Interval> all(k + 1);
  return TaylorCoefficients(function, at, all) ? Magnitude(all[k]) : HUGE_VAL;
}

std::optional<Model> Algebra::Function(CodeOp function, const Model& a) const {
  const Interval range = Bounds(a);
  const double middle = a.polynomial[0];
  Model offset = a;
  offset.polynomial[0] = 0;
  Seal(offset);
  const double radius = Up(offset.norm + offset.error);
  if (!std::isfinite(radius)) return std::nullopt;
  const Interval all = interval::Hull(interval::Meet(range, Interval::Point(middle) + Around(radius)),
                                      Interval::Point(middle));
  std::vector<Interval> here(kMostTerms + 1);
  std::vector<Interval> everywhere(kMostTerms + 1);
  if (!TaylorCoefficients(function, Interval::Point(middle), here) ||
      !TaylorCoefficients(function, all, everywhere))
    return std::nullopt;
  // How far the argument is from the middle: what depends on s, and what depends on t only.
  double in_s = 0;
  double in_t = 0;
  for (size_t d = 0; d <= basis_.degree(); ++d) {
    for (size_t p = 0; p <= limit_; ++p) (d > 0 ? in_s : in_t) += offset.norms[d * stride() + p];
  }
  // Terms that all are cut off anyway are of no use.
  const double cut = std::fmax(std::pow(in_s, static_cast<double>(basis_.degree() + 1)),
                               std::pow(in_t, static_cast<double>(limit_ + 1)));
  const double scale = Magnitude(here[0]) + Magnitude(here[1]) * radius;
  const double enough = std::fmax(1e-17 * scale, 1e-3 * cut * Magnitude(here[1]) / std::fmax(radius, 1e-300));
  size_t terms = 1;
  double rest = HUGE_VAL;
  double power = radius;
  for (size_t k = 1; k < kMostTerms; ++k) {
    power = Up(power * radius);
    const double bound =
        function == CodeOp::kAtan ? CoefficientBound(function, all, k + 1) : Magnitude(everywhere[k + 1]);
    const double own = Up(bound * power);
    if (own < rest) {
      rest = own;
      terms = k;
    }
    if (rest <= enough || own > 1e3 * rest) break;
  }
  Model out = Constant(here[terms]);
  for (size_t k = terms; k-- > 0;) {
    out = Product(out, offset);
    const double constant = here[k].Middle();
    const double before = out.polynomial[0];
    out.polynomial[0] = before + constant;
    out.error = Up(out.error + Radius(here[k]) + Gamma(1) * (std::fabs(before) + std::fabs(constant)));
    Seal(out);
  }
  out.error = Up(out.error + rest);
  return out;
}

std::optional<Model> Algebra::Angle(const Model& y, const Model& x) const {
  // Turned by -a, the point lies to the right: its angle is a + atan(y' / x').
  const double a = std::atan2(y.polynomial[0], x.polynomial[0]);
  const Interval sine = interval::Sin(Interval::Point(a));
  const Interval cosine = interval::Cos(Interval::Point(a));
  const auto part = [](Interval factor, uint32_t node) {
    return LinearPart{factor.Middle(), Radius(factor), node};
  };
  const std::vector<Model> both{y, x};
  const LinearPart none{0, 0, 0};
  const Model right = Linear(std::vector{part(cosine, 1), part(sine, 0)}, none, both);
  const Model left = Linear(std::vector{part(cosine, 0), part(-sine, 1)}, none, both);
  if (!(Bounds(right).lo > 0)) return std::nullopt;
  const auto inverse = Function(CodeOp::kReciprocal, right);
  if (!inverse) return std::nullopt;
  const auto angle = Function(CodeOp::kAtan, Product(left, *inverse));
  if (!angle) return std::nullopt;
  Model out = Affine(1, *angle, Interval::Point(a));
  const Interval range = Bounds(out);
  if (!(range.lo > -kBelowPi && range.hi < kBelowPi)) return std::nullopt;
  return out;
}

}  // namespace rondo::reach::certify
