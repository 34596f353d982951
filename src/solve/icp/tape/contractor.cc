#include "solve/icp/tape/contractor.h"

#include <cmath>
#include <cstring>

#include "base/check.h"

namespace rondo::solve::icp {

using interval::Batch;

namespace {

template <typename F>
Lanes LanesWhere(F f) {
  Lanes r = 0;
  for (int l = 0; l < kLanes; ++l) r = static_cast<Lanes>(r | (f(l) ? 1u << l : 0u));
  return r;
}

}  // namespace

Contractor::Contractor(const Tape& tape, const interval::Kernels& kernels)
    : tape_(tape),
      k_(kernels),
      values_(tape.nodes.size()),
      possible_(tape.nodes.size()),
      needed_(tape.nodes.size()),
      comparisons_(tape.thresholds.size()) {
  for (size_t i = 0; i < tape.nodes.size(); ++i) {
    for (int l = 0; l < kLanes; ++l) {
      values_[i].nl[l] = -tape.constants[i].lo;
      values_[i].hi[l] = tape.constants[i].hi;
    }
  }
}

void Contractor::Load(int lane, const double* box) {
  for (size_t v = 0; v < tape_.variables.size(); ++v) {
    Batch& b = values_[tape_.variables[v].node];
    b.nl[lane] = -box[2 * v];
    b.hi[lane] = box[2 * v + 1];
  }
}

void Contractor::Store(int lane, double* box) const {
  for (size_t v = 0; v < tape_.variables.size(); ++v) {
    const Batch& b = values_[tape_.variables[v].node];
    box[2 * v] = -b.nl[lane];
    box[2 * v + 1] = b.hi[lane];
  }
}

Lanes Contractor::Contract(int sweeps) {
  again_ = false;
  Forward();
  Lanes alive = possible_[tape_.root];
  for (int sweep = 1; alive != 0; ++sweep) {
    Backward();
    alive = static_cast<Lanes>(alive & ~Impossible());
    if (sweep >= sweeps || alive == 0) break;
    again_ = true;
    Forward();
    alive = static_cast<Lanes>(alive & possible_[tape_.root]);
  }
  return alive;
}

Lanes Contractor::Evaluate() {
  again_ = false;
  Forward();
  return possible_[tape_.root];
}

void Contractor::Open(std::vector<Lanes>& open) const {
  open.resize(comparisons_.size());
  for (size_t t = 0; t < comparisons_.size(); ++t) {
    const Comparison& c = comparisons_[t];
    // An inequality that is not decided; of an equation, only equality is left.
    open[t] = static_cast<Lanes>((c.equal & (c.less | c.greater)) | (c.equal & ~c.less & ~c.greater));
  }
}

Lanes Contractor::Impossible() const {
  Lanes empty = 0;
  for (const TapeVariable& v : tape_.variables) empty = static_cast<Lanes>(empty | k_.empty(values_[v.node]));
  for (size_t t = 0; t < comparisons_.size(); ++t) {
    const Comparison& c = comparisons_[t];
    const auto none = static_cast<Lanes>(~(c.less | c.equal | c.greater));
    empty = static_cast<Lanes>(empty | (none & needed_[tape_.thresholds[t].node]));
  }
  return empty;
}

void Contractor::Forward() {
  for (uint32_t i = 0; i < tape_.nodes.size(); ++i) ForwardNode(i);
}

void Contractor::ForwardNode(uint32_t i) {
  const Node& n = tape_.nodes[i];
  const Batch& a = values_[n.a];
  const Batch& b = values_[n.b];
  Batch fresh;
  Batch& out = again_ ? fresh : values_[i];
  switch (n.op) {
    case NodeOp::kVariable:
    case NodeOp::kConstant:
      return;
    case NodeOp::kAdd:
      k_.add(a, b, out);
      break;
    case NodeOp::kSub:
      k_.sub(a, b, out);
      break;
    case NodeOp::kMul:
      k_.mul(a, b, out);
      break;
    case NodeOp::kDiv:
      k_.div(a, b, out);
      break;
    case NodeOp::kNeg:
      k_.neg(a, out);
      break;
    case NodeOp::kSqr:
      k_.sqr(a, out);
      break;
    case NodeOp::kPow:
      k_.pow(a, static_cast<int>(n.n), out);
      break;
    case NodeOp::kSqrt:
      k_.sqrt(a, out);
      break;
    case NodeOp::kAbs:
      k_.abs(a, out);
      break;
    case NodeOp::kMin:
      k_.min(a, b, out);
      break;
    case NodeOp::kMax:
      k_.max(a, b, out);
      break;
    case NodeOp::kSin:
      k_.sin(a, out);
      break;
    case NodeOp::kCos:
      k_.cos(a, out);
      break;
    case NodeOp::kTan:
      k_.tan(a, out);
      break;
    case NodeOp::kAsin:
      k_.asin(a, out);
      break;
    case NodeOp::kAcos:
      k_.acos(a, out);
      break;
    case NodeOp::kAtan:
      k_.atan(a, out);
      break;
    case NodeOp::kAtan2:
      k_.atan2(a, b, out);
      break;
    case NodeOp::kExp:
      k_.exp(a, out);
      break;
    case NodeOp::kLog:
      k_.log(a, out);
      break;
    case NodeOp::kChoose: {
      const auto [yes, no] = tape_.conditions[n.n];
      k_.hull(a, b, out);
      Blend(static_cast<Lanes>(~possible_[no]), a, out);
      Blend(static_cast<Lanes>(~possible_[yes]), b, out);
      break;
    }
    case NodeOp::kThreshold:
    case NodeOp::kAtom:
    case NodeOp::kAnd:
    case NodeOp::kOr:
      return ForwardFormula(i);
  }
  if (again_) k_.meet(values_[i], fresh, values_[i]);
}

// What is possible of a comparison or a connective, from what is possible of its parts.
void Contractor::ForwardFormula(uint32_t i) {
  const Node& n = tape_.nodes[i];
  if (n.op == NodeOp::kThreshold) return Compare(i);
  if (n.op == NodeOp::kAtom) {
    const Comparison& c = comparisons_[tape_.nodes[n.a].n];
    possible_[i] =
        static_cast<Lanes>(((n.n & kLess) != 0 ? c.less : 0) | ((n.n & kEqual) != 0 ? c.equal : 0) |
                           ((n.n & kGreater) != 0 ? c.greater : 0));
    return;
  }
  const bool conjunction = n.op == NodeOp::kAnd;
  Lanes all = conjunction ? 0xff : 0;
  for (uint32_t c = n.a; c < n.a + n.n; ++c) {
    const Lanes child = possible_[tape_.children[c]];
    all = static_cast<Lanes>(conjunction ? all & child : all | child);
  }
  possible_[i] = all;
}

// What is possible from the enclosure; what an earlier sweep excluded stays excluded.
void Contractor::Compare(uint32_t i) {
  const Node& n = tape_.nodes[i];
  const Threshold& t = tape_.thresholds[n.n];
  const Batch& v = values_[n.a];
  const bool exact = t.below == t.above;
  Comparison now{};
  // lo < value is possible unless lo >= value, that is lo >= above; and so on.
  now.less = LanesWhere([&](int l) { return -v.nl[l] < t.above; });
  now.greater = LanesWhere([&](int l) { return v.hi[l] > t.below; });
  now.equal = exact ? LanesWhere([&](int l) { return -v.nl[l] <= t.below && v.hi[l] >= t.below; })
                    : LanesWhere([&](int l) { return -v.nl[l] <= t.below && v.hi[l] >= t.above; });
  Comparison& c = comparisons_[n.n];
  if (again_) {
    now.less &= c.less;
    now.equal &= c.equal;
    now.greater &= c.greater;
  }
  c = now;
}

}  // namespace rondo::solve::icp
