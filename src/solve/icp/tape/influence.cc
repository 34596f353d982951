// Which variable decides? Interval derivatives of every undecided comparison by reverse sweeps over the tape.
#include "solve/icp/tape/influence.h"

#include <algorithm>
#include <cmath>

namespace rondo::solve::icp {

using interval::Batch;

namespace {

Batch Constant(double value) {
  Batch b;
  std::fill(std::begin(b.nl), std::end(b.nl), -value);
  std::fill(std::begin(b.hi), std::end(b.hi), value);
  return b;
}

// How large a derivative can be; bounded, so that sums stay numbers.
double Magnitude(const Batch& b, int l) {
  const double m = std::max(std::fabs(b.nl[l]), std::fabs(b.hi[l]));
  return m < 1e9 ? m : 1e9;
}

}  // namespace

InfluenceMeter::InfluenceMeter(const Tape& tape, const interval::Kernels& kernels)
    : tape_(tape),
      k_(kernels),
      adjoints_(tape.nodes.size()),
      slopes_(tape.nodes.size()),
      known_(tape.nodes.size()) {
  std::vector<char> inside(tape.nodes.size());
  std::map<uint32_t, size_t> cone_of;
  for (size_t t = 0; t < tape.thresholds.size(); ++t) {
    if (tape.thresholds[t].lemma) continue;
    const uint32_t root = tape.nodes[tape.thresholds[t].node].a;
    const auto [it, fresh] = cone_of.emplace(root, cones_.size());
    if (fresh) cones_.emplace_back();
    Cone& cone = cones_[it->second];
    cone.thresholds.push_back(t);
    if (!fresh) continue;
    cone.root = root;
    std::fill(inside.begin(), inside.end(), 0);
    inside[cone.root] = 1;
    for (uint32_t i = cone.root + 1; i-- > 0;) {
      if (inside[i] == 0) continue;
      const Node& n = tape.nodes[i];
      cone.nodes.push_back(i);
      if (!IsComposite(n.op)) continue;
      inside[n.a] = 1;
      if (IsBinary(n.op)) inside[n.b] = 1;
    }
    for (uint32_t v = 0; v < tape.variables.size(); ++v) {
      if (inside[tape.variables[v].node] != 0) cone.variables.push_back(v);
    }
  }
}

void InfluenceMeter::Measure(const std::vector<Batch>& values, const std::vector<Lanes>& open,
                             std::vector<double>& scores) {
  ++round_;
  scores.assign(tape_.variables.size() * kLanes, 0.0);
  std::array<double, kLanes> sums{};
  for (size_t c = 0; c < cones_.size(); ++c) {
    const Cone& cone = cones_[c];
    Lanes undecided = 0;
    for (const size_t t : cone.thresholds) undecided = static_cast<Lanes>(undecided | open[t]);
    if (undecided == 0 || cone.variables.empty()) continue;
    Derive(cone, values);
    sums.fill(0);
    parts_.resize(cone.variables.size() * kLanes);
    for (size_t i = 0; i < cone.variables.size(); ++i) {
      const uint32_t node = tape_.variables[cone.variables[i]].node;
      for (int l = 0; l < kLanes; ++l) {
        const double width = std::min(1e9, values[node].hi[l] + values[node].nl[l]);
        const double part = Magnitude(adjoints_[node], l) * width;
        parts_[i * kLanes + static_cast<size_t>(l)] = part;
        sums[static_cast<size_t>(l)] += part;
      }
    }
    for (size_t i = 0; i < cone.variables.size(); ++i) {
      for (size_t l = 0; l < kLanes; ++l) {
        if ((undecided >> l & 1) != 0 && sums[l] > 0)
          scores[size_t{cone.variables[i]} * kLanes + l] += parts_[i * kLanes + l] / sums[l];
      }
    }
  }
}

bool InfluenceMeter::Gradient(uint32_t node, const std::vector<Batch>& values,
                              std::vector<interval::Interval>& gradient) {
  const auto cone = std::ranges::find_if(cones_, [&](const Cone& c) { return c.root == node; });
  if (cone == cones_.end()) return false;
  for (const uint32_t i : cone->nodes) {
    switch (tape_.nodes[i].op) {
      case NodeOp::kMin:
      case NodeOp::kMax:
      case NodeOp::kAbs:
      case NodeOp::kChoose:
      case NodeOp::kAtan2:
      case NodeOp::kAsin:
      case NodeOp::kAcos:
      case NodeOp::kTan:
        return false;
      default:
        break;
    }
  }
  ++round_;
  Derive(*cone, values);
  gradient.assign(tape_.variables.size(), interval::Interval::Point(0));
  for (const uint32_t v : cone->variables) {
    const Batch& b = adjoints_[tape_.variables[v].node];
    gradient[v] = {-b.nl[0], b.hi[0]};
  }
  return true;
}

void InfluenceMeter::Derive(const Cone& cone, const std::vector<Batch>& values) {
  const Batch zero = Constant(0);
  for (const uint32_t i : cone.nodes) adjoints_[i] = zero;
  adjoints_[cone.root] = Constant(1);
  for (const uint32_t i : cone.nodes) {
    const Node& n = tape_.nodes[i];
    if (IsComposite(n.op)) Pass(n, i, values);
  }
}

// The derivative of a function of one argument; every comparison above it needs the same.
const Batch& InfluenceMeter::Slope(const Node& n, uint32_t i, const std::vector<Batch>& values) {
  Batch& d = slopes_[i];
  if (known_[i] == round_) return d;
  known_[i] = round_;
  const Batch& a = values[n.a];
  switch (n.op) {
    case NodeOp::kSqr:
      k_.add(a, a, d);
      break;
    case NodeOp::kPow:
      k_.pow(a, static_cast<int>(n.n) - 1, d);
      k_.mul(d, Constant(n.n), d);
      break;
    case NodeOp::kSqrt:
      k_.div(Constant(0.5), values[i], d);
      break;
    case NodeOp::kSin:
      k_.cos(a, d);
      break;
    case NodeOp::kCos:
      k_.sin(a, d);
      k_.neg(d, d);
      break;
    case NodeOp::kLog:
      k_.div(Constant(1), a, d);
      break;
    case NodeOp::kAtan:
      k_.sqr(a, d);
      k_.add(d, Constant(1), d);
      k_.div(Constant(1), d, d);
      break;
    case NodeOp::kTan:
      k_.sqr(values[i], d);
      k_.add(d, Constant(1), d);
      break;
    default:  // kExp
      d = values[i];
  }
  return d;
}

// Adds what the derivative of node `i` means for its arguments.
void InfluenceMeter::Pass(const Node& n, uint32_t i, const std::vector<Batch>& values) {
  const Batch& z = adjoints_[i];
  const Batch& a = values[n.a];
  const Batch& b = values[n.b];
  Batch d, e;
  const auto add = [&](uint32_t node, const Batch& part) { k_.add(adjoints_[node], part, adjoints_[node]); };
  const auto times = [&](uint32_t node, const Batch& factor) {
    Batch product;
    k_.mul(z, factor, product);
    add(node, product);
  };
  const auto maybe = [&](uint32_t node) {  // z, or nothing
    Batch part;
    k_.hull(z, Constant(0), part);
    add(node, part);
  };
  switch (n.op) {
    case NodeOp::kAdd:
      add(n.a, z);
      add(n.b, z);
      return;
    case NodeOp::kSub:
      add(n.a, z);
      k_.neg(z, d);
      add(n.b, d);
      return;
    case NodeOp::kNeg:
      k_.neg(z, d);
      add(n.a, d);
      return;
    case NodeOp::kMul:
      times(n.a, b);
      times(n.b, a);
      return;
    case NodeOp::kDiv:
      k_.div(Constant(1), b, d);
      times(n.a, d);
      k_.mul(d, values[i], e);
      k_.neg(e, e);
      times(n.b, e);
      return;
    case NodeOp::kSqr:
    case NodeOp::kPow:
    case NodeOp::kSqrt:
    case NodeOp::kSin:
    case NodeOp::kCos:
    case NodeOp::kExp:
    case NodeOp::kLog:
    case NodeOp::kAtan:
    case NodeOp::kTan:
      times(n.a, Slope(n, i, values));
      return;
    case NodeOp::kMin:
    case NodeOp::kMax:
    case NodeOp::kChoose:
    case NodeOp::kAtan2:
      maybe(n.a);
      maybe(n.b);
      return;
    default:  // abs, asin, acos: of either sign
      k_.neg(z, d);
      k_.hull(z, d, e);
      add(n.a, e);
  }
}

}  // namespace rondo::solve::icp
