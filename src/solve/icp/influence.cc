// Which variable decides? Derivatives by one reverse sweep over the tape, as sums of magnitudes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solve/icp/contractor.h"

namespace rondo::solve::icp {

using interval::Batch;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

bool IsNumber(NodeOp op) { return op < NodeOp::kThreshold; }

}  // namespace

void Contractor::Influence(std::vector<double>& scores) {
  std::fill(adjoints_.begin(), adjoints_.end(), 0.0);
  const auto adjoint = [&](uint32_t node) { return adjoints_.data() + static_cast<size_t>(node) * kLanes; };
  const auto mag = [&](uint32_t node, int l) {
    return std::max(std::fabs(values_[node].nl[l]), std::fabs(values_[node].hi[l]));
  };
  for (const Threshold& t : tape_.thresholds) {
    if (t.lemma) continue;
    const uint32_t node = tape_.nodes[t.node].a;
    const Comparison& c = comparisons_[tape_.nodes[t.node].n];
    // An inequality that is not decided; of an equation, only equality is left.
    const auto open = static_cast<Lanes>(c.equal & (c.less | c.greater));
    const auto equation = static_cast<Lanes>(c.equal & ~c.less & ~c.greater);
    double* adj = adjoint(node);
    for (int l = 0; l < kLanes; ++l) {
      const double width = values_[node].hi[l] + values_[node].nl[l];
      if ((open >> l & 1) != 0 && width > 0 && width < kInf) adj[l] += 1 / width;
      if ((equation >> l & 1) != 0) adj[l] += 1;
    }
  }
  for (uint32_t i = static_cast<uint32_t>(tape_.nodes.size()); i-- > 0;) {
    const Node& n = tape_.nodes[i];
    if (!IsNumber(n.op)) continue;
    const double* z = adjoint(i);
    double* a = adjoint(n.a);
    double* b = adjoint(n.b);
    switch (n.op) {
      case NodeOp::kVariable:
      case NodeOp::kConstant:
        break;
      case NodeOp::kAdd:
      case NodeOp::kSub:
      case NodeOp::kMin:
      case NodeOp::kMax:
      case NodeOp::kChoose:
        for (int l = 0; l < kLanes; ++l) a[l] += z[l];
        for (int l = 0; l < kLanes; ++l) b[l] += z[l];
        break;
      case NodeOp::kMul:
        for (int l = 0; l < kLanes; ++l) {
          if (z[l] == 0) continue;
          a[l] += z[l] * mag(n.b, l);
          b[l] += z[l] * mag(n.a, l);
        }
        break;
      case NodeOp::kDiv:
        for (int l = 0; l < kLanes; ++l) {
          const double mig = std::max({0.0, -values_[n.b].nl[l], -values_[n.b].hi[l]});
          const double inverse = std::min(1e6, 1 / mig);
          a[l] += z[l] * inverse;
          b[l] += z[l] * inverse * std::min(1e6, mag(n.a, l) * inverse);
        }
        break;
      case NodeOp::kSqr:
        for (int l = 0; l < kLanes; ++l) a[l] += z[l] * 2 * mag(n.a, l);
        break;
      case NodeOp::kPow:
        for (int l = 0; l < kLanes; ++l)
          a[l] += z[l] * n.n * std::min(1e6, std::pow(mag(n.a, l), static_cast<double>(n.n) - 1));
        break;
      case NodeOp::kSqrt:
        for (int l = 0; l < kLanes; ++l)
          a[l] += z[l] * std::min(1e3, 0.5 / std::max(1e-6, -values_[i].nl[l]));
        break;
      case NodeOp::kExp:
        for (int l = 0; l < kLanes; ++l) a[l] += z[l] * std::min(1e6, mag(i, l));
        break;
      case NodeOp::kSin:
      case NodeOp::kCos:
        // |derivative| = sqrt(1 - z^2) at its largest.
        for (int l = 0; l < kLanes; ++l) {
          const double mig = std::max({0.0, -values_[i].nl[l], -values_[i].hi[l]});
          a[l] += z[l] * std::sqrt(std::max(0.0, 1 - mig * mig));
        }
        break;
      case NodeOp::kAtan2:
        for (int l = 0; l < kLanes; ++l) a[l] += z[l], b[l] += z[l];
        break;
      default:
        for (int l = 0; l < kLanes; ++l) a[l] += z[l];
    }
  }
  scores.resize(tape_.variables.size() * kLanes);
  for (size_t v = 0; v < tape_.variables.size(); ++v) {
    const Batch& b = values_[tape_.variables[v].node];
    const double* adj = adjoint(tape_.variables[v].node);
    for (int l = 0; l < kLanes; ++l) scores[v * kLanes + l] = adj[l] * (b.hi[l] + b.nl[l]);
  }
}

}  // namespace rondo::solve::icp
