#include "solve/icp/tape/descent.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace rondo::solve::icp {
namespace {

constexpr int kSteps = 40;
/// Comparisons should hold by this much, so that they still do after rounding.
constexpr double kMargin = 1e-7;
constexpr double kNear = 1e-9;
constexpr int kPolish = 3;
/// Where nothing bounds a variable, it begins here.
constexpr double kFar = 100;
constexpr double kDamping = 1e-9;

}  // namespace

Descent::Descent(const Tape& tape, const std::vector<double>& box)
    : tape_(tape),
      box_(box),
      point_(tape.variables.size()),
      values_(tape.nodes.size()),
      adjoints_(tape.nodes.size()) {}

std::optional<std::vector<double>> Descent::Try() {
  for (size_t v = 0; v < point_.size(); ++v) {
    const double lo = std::max(box_[2 * v], std::min(-kFar, box_[2 * v + 1] - kFar));
    const double hi = std::min(box_[2 * v + 1], std::max(kFar, lo + kFar));
    const double share = static_cast<double>(rng_() >> 11) * 0x1p-53;
    point_[v] = lo + (hi - lo) * share;
  }
  std::vector<Violation> violations;
  int polished = 0;
  for (int step = 0; step < kSteps; ++step) {
    for (size_t v = 0; v < point_.size(); ++v) {
      if (tape_.variables[v].integral) point_[v] = std::round(point_[v]);
    }
    Evaluate();
    violations.clear();
    const double total = Collect(tape_.root, violations);
    if (std::isnan(total)) return std::nullopt;
    const bool near = std::ranges::all_of(
        violations, [](const Violation& v) { return v.equation && std::fabs(v.by) < kNear; });
    // Equations are mended a few times more, as far as rounding allows.
    polished = near ? polished + 1 : 0;
    if (violations.empty() || polished > kPolish) return point_;
    if (!Step(violations)) return near ? std::optional(point_) : std::nullopt;
  }
  return std::nullopt;
}

void Descent::Evaluate() {
  for (size_t v = 0; v < point_.size(); ++v) values_[tape_.variables[v].node] = point_[v];
  for (size_t i = 0; i < tape_.nodes.size(); ++i) {
    const Node& n = tape_.nodes[i];
    if (n.op == NodeOp::kConstant) values_[i] = tape_.constants[i].Middle();
    if (IsComposite(n.op)) values_[i] = Value(n);
  }
}

double Descent::Value(const Node& n) const {
  const double a = values_[n.a];
  const double b = values_[n.b];
  switch (n.op) {
    case NodeOp::kAdd:
      return a + b;
    case NodeOp::kSub:
      return a - b;
    case NodeOp::kMul:
      return a * b;
    case NodeOp::kDiv:
      return a / b;
    case NodeOp::kNeg:
      return -a;
    case NodeOp::kSqr:
      return a * a;
    case NodeOp::kPow:
      return std::pow(a, n.n);
    case NodeOp::kSqrt:
      return std::sqrt(a);
    case NodeOp::kAbs:
      return std::fabs(a);
    case NodeOp::kMin:
      return std::min(a, b);
    case NodeOp::kMax:
      return std::max(a, b);
    case NodeOp::kSin:
      return std::sin(a);
    case NodeOp::kCos:
      return std::cos(a);
    case NodeOp::kTan:
      return std::tan(a);
    case NodeOp::kAsin:
      return std::asin(a);
    case NodeOp::kAcos:
      return std::acos(a);
    case NodeOp::kAtan:
      return std::atan(a);
    case NodeOp::kAtan2:
      return std::atan2(a, b);
    case NodeOp::kExp:
      return std::exp(a);
    case NodeOp::kLog:
      return std::log(a);
    case NodeOp::kChoose: {
      std::vector<Violation> unused;
      return Collect(tape_.conditions[n.n].first, unused) == 0 ? a : b;
    }
    default:
      return 0;
  }
}

// What must change for the formula to hold, and by how much in all; of a disjunction, the nearest
// alternative.
double Descent::Collect(uint32_t formula, std::vector<Violation>& out) const {
  const Node& n = tape_.nodes[formula];
  if (n.op == NodeOp::kAnd) {
    double total = 0;
    for (uint32_t c = n.a; c < n.a + n.n; ++c) total += Collect(tape_.children[c], out);
    return total;
  }
  if (n.op == NodeOp::kOr) {
    std::vector<Violation> best;
    double least = NAN;
    for (uint32_t c = n.a; c < n.a + n.n; ++c) {
      std::vector<Violation> one;
      const double total = Collect(tape_.children[c], one);
      if (std::isnan(total) || total >= least) continue;
      least = total;
      best = std::move(one);
    }
    out.insert(out.end(), best.begin(), best.end());
    return least;
  }
  const Threshold& t = tape_.thresholds[tape_.nodes[n.a].n];
  if (t.lemma) return 0;
  const uint32_t node = tape_.nodes[t.node].a;
  const double value = values_[node];
  const double bound = t.below;
  double by = 0;
  if (std::isnan(value)) return NAN;
  const double margin = kMargin * std::max(1.0, std::fabs(bound));
  if (n.n == kEqual) {
    by = std::fabs(bound - value) > 1e-15 * std::max(1.0, std::fabs(bound)) ? bound - value : 0;
  } else if ((n.n & kGreater) == 0) {
    by = value > bound - margin / 2 ? bound - margin - value : 0;
  } else if ((n.n & kLess) == 0) {
    by = value < bound + margin / 2 ? bound + margin - value : 0;
  } else if (value == bound) {
    by = margin;
  }
  if (by != 0) out.push_back({node, by, n.n == kEqual});
  return std::fabs(by);
}

// x += J^T (J J^T + damping)^-1 by, inside the box.
bool Descent::Step(const std::vector<Violation>& violations) {
  const auto rows = static_cast<Eigen::Index>(violations.size());
  const auto columns = static_cast<Eigen::Index>(point_.size());
  Eigen::MatrixXd jacobian(rows, columns);
  Eigen::VectorXd change(rows);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const Violation& violation = violations[static_cast<size_t>(r)];
    Differentiate(violation.node);
    change(r) = violation.by;
    for (Eigen::Index c = 0; c < columns; ++c) {
      const size_t v = static_cast<size_t>(c);
      // What stands at its bound and would leave the box stays.
      const double slope = adjoints_[tape_.variables[v].node];
      const bool stuck = (point_[v] <= box_[2 * v] && slope * violation.by < 0) ||
                         (point_[v] >= box_[2 * v + 1] && slope * violation.by > 0);
      jacobian(r, c) = stuck ? 0 : slope;
    }
  }
  Eigen::MatrixXd square = jacobian * jacobian.transpose();
  square.diagonal().array() += kDamping * (1 + square.diagonal().maxCoeff());
  const Eigen::VectorXd step = jacobian.transpose() * square.ldlt().solve(change);
  if (!step.allFinite()) return false;
  bool moved = false;
  for (size_t v = 0; v < point_.size(); ++v) {
    const double next =
        std::clamp(point_[v] + step(static_cast<Eigen::Index>(v)), box_[2 * v], box_[2 * v + 1]);
    moved = moved || next != point_[v];
    point_[v] = next;
  }
  return moved;
}

void Descent::Differentiate(uint32_t node) {
  std::fill(adjoints_.begin(), adjoints_.end(), 0.0);
  adjoints_[node] = 1;
  for (uint32_t i = node + 1; i-- > 0;) {
    const Node& n = tape_.nodes[i];
    if (adjoints_[i] != 0 && IsComposite(n.op)) Pass(n, i);
  }
}

void Descent::Pass(const Node& n, uint32_t i) {
  const double z = adjoints_[i];
  const double a = values_[n.a];
  const double b = values_[n.b];
  const double v = values_[i];
  double da = 0;
  double db = 0;
  switch (n.op) {
    case NodeOp::kAdd:
      da = db = 1;
      break;
    case NodeOp::kSub:
      da = 1;
      db = -1;
      break;
    case NodeOp::kMul:
      da = b;
      db = a;
      break;
    case NodeOp::kDiv:
      da = 1 / b;
      db = -v / b;
      break;
    case NodeOp::kNeg:
      da = -1;
      break;
    case NodeOp::kSqr:
      da = 2 * a;
      break;
    case NodeOp::kPow:
      da = n.n * std::pow(a, static_cast<double>(n.n) - 1);
      break;
    case NodeOp::kSqrt:
      da = 0.5 / std::max(v, 1e-9);
      break;
    case NodeOp::kAbs:
      da = a < 0 ? -1 : 1;
      break;
    case NodeOp::kMin:
      (a <= b ? da : db) = 1;
      break;
    case NodeOp::kMax:
      (a >= b ? da : db) = 1;
      break;
    case NodeOp::kChoose:
      (v == a ? da : db) = 1;
      break;
    case NodeOp::kSin:
      da = std::cos(a);
      break;
    case NodeOp::kCos:
      da = -std::sin(a);
      break;
    case NodeOp::kTan:
      da = 1 + v * v;
      break;
    case NodeOp::kAsin:
      da = 1 / std::sqrt(std::max(1e-12, 1 - a * a));
      break;
    case NodeOp::kAcos:
      da = -1 / std::sqrt(std::max(1e-12, 1 - a * a));
      break;
    case NodeOp::kAtan:
      da = 1 / (1 + a * a);
      break;
    case NodeOp::kAtan2: {
      const double square = std::max(1e-12, a * a + b * b);
      da = b / square;
      db = -a / square;
      break;
    }
    case NodeOp::kExp:
      da = v;
      break;
    case NodeOp::kLog:
      da = 1 / a;
      break;
    default:
      break;
  }
  adjoints_[n.a] += z * da;
  if (db != 0) adjoints_[n.b] += z * db;
}

}  // namespace rondo::solve::icp
