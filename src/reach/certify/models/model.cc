#include "reach/certify/models/model.h"

#include <algorithm>
#include <cmath>

namespace rondo::reach::certify {

namespace {

constexpr size_t kLanes = 4;  // sums that are kept apart, for vector instructions
size_t Padded(size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

// Factors of two series in time: the powers of one ascend, those of the other descend.
struct Factors {
  const double* left;
  const double* right;
};

// The sum of left[p] * right[shift + p] over all factors and p < kCount.
template <size_t kCount>
double SumOf(const std::vector<Factors>& all, size_t shift) {
  double sums[kCount] = {};
  for (const Factors& f : all) {
    const double* __restrict x = f.left;
    const double* __restrict y = f.right + shift;
    for (size_t p = 0; p < kCount; ++p) sums[p] += x[p] * y[p];
  }
  double sum = 0;
  for (const double s : sums) sum += s;
  return sum;
}

double SumOf(const std::vector<Factors>& all, size_t shift, size_t count) {
  switch (Padded(count) / kLanes) {
    case 1:
      return SumOf<kLanes>(all, shift);
    case 2:
      return SumOf<2 * kLanes>(all, shift);
    case 3:
      return SumOf<3 * kLanes>(all, shift);
    case 4:
      return SumOf<4 * kLanes>(all, shift);
    case 5:
      return SumOf<5 * kLanes>(all, shift);
    case 6:
      return SumOf<6 * kLanes>(all, shift);
    case 7:
      return SumOf<7 * kLanes>(all, shift);
    default:
      return SumOf<8 * kLanes>(all, shift);
  }
}

}  // namespace

Model Algebra::Empty() const {
  Model model;
  model.polynomial.assign(basis_.size() * stride(), 0.0);
  return model;
}

void Algebra::Seal(Model& model) const {
  const size_t powers = stride();
  model.length.assign(basis_.size(), 0);
  model.norms.assign((basis_.degree() + 1) * powers, 0.0);
  for (size_t m = 0; m < basis_.size(); ++m) {
    const double* c = model.polynomial.data() + m * powers;
    double* norms = model.norms.data() + basis_.DegreeOf(m) * powers;
    for (size_t a = 0; a <= limit_; ++a) {
      if (c[a] == 0) continue;
      norms[a] += std::fabs(c[a]);
      model.length[m] = static_cast<uint8_t>(a + 1);
    }
  }
  double sum = 0;
  for (const double n : model.norms) sum += n;
  model.norm = Up(sum);
  if (!std::isfinite(model.norm)) model.error = HUGE_VAL;
}

Model Algebra::Constant(Interval value) const {
  Model model = Empty();
  const double middle = value.Middle();
  model.polynomial[0] = middle;
  model.error = Radius(value);
  Seal(model);
  return model;
}

Model Algebra::InSymbols(std::span<const double> polynomial) const {
  Model model = Empty();
  for (size_t m = 0; m < polynomial.size(); ++m) model.polynomial[m * stride()] = polynomial[m];
  Seal(model);
  return model;
}

Model Algebra::Linear(std::span<const LinearPart> parts, const LinearPart& constant,
                      const std::vector<Model>& models) const {
  Model out = Empty();
  out.polynomial[0] = constant.factor;
  double sizes = std::fabs(constant.factor);
  double error = constant.error;
  for (const LinearPart& part : parts) {
    const Model& a = models[part.node];
    for (size_t m = 0; m < basis_.size(); ++m) {
      const double* from = a.polynomial.data() + m * stride();
      double* to = out.polynomial.data() + m * stride();
      const size_t length = std::min<size_t>(a.length[m], limit_ + 1);
      for (size_t p = 0; p < length; ++p) to[p] += part.factor * from[p];
    }
    sizes += std::fabs(part.factor) * a.norm;
    error += std::fabs(part.factor) * a.error + part.error * (a.norm + a.error);
  }
  // Every coefficient is a sum of at most one product for each part, and the constant.
  out.error = Up(error + sizes * Gamma(static_cast<double>(2 * parts.size() + 1)));
  Seal(out);
  return out;
}

// The sum of magnitudes of the products of monomials that are too high, in s or in t.
double Algebra::CutOff(const Model& a, const Model& b) const {
  const size_t degrees = basis_.degree() + 1;
  const size_t powers = limit_ + 1;
  const auto norm = [&](const Model& m, size_t d, size_t p) { return m.norms[d * stride() + p]; };
  // above[d][p]: of b, what has a degree of at least d or a power of at least p.
  std::vector<double> above((degrees + 1) * (powers + 1), 0.0);
  const auto at = [&](size_t d, size_t p) -> double& { return above[d * (powers + 1) + p]; };
  for (size_t d = degrees; d-- > 0;) {
    double row = 0;
    for (size_t p = 0; p < powers; ++p) row += norm(b, d, p);
    at(d, powers) = at(d + 1, powers) + row;
  }
  // From the highest power down: one more power of the lower degrees each time.
  for (size_t p = powers; p-- > 0;) {
    double lower = 0;
    for (size_t d = 0; d <= degrees; ++d) {
      at(d, p) = at(d, p + 1) + lower;
      if (d < degrees) lower += norm(b, d, p);
    }
  }
  double sum = 0;
  for (size_t d = 0; d < degrees; ++d) {
    for (size_t p = 0; p < powers; ++p) {
      const double own = norm(a, d, p);
      if (own != 0) sum += own * at(degrees - d, powers - p);
    }
  }
  return sum;
}

Model Algebra::NextPower(const Model& a, const Model& b, const Model& lower) const {
  Model out = Empty();
  for (size_t m = 0; m < basis_.size(); ++m) {
    double* to = out.polynomial.data() + m * stride();
    std::copy_n(lower.polynomial.data() + m * stride(), limit_, to);
    double sum = 0;
    for (const Basis::Pair& pair : basis_.Pairs(m)) {
      const size_t left = a.length[pair.left];
      if (left == 0 || b.length[pair.right] == 0) continue;
      const double* x = a.polynomial.data() + pair.left * stride();
      const double* y = b.polynomial.data() + pair.right * stride();
      for (size_t p = 0; p < left && p <= limit_; ++p) sum += x[p] * y[limit_ - p];
    }
    to[limit_] = sum;
  }
  Seal(out);
  return out;
}

Model Algebra::Product(const Model& a, const Model& b) const {
  Model out = Empty();
  const size_t powers = limit_ + 1;
  const bool square = &a == &b;
  // By monomial: a as it is, with zeros behind; b from its highest power down, with zeros behind.
  const size_t row = Padded(stride());
  std::vector<double> ascending(basis_.size() * row);
  std::vector<double> descending(basis_.size() * 2 * row);
  for (size_t m = 0; m < basis_.size(); ++m) {
    for (size_t p = 0; p < powers; ++p) {
      ascending[m * row + p] = a.polynomial[m * stride() + p];
      descending[m * 2 * row + limit_ - p] = b.polynomial[m * stride() + p];
    }
  }
  std::vector<Factors> factors;
  for (size_t m = 0; m < basis_.size(); ++m) {
    factors.clear();
    const double* twin = nullptr;  // of a square
    for (const Basis::Pair& pair : basis_.Pairs(m)) {
      if (a.length[pair.left] == 0 || b.length[pair.right] == 0) continue;
      if (square && pair.left > pair.right) continue;
      const Factors f{ascending.data() + pair.left * row, descending.data() + pair.right * (2 * row)};
      if (square && pair.left == pair.right) {
        twin = f.left;
      } else {
        factors.push_back(f);
      }
    }
    double* sum = out.polynomial.data() + m * stride();
    if (factors.empty() && twin == nullptr) continue;
    for (size_t p = 0; p < powers; ++p) {
      sum[p] = SumOf(factors, limit_ - p, p + 1) * (square ? 2 : 1);
      for (size_t q = 0; twin != nullptr && q <= p; ++q) sum[p] += twin[q] * twin[p - q];
    }
  }
  const double roundings = Gamma(2.0 * static_cast<double>(basis_.most_pairs() * powers));
  out.error = Up(CutOff(a, b) + roundings * a.norm * b.norm + a.norm * b.error + a.error * b.norm +
                 a.error * b.error);
  Seal(out);
  return out;
}

Model Algebra::Affine(double slope, const Model& a, Interval offset) const {
  Model out = Empty();
  for (size_t i = 0; i < out.polynomial.size(); ++i) out.polynomial[i] = slope * a.polynomial[i];
  const double middle = offset.Middle();
  out.polynomial[0] += middle;
  const double size = std::fabs(slope);
  out.error =
      Up(size * a.error + Radius(offset) + Gamma(3) * (size * a.norm + std::fabs(middle)) + 0x1p-1000);
  Seal(out);
  return out;
}

Model Algebra::Either(const Model& a, const Model& b) const {
  Model out = Empty();
  double apart = 0;
  for (size_t i = 0; i < out.polynomial.size(); ++i) {
    out.polynomial[i] = 0.5 * a.polynomial[i] + 0.5 * b.polynomial[i];
    apart += std::fabs(a.polynomial[i] - b.polynomial[i]);
  }
  out.error = Up(0.5 * apart + Gamma(4) * (a.norm + b.norm) + std::fmax(a.error, b.error));
  Seal(out);
  return out;
}

// What the monomials from `first` on add up to.
Interval Algebra::RangeFrom(size_t first, const Model& model, double from, double to) const {
  double lower = 0;
  double upper = 0;
  for (size_t m = first; m < basis_.size(); ++m) {
    const size_t length = model.length[m];
    if (length == 0) continue;
    const double* c = model.polynomial.data() + m * stride();
    double lo = c[length - 1];
    double hi = lo;
    for (size_t p = length - 1; p-- > 0;) {
      lo = c[p] + (lo >= 0 ? lo * from : lo * to);
      hi = c[p] + (hi >= 0 ? hi * to : hi * from);
    }
    if (m == 0) {
      lower += lo;
      upper += hi;
    } else if (basis_.IsEven(m)) {
      lower += std::fmin(0, lo);
      upper += std::fmax(0, hi);
    } else {
      const double size = std::fmax(std::fabs(lo), std::fabs(hi));
      lower -= size;
      upper += size;
    }
  }
  // At most two roundings for each power and one for each monomial.
  const double roundings = Gamma(static_cast<double>(2 * limit_ + basis_.size() + 4));
  const double error = Up(model.error + roundings * model.norm);
  return Interval{lower, upper} + Around(error);
}

Interval Algebra::Bounds(const Model& model) const { return RangeFrom(0, model, 0, 1); }

Interval Algebra::Range(const Model& model, double from, double to) const {
  // The constant in s: about the middle of the time, in interval arithmetic.
  const size_t top = std::max<size_t>(model.length[0], 1) - 1;
  const Interval time{from, to};
  const double middle = time.Middle();
  std::vector<Interval> shifted(top + 1);
  for (size_t p = 0; p <= top; ++p) shifted[p] = Interval::Point(model.polynomial[p]);
  for (size_t a = 0; a < top; ++a) {
    for (size_t p = top; p-- > a;) shifted[p] = shifted[p] + shifted[p + 1] * Interval::Point(middle);
  }
  const Interval offset = time - Interval::Point(middle);
  Interval constant = shifted[top];
  for (size_t p = top; p-- > 0;) constant = constant * offset + shifted[p];
  return constant + RangeFrom(1, model, from, to);
}

}  // namespace rondo::reach::certify
