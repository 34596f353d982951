#include "solve/icp/existence.h"

#include <Eigen/Dense>
#include <cmath>

namespace rondo::solve::icp {

using interval::Interval;

Existence::Existence(const Tape& tape, const interval::Kernels& kernels) : tape_(tape), kernels_(kernels) {
  const Node& root = tape.nodes[tape.root];
  if (root.op != NodeOp::kAnd) return;
  for (uint32_t c = root.a; c < root.a + root.n; ++c) {
    const Node& atom = tape.nodes[tape.children[c]];
    if (atom.op != NodeOp::kAtom || atom.n != kEqual) continue;
    const uint32_t threshold = tape.nodes[atom.a].n;
    if (!tape.thresholds[threshold].lemma) equations_.push_back(threshold);
  }
}

// Residuals and derivatives of the equations over a box. False: not differentiable, or not defined.
bool Existence::Linearise(const std::vector<double>& box) {
  for (int l = 0; l < kLanes; ++l) contractor_->Load(l, box.data());
  contractor_->Evaluate();
  residuals_.clear();
  slopes_.assign(equations_.size(), {});
  for (size_t e = 0; e < equations_.size(); ++e) {
    const Threshold& t = tape_.thresholds[equations_[e]];
    const uint32_t node = tape_.nodes[t.node].a;
    const Interval value = contractor_->ValueOf(node, 0);
    if (value.IsEmpty()) return false;
    residuals_.push_back(value - Interval{t.below, t.above});
    if (!meter_->Gradient(node, contractor_->values(), slopes_[e])) return false;
  }
  return true;
}

std::optional<std::vector<double>> Existence::Around(const std::vector<double>& point) {
  const size_t columns = point.size();
  if (equations_.empty() || equations_.size() > columns) return std::nullopt;
  if (!contractor_) {
    contractor_.emplace(tape_, kernels_);
    meter_.emplace(tape_, kernels_);
  }
  for (const double radius : {1e-12, 1e-10, 1e-8, 1e-6, 1e-4}) {
    if (auto box = Prove(point, radius)) return box;
  }
  return std::nullopt;
}

std::optional<std::vector<double>> Existence::Prove(const std::vector<double>& point, double radius) {
  const auto m = static_cast<Eigen::Index>(equations_.size());
  std::vector<double> box;
  for (const double p : point) box.insert(box.end(), {p, p});
  if (!Linearise(box)) return std::nullopt;
  const std::vector<Interval> at_point = residuals_;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(m, static_cast<Eigen::Index>(point.size()));
  for (Eigen::Index e = 0; e < m; ++e) {
    for (size_t v = 0; v < point.size(); ++v) {
      if (!tape_.variables[v].integral)
        jacobian(e, static_cast<Eigen::Index>(v)) = slopes_[static_cast<size_t>(e)][v].Middle();
    }
  }
  if (!jacobian.allFinite()) return std::nullopt;
  // The variables that move: those by which the equations are solved best.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
  if (qr.rank() < m) return std::nullopt;
  std::vector<size_t> moving;
  Eigen::MatrixXd square(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index column = qr.colsPermutation().indices()(i);
    moving.push_back(static_cast<size_t>(column));
    square.col(i) = jacobian.col(column);
  }
  const Eigen::MatrixXd inverse = square.inverse();
  if (!inverse.allFinite()) return std::nullopt;

  std::vector<double> radii;
  for (const size_t v : moving) {
    radii.push_back(radius * std::max(1.0, std::fabs(point[v])));
    box[2 * v] = point[v] - radii.back();
    box[2 * v + 1] = point[v] + radii.back();
  }
  if (!Linearise(box)) return std::nullopt;
  // K = -Y F(point) + (1 - Y J(box)) (box - point) inside box - point.
  for (Eigen::Index i = 0; i < m; ++i) {
    Interval k{0, 0};
    for (Eigen::Index e = 0; e < m; ++e)
      k = k - Interval::Point(inverse(i, e)) * at_point[static_cast<size_t>(e)];
    for (Eigen::Index j = 0; j < m; ++j) {
      Interval factor = Interval::Point(i == j ? 1 : 0);
      for (Eigen::Index e = 0; e < m; ++e) {
        factor = factor - Interval::Point(inverse(i, e)) *
                              slopes_[static_cast<size_t>(e)][moving[static_cast<size_t>(j)]];
      }
      const size_t v = moving[static_cast<size_t>(j)];
      k = k + factor * (Interval{box[2 * v], box[2 * v + 1]} - Interval::Point(point[v]));
    }
    // The box is at least half as wide as was asked for, whatever its bounds were rounded to.
    const double inner = radii[static_cast<size_t>(i)] / 2;
    if (!(k.lo > -inner && k.hi < inner)) return std::nullopt;
  }
  return box;
}

}  // namespace rondo::solve::icp
