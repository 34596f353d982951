#include "reach/validated/series/flow_set.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/check.h"
#include "reach/validated/series/bound.h"

namespace rondo::reach {

double FlowSet::Error(size_t i) const {
  const auto row = static_cast<Eigen::Index>(i);
  return Above(generators.row(row).head(used).cwiseAbs().sum() + slack[i]);
}

void FlowSet::Raise(const Monomials& monomials, size_t to) {
  const size_t more = monomials.Count(to);
  std::vector<double> next(dimension * more, 0.0);
  for (size_t i = 0; i < dimension; ++i) {
    const auto from = Polynomial(i);
    std::copy(from.begin(), from.end(), next.begin() + static_cast<std::ptrdiff_t>(i * more));
  }
  polynomials = std::move(next);
  degree = to;
  count = more;
}

double FlowSet::Top(const Monomials& monomials, size_t i) const {
  const auto p = Polynomial(i);
  double sum = 0;
  for (size_t k = degree == 0 ? 0 : monomials.Count(degree - 1); k < count; ++k) sum += std::fabs(p[k]);
  return Above(sum);
}

void FlowSet::Lower(const Monomials& monomials, size_t to) {
  const size_t fewer = monomials.Count(to);
  std::vector<double> next(dimension * fewer, 0.0);
  for (size_t i = 0; i < dimension; ++i) {
    const auto from = Polynomial(i);
    double lost = slack[i];
    for (size_t k = fewer; k < count; ++k) lost += std::fabs(from[k]);
    slack[i] = Above(lost);
    std::copy(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(fewer),
              next.begin() + static_cast<std::ptrdiff_t>(i * fewer));
  }
  polynomials = std::move(next);
  degree = to;
  count = fewer;
}

void FlowSet::AddGenerator(const Eigen::VectorXd& column) {
  if (used == generators.cols()) {
    generators.conservativeResize(static_cast<Eigen::Index>(dimension), std::max<Eigen::Index>(2 * used, 16));
  }
  generators.col(used++) = column;
}

void FlowSet::Compress(Eigen::Index capacity) {
  if (used <= capacity) return;
  // The least important half becomes slack. Importance: the largest share of any state's error.
  Eigen::VectorXd total = generators.leftCols(used).cwiseAbs().rowwise().sum();
  for (double& t : total) t = std::fmax(t, 0x1p-900);
  std::vector<double> weight(static_cast<size_t>(used));
  for (Eigen::Index g = 0; g < used; ++g)
    weight[static_cast<size_t>(g)] = generators.col(g).cwiseAbs().cwiseQuotient(total).sum();
  std::vector<Eigen::Index> order(static_cast<size_t>(used));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const Eigen::Index keep = capacity / 2;
  std::nth_element(order.begin(), order.begin() + keep, order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return weight[static_cast<size_t>(a)] > weight[static_cast<size_t>(b)];
  });
  std::sort(order.begin(), order.begin() + keep);
  for (size_t i = 0; i < dimension; ++i) {
    double lost = slack[i];
    for (auto g = static_cast<size_t>(keep); g < order.size(); ++g)
      lost += std::fabs(generators(static_cast<Eigen::Index>(i), order[g]));
    slack[i] = Above(lost);
  }
  for (Eigen::Index g = 0; g < keep; ++g)
    generators.col(g) = generators.col(order[static_cast<size_t>(g)]).eval();
  used = keep;
}

void FlowSet::Transform(const Eigen::MatrixXd& centre, std::span<const double> errors,
                        Eigen::Index capacity) {
  const auto n = static_cast<Eigen::Index>(dimension);
  for (size_t i = 0; i < dimension; ++i) {
    if (slack[i] == 0) continue;
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(n);
    unit[static_cast<Eigen::Index>(i)] = slack[i];
    AddGenerator(unit);
    slack[i] = 0;
  }
  Eigen::VectorXd total = generators.leftCols(used).cwiseAbs().rowwise().sum();
  const Eigen::VectorXd rounded = centre.cwiseAbs() * total;
  generators.leftCols(used) = (centre * generators.leftCols(used)).eval();
  for (size_t i = 0; i < dimension; ++i)
    slack[i] =
        Above(errors[i] + rounded[static_cast<Eigen::Index>(i)] * Roundings(static_cast<double>(n) + 2));
  Compress(capacity);
}

FlowSet FromBox(const interval::Box& box, const Monomials& monomials, const std::vector<int>& symbol_of) {
  FlowSet set;
  set.dimension = box.size();
  set.degree = monomials.symbols() == 0 ? 0 : 1;
  set.count = monomials.Count(set.degree);
  set.polynomials.assign(set.dimension * set.count, 0.0);
  set.slack.assign(set.dimension, 0.0);
  set.generators.resize(static_cast<Eigen::Index>(set.dimension), 16);
  for (size_t i = 0; i < box.size(); ++i) {
    const double middle = box[i].Middle();
    const double radius = std::fmax(box[i].hi - middle, middle - box[i].lo) * (1 + 0x1p-52);
    auto p = set.Polynomial(i);
    p[0] = middle;
    if (symbol_of[i] >= 0) {
      p[monomials.Symbol(static_cast<size_t>(symbol_of[i]))] = radius;
    } else if (radius > 0) {
      set.slack[i] = Above(radius);
    }
  }
  return set;
}

FlowSet Half(const FlowSet& set, const Monomials& monomials, size_t symbol, bool upper) {
  std::map<std::vector<uint8_t>, size_t> index;
  for (size_t m = 0; m < set.count; ++m) {
    const auto e = monomials.Exponents(m);
    index.emplace(std::vector<uint8_t>(e.begin(), e.end()), m);
  }
  FlowSet half = set;
  std::fill(half.polynomials.begin(), half.polynomials.end(), 0.0);
  std::vector<double> added(half.dimension * half.count);  // magnitudes, for roundings
  for (size_t m = 0; m < set.count; ++m) {
    // s^e = (1/2)^e (c + r)^e with c = -1 or 1: terms of degree k in r.
    const auto exponents = monomials.Exponents(m);
    std::vector<uint8_t> e(exponents.begin(), exponents.end());
    const unsigned power = e[symbol];
    double binomial = std::ldexp(1.0, -static_cast<int>(power));
    for (unsigned k = 0; k <= power; ++k) {
      e[symbol] = static_cast<uint8_t>(k);
      const double factor = !upper && (power - k) % 2 == 1 ? -binomial : binomial;
      const size_t to = index.at(e);
      for (size_t i = 0; i < set.dimension; ++i) {
        const double term = set.Polynomial(i)[m] * factor;  // exact: a small integer over a power of two, but
        half.Polynomial(i)[to] += term;                     // for the roundings of the product
        added[i * half.count + to] += std::fabs(term);
      }
      binomial = binomial * (power - k) / (k + 1);
    }
  }
  for (size_t i = 0; i < set.dimension; ++i) {
    double sum = 0;
    for (size_t m = 0; m < half.count; ++m) sum += added[i * half.count + m];
    half.slack[i] = Above(half.slack[i] + sum * Roundings(static_cast<double>(set.degree) + 4));
  }
  return half;
}

Interval RangeOf(const Monomials& monomials, std::span<const double> p) {
  double up = 0;
  double down = 0;
  for (size_t i = 1; i < p.size(); ++i) {
    const double size = std::fabs(p[i]);
    if (p[i] > 0 || !monomials.IsEven(i)) up += size;
    if (p[i] < 0 || !monomials.IsEven(i)) down += size;
  }
  return Interval::Point(p[0]) + Interval{-Above(down), Above(up)};
}

}  // namespace rondo::reach
