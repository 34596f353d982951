#include "reach/certify/reach_set.h"

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

}  // namespace rondo::reach::certify
