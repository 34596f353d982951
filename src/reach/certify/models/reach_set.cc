#include "reach/certify/models/reach_set.h"

#include <algorithm>
#include <cmath>

namespace rondo::reach::certify {

Eigen::VectorXd ReachSet::Errors() const {
  Eigen::VectorXd sum = generators.cwiseAbs().rowwise().sum();
  return sum.unaryExpr([](double x) { return Up(x); });
}

void ReachSet::AddErrors(const Eigen::VectorXd& errors) {
  const Eigen::Index n = errors.size();
  Eigen::Index at = generators.cols();
  const auto more = static_cast<Eigen::Index>((errors.array() > 0).count());
  generators.conservativeResize(n, at + more);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(errors[i] > 0)) continue;
    generators.col(at).setZero();
    generators(i, at++) = errors[i];
  }
}

void ReachSet::Reduce(Eigen::Index most) {
  const Eigen::Index count = generators.cols();
  if (count <= most) return;
  // How much of any state's error a column is.
  const Eigen::VectorXd total = generators.cwiseAbs().rowwise().sum().cwiseMax(1e-300);
  std::vector<std::pair<double, Eigen::Index>> order;
  for (Eigen::Index g = 0; g < count; ++g)
    order.emplace_back(-generators.col(g).cwiseAbs().cwiseQuotient(total).maxCoeff(), g);
  std::sort(order.begin(), order.end());
  const Eigen::Index keep = most / 2;
  Eigen::MatrixXd kept(generators.rows(), keep);
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(generators.rows());
  for (Eigen::Index g = 0; g < count; ++g) {
    const auto column = generators.col(order[static_cast<size_t>(g)].second);
    if (g < keep) {
      kept.col(g) = column;
    } else {
      lost += column.cwiseAbs();
    }
  }
  generators = std::move(kept);
  AddErrors(lost.unaryExpr([](double x) { return x > 0 ? Up(x) : 0.0; }));
}

void ReachSet::SetBasis(std::shared_ptr<const Basis> to) {
  if (to == basis) return;
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(states()));
  for (size_t i = 0; i < states(); ++i) {
    double sum = 0;
    for (size_t m = to->size(); m < polynomials[i].size(); ++m) sum += std::fabs(polynomials[i][m]);
    if (sum > 0) lost[static_cast<Eigen::Index>(i)] = Up(sum);
    polynomials[i].resize(to->size(), 0.0);
  }
  AddErrors(lost);
  basis = std::move(to);
}

// s = (1 + r) / 2 or (r - 1) / 2, r in [-1, 1].
ReachSet ReachSet::Half(size_t symbol, bool upper) const {
  ReachSet half = *this;
  Eigen::VectorXd rounded(static_cast<Eigen::Index>(states()));
  for (size_t i = 0; i < states(); ++i) {
    std::vector<double>& out = half.polynomials[i];
    std::fill(out.begin(), out.end(), 0.0);
    double sizes = 0;
    for (size_t m = 0; m < out.size(); ++m) {
      const auto span = basis->Exponents(m);
      std::vector<uint32_t> exponents(span.begin(), span.end());
      const uint32_t power = exponents.empty() ? 0 : exponents[symbol];
      // (c + r)^power: c^(power - k) (power choose k) r^k.
      double choose = std::ldexp(1.0, -static_cast<int>(power));
      for (uint32_t k = 0; k <= power; ++k) {
        if (!exponents.empty()) exponents[symbol] = k;
        const double term = polynomials[i][m] * (!upper && (power - k) % 2 == 1 ? -choose : choose);
        out[*basis->Find(exponents)] += term;
        sizes += std::fabs(term);
        choose = choose * (power - k) / (k + 1);
      }
    }
    // Binomials are exact; a coefficient is a sum of at most `degree` + 1 products.
    rounded[static_cast<Eigen::Index>(i)] = Up(Gamma(static_cast<double>(basis->degree()) + 3) * sizes);
  }
  half.AddErrors(rounded);
  return half;
}

Interval ReachSet::RangeOf(size_t state) const {
  const Algebra algebra(*basis, 0);
  return algebra.Range(algebra.InSymbols(polynomials[state]), 0, 0);
}

interval::Box ReachSet::Box() const {
  const Eigen::VectorXd errors = Errors();
  interval::Box box;
  for (size_t i = 0; i < states(); ++i)
    box.push_back(RangeOf(i) + Around(errors[static_cast<Eigen::Index>(i)]));
  return box;
}

Eigen::VectorXd DistanceIn(double seconds, const interval::Box& rates) {
  Eigen::VectorXd far = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rates.size()));
  for (size_t i = 0; i < rates.size() && seconds > 0; ++i)
    far[static_cast<Eigen::Index>(i)] = Up(seconds * Magnitude(rates[i]));
  return far;
}

}  // namespace rondo::reach::certify
