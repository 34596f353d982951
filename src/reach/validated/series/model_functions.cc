#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "reach/validated/series/bound.h"
#include "reach/validated/series/jet.h"
#include "reach/validated/series/model_series.h"

namespace rondo::reach {

bool ModelSeries::Function(CodeOp function, size_t argument, Model& out) const {
  const ModelView a = At(argument, 0);
  return Compose(function, {{a.polynomial.begin(), a.polynomial.end()}, a.radius}, out);
}

// g(c + d) = sum of g_k d^k, where c is the model's constant term, and the rest of the series by its
// enclosure.
bool ModelSeries::Compose(CodeOp function, Model d, Model& out) const {
  const Interval range = RangeOfParts(d.polynomial, d.radius);
  const double c = d.polynomial[0];
  d.polynomial[0] = 0;
  const Interval beyond = range - Interval::Point(c);
  std::vector<Interval> at_centre(degree_ + 2), at_range(degree_ + 2);
  const size_t terms = count_ == 1 ? 0 : degree_;  // the degree of the last term that is no enclosure
  if (!Jet(function, range, at_range) || !Jet(function, Interval::Point(c), at_centre)) return false;
  double reach = 1;
  for (size_t k = 0; k <= terms; ++k) reach = Above(reach * Magnitude(beyond));
  const double rest = Above(Magnitude(at_range[terms + 1]) * reach);
  const auto [top, top_error] = Centred(at_centre[terms]);
  out.polynomial.assign(count_, 0.0);
  out.polynomial[0] = top;
  out.radius = top_error;
  Model next;
  for (size_t k = terms; k-- > 0;) {
    Multiply(out, d, next);
    std::swap(out, next);
    const auto [g, error] = Centred(at_centre[k]);
    const double sum = out.polynomial[0] + g;
    out.radius = Above(out.radius + error + std::fabs(sum) * Roundings(1));
    out.polynomial[0] = sum;
  }
  out.radius = Above(out.radius + rest);
  return std::isfinite(out.radius);
}

// atan2(y, x) on a half plane that does not meet the negative x axis: a constant and an arctangent.
bool ModelSeries::Arctangent2(size_t y, size_t x, double* out, double& radius) {
  const Interval ry = Range(y, 0);
  const Interval rx = Range(x, 0);
  if (std::isnan(ry.lo + ry.hi + rx.lo + rx.hi)) return false;
  // Where the quotient is small, its series converges best.
  const bool flat = rx.lo > 0 && Magnitude(ry) <= rx.lo;
  const bool upper = ry.lo > 0 && !flat;
  const bool lower = ry.hi < 0 && !flat;
  if (!upper && !lower && rx.lo <= 0) return false;
  const size_t divisor = upper || lower ? y : x;
  const size_t dividend = upper || lower ? x : y;
  Model inverse;
  if (!Function(CodeOp::kReciprocal, divisor, inverse)) return false;
  Model quotient;
  quotient.polynomial.resize(count_);
  MultiplyInto(Values(dividend, 0), Radius(dividend, 0), inverse, quotient.polynomial.data(),
               quotient.radius);
  Model sum;
  if (!Compose(CodeOp::kAtan, std::move(quotient), sum)) return false;
  double total = sum.radius;
  std::copy(sum.polynomial.begin(), sum.polynomial.end(), out);
  if (upper || lower) {
    // pi/2 - atan(x / y), with the sign of y
    const Interval quarter = Interval::Point(2) * interval::Atan(Interval::Point(1));
    const auto [middle, error] = Centred(upper ? quarter : -quarter);
    for (size_t i = 0; i < count_; ++i) out[i] = -out[i];
    out[0] += middle;
    total = Above(total + error + std::fabs(out[0]) * Roundings(1));
  }
  radius = total;
  return std::isfinite(total);
}

// The value is scratch_ times a factor.
void ModelSeries::Scale(size_t node, size_t order, double factor, double error) {
  double* out = Values(node, order);
  double norm = 0;
  for (size_t i = 0; i < count_; ++i) {
    out[i] = scratch_[i] * factor;
    norm += std::fabs(out[i]);
  }
  Radius(node, order) =
      Above(std::fabs(factor) * error + norm * Roundings(2) + static_cast<double>(count_) * 0x1p-1070);
}

// scratch_ = from[order] - factor * scratch_; the error
double ModelSeries::Subtracted(size_t from, size_t order, double factor, double error) {
  const double* v = Values(from, order);
  double norm = 0;
  for (size_t i = 0; i < count_; ++i) {
    const double part = factor * scratch_[i];
    scratch_[i] = v[i] - part;
    norm += std::fabs(v[i]) + std::fabs(part);
  }
  return Above(factor * error + Radius(from, order) + norm * Roundings(3) +
               static_cast<double>(count_) * 0x1p-1070);
}

// The value is scratch_ times the inverse of a coefficient of order 0.
void ModelSeries::Divide(size_t node, size_t order, double error) {
  MultiplyInto(scratch_.data(), error, inverses_[node], Values(node, order), Radius(node, order));
}

bool ModelSeries::Assign(size_t node, CodeOp function, uint32_t argument) {
  Model model;
  if (!Function(function, argument, model)) return false;
  std::copy(model.polynomial.begin(), model.polynomial.end(), Values(node, 0));
  Radius(node, 0) = model.radius;
  return true;
}

bool ModelSeries::Invert(size_t node, uint32_t argument) {
  return last_ == 0 || Function(CodeOp::kReciprocal, argument, inverses_[node]);
}

// The value of a function, and what the orders above are divided by.
bool ModelSeries::FunctionNode(uint32_t n) {
  const Code& c = program_.code[n];
  switch (c.op) {
    case CodeOp::kReciprocal:
      if (!Function(c.op, c.a, inverses_[n])) return false;
      std::copy(inverses_[n].polynomial.begin(), inverses_[n].polynomial.end(), Values(n, 0));
      Radius(n, 0) = inverses_[n].radius;
      return true;
    case CodeOp::kRoot:
      if (!Assign(n, c.op, c.a)) return false;
      Finish(n, 0);
      if (!Invert(n, n)) return false;
      for (double& x : inverses_[n].polynomial) x *= 0.5;
      inverses_[n].radius *= 0.5;
      return true;
    case CodeOp::kLog:
      return Assign(n, c.op, c.a) && Invert(n, c.a);
    case CodeOp::kAtan:
      return Assign(n, c.op, c.a) && Invert(n, c.b);
    case CodeOp::kAtan2:
      return Arctangent2(c.a, c.b, Values(n, 0), Radius(n, 0)) && Invert(n, c.c);
    default:
      return Assign(n, c.op, c.a);
  }
}

// z' (x^2 + y^2) = x y' - y x'
void ModelSeries::Arctangent2Order(uint32_t n, size_t order, double share) {
  const Node& node = nodes_[n];
  std::vector<double> total(count_);
  const double first = Convolution(node.sums[1], order, total.data());
  const double second = Convolution(node.sums[2], order, scratch_.data());
  double norm = 0;
  for (size_t i = 0; i < count_; ++i) {
    norm += std::fabs(total[i]) + std::fabs(scratch_[i]);
    total[i] -= scratch_[i];
  }
  const double third = Convolution(node.sums[0], order, scratch_.data());
  for (size_t i = 0; i < count_; ++i) {
    norm += std::fabs(scratch_[i]);
    scratch_[i] = (total[i] - scratch_[i]) * share;
  }
  Divide(n, order, Above((first + second + third + norm * Roundings(6)) * share));
}

// A coefficient of a function above order 0: from those below, by its differential equation.
void ModelSeries::FunctionOrder(uint32_t n, size_t order) {
  const Code& c = program_.code[n];
  const double share = 1 / static_cast<double>(order);
  if (c.op == CodeOp::kAtan2) return Arctangent2Order(n, order, share);
  const double error = Convolution(nodes_[n].sums[0], order, scratch_.data());
  switch (c.op) {
    case CodeOp::kReciprocal:
      for (double& x : scratch_) x = -x;
      return Divide(n, order, error);
    case CodeOp::kRoot:
      return Divide(n, order, Subtracted(c.a, order, 1, error));
    case CodeOp::kLog:
    case CodeOp::kAtan:
      return Divide(n, order, Subtracted(c.a, order, share, error));
    case CodeOp::kCosine:
      return Scale(n, order, -share, error);
    default:  // sine and exponential
      return Scale(n, order, share, error);
  }
}

}  // namespace rondo::reach
