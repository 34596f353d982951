#include "sim/motions/condition.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rondo::sim::motions {

double Between(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

base::Result<Functions> Functions::Of(const expr::Arena& arena, const std::vector<expr::TermId>& terms,
                                      const std::vector<expr::TermId>& variables) {
  auto program = reach::Compile(arena, variables, terms);
  if (!program.ok()) return program.error();
  return Functions(std::move(program).value());
}

std::span<const double> Functions::operator()(std::span<const double> variables) {
  code_->evaluate(variables, values_);
  return values_;
}

base::Result<Condition> Condition::Of(expr::Arena& arena, expr::TermId formula,
                                      const std::vector<expr::TermId>& variables) {
  auto normal = reach::Normalise(arena, formula);
  if (!normal.ok()) return normal.error();
  auto terms = Functions::Of(arena, normal.value().terms, variables);
  if (!terms.ok()) return terms.error();
  return Condition(std::move(normal).value(), std::move(terms).value());
}

double Condition::Miss(std::span<const double> values) { return Miss(formula_.root, terms_(values)); }

double Condition::Miss(size_t node, std::span<const double> terms) const {
  const reach::Formula::Node& n = formula_.nodes[node];
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (n.kind == reach::Formula::Kind::kAtom) return std::isnan(terms[n.atom]) ? kNone : terms[n.atom];
  const bool all = n.kind == reach::Formula::Kind::kAnd;
  double miss = all ? -kNone : kNone;
  for (const size_t part : n.parts) {
    const double m = Miss(part, terms);
    miss = all ? std::max(miss, m) : std::min(miss, m);
  }
  return miss;
}

// Of a disjunction, the part that is nearest to holding.
void Condition::Violated(size_t node, std::span<const double> terms, std::vector<size_t>& atoms) const {
  const reach::Formula::Node& n = formula_.nodes[node];
  switch (n.kind) {
    case reach::Formula::Kind::kAtom:
      if (terms[n.atom] > 0) atoms.push_back(n.atom);
      return;
    case reach::Formula::Kind::kAnd:
      for (const size_t part : n.parts) Violated(part, terms, atoms);
      return;
    case reach::Formula::Kind::kOr: {
      const auto best = std::ranges::min_element(n.parts, {}, [&](size_t part) { return Miss(part, terms); });
      if (best != n.parts.end()) Violated(*best, terms, atoms);
      return;
    }
  }
}

bool Condition::Approach(std::span<double> values, std::span<const size_t> free) {
  constexpr int kSteps = 60, kHalvings = 6;
  constexpr double kDifference = 1e-7;
  const auto n = static_cast<Eigen::Index>(free.size());
  std::vector<double> before;
  for (int step = 0; step < kSteps; ++step) {
    const auto terms = terms_(values);
    const double miss = Miss(formula_.root, terms);
    if (miss <= 0) return true;
    std::vector<size_t> atoms;
    Violated(formula_.root, terms, atoms);
    if (atoms.empty() || free.empty()) return false;
    const auto m = static_cast<Eigen::Index>(atoms.size());
    Eigen::VectorXd residual(m);
    for (Eigen::Index i = 0; i < m; ++i) residual(i) = terms[atoms[static_cast<size_t>(i)]];
    Eigen::MatrixXd slopes(m, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      double& value = values[free[static_cast<size_t>(j)]];
      const double kept = value, h = kDifference * (1 + std::abs(kept));
      value = kept + h;
      const auto moved = terms_(values);
      for (Eigen::Index i = 0; i < m; ++i)
        slopes(i, j) = (moved[atoms[static_cast<size_t>(i)]] - residual(i)) / h;
      value = kept;
    }
    if (!slopes.allFinite() || !residual.allFinite()) return false;
    const Eigen::VectorXd way = slopes.completeOrthogonalDecomposition().solve(residual);
    before.clear();
    for (const size_t f : free) before.push_back(values[f]);
    double share = 1;
    for (int halving = 0; halving <= kHalvings; ++halving, share /= 2) {
      for (Eigen::Index j = 0; j < n; ++j)
        values[free[static_cast<size_t>(j)]] = before[static_cast<size_t>(j)] - share * way(j);
      if (Miss(values) < miss) break;
    }
    if (miss > kTolerance || Miss(values) < miss) continue;
    // Good enough, and rounding lets it get no better.
    for (size_t j = 0; j < free.size(); ++j) values[free[j]] = before[j];
    return true;
  }
  return Holds(values);
}

}  // namespace rondo::sim::motions
