#include <algorithm>
#include <cmath>

#include "reach/certify/models/model.h"

namespace rondo::reach::certify {

namespace {

// Of a series: first few, then more.
constexpr size_t kMostTerms[] = {6, 14, 40};

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

double ArctangentBound(Interval at, size_t k) {
  // |sin(k (pi/2 - a)) cos(a)^k| / k, a = atan x: at most (1 + x^2)^(-k/2) / k.
  const double least = at.Contains(0.0) ? 0 : std::fmin(std::fabs(at.lo), std::fabs(at.hi));
  return Up(std::pow(1 + least * least, -0.5 * static_cast<double>(k)) / static_cast<double>(k));
}

namespace {

// How many terms of the series about the middle there should be, and at least what the others add up to.
struct Series {
  size_t terms = 1;
  double rest = HUGE_VAL;
};

// `enough`: less is of no use.
Series Shorten(CodeOp function, Interval range, std::span<const Interval> everywhere, double radius,
               double enough) {
  Series series;
  double power = radius;
  for (size_t k = 1; k + 1 < everywhere.size(); ++k) {
    power = Up(power * radius);
    const double bound =
        function == CodeOp::kAtan ? ArctangentBound(range, k + 1) : Magnitude(everywhere[k + 1]);
    const double own = Up(bound * power);
    if (own < series.rest) series = {k, own};
    if (series.rest <= enough || own > 1e3 * series.rest) break;
  }
  return series;
}

}  // namespace

std::optional<Model> Algebra::Function(CodeOp function, const Model& a, const Model* lower) const {
  const Interval range = Bounds(a);
  const double middle = a.polynomial[0];
  Model offset = a;
  offset.stages.clear();
  offset.polynomial[0] = 0;
  Seal(offset);
  const double radius = Up(offset.norm + offset.error);
  if (!std::isfinite(radius)) return std::nullopt;
  const Interval all = interval::Hull(interval::Meet(range, Interval::Point(middle) + Around(radius)),
                                      Interval::Point(middle));
  // How far the argument is from the middle: what depends on s, and what depends on t only.
  double in_s = 0;
  double in_t = 0;
  for (size_t d = 0; d <= basis_.degree(); ++d) {
    for (size_t p = 0; p <= limit_; ++p) (d > 0 ? in_s : in_t) += offset.norms[d * stride() + p];
  }
  // Terms that all are cut off anyway are of no use.
  const double cut = std::fmax(std::pow(in_s, static_cast<double>(basis_.degree() + 1)),
                               std::pow(in_t, static_cast<double>(limit_ + 1)));
  std::vector<Interval> here;
  Series series;
  for (const size_t most : kMostTerms) {
    here.resize(most + 1);
    std::vector<Interval> everywhere(most + 1);
    if (!TaylorCoefficients(function, Interval::Point(middle), here) ||
        !TaylorCoefficients(function, all, everywhere))
      return std::nullopt;
    const double slope = Magnitude(here[1]);
    const double enough = std::fmax(1e-17 * (Magnitude(here[0]) + slope * radius),
                                    1e-3 * cut * slope / std::fmax(radius, 1e-300));
    series = Shorten(function, all, everywhere, radius, enough);
    if (series.rest <= enough) break;
  }
  // With the same number of terms, all but the highest power of t is as it was.
  const bool known = lower != nullptr && lower->stages.size() == series.terms;
  Model out = Constant(here[series.terms]);
  std::vector<Model> stages;
  for (size_t k = series.terms; k-- > 0;) {
    const size_t stage = series.terms - 1 - k;
    out = known ? NextPower(out, offset, lower->stages[stage]) : Product(out, offset);
    const double constant = here[k].Middle();
    const double before = out.polynomial[0];
    if (!known) out.polynomial[0] = before + constant;
    out.error = Up(out.error + Radius(here[k]) + Gamma(1) * (std::fabs(before) + std::fabs(constant)));
    Seal(out);
    if (limit_ < order_) stages.push_back(out);
  }
  out.error = Up(out.error + series.rest);
  out.stages = std::move(stages);
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
