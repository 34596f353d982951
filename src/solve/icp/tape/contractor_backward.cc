#include <cmath>
#include <cstring>

#include "base/check.h"
#include "solve/icp/tape/contractor.h"

namespace rondo::solve::icp {

using interval::Batch;

void Contractor::Backward() {
  std::memset(needed_.data(), 0, needed_.size());
  needed_[tape_.root] = 0xff;
  for (uint32_t i = static_cast<uint32_t>(tape_.nodes.size()); i-- > 0;) {
    const Node& n = tape_.nodes[i];
    const Lanes need = needed_[i];
    if (need == 0) continue;
    switch (n.op) {
      case NodeOp::kAnd:
        for (uint32_t c = n.a; c < n.a + n.n; ++c) needed_[tape_.children[c]] |= need;
        break;
      case NodeOp::kOr: {
        // Where a single child is possible, it must be true.
        Lanes one = 0;
        Lanes more = 0;
        for (uint32_t c = n.a; c < n.a + n.n; ++c) {
          const Lanes child = possible_[tape_.children[c]];
          more = static_cast<Lanes>(more | (one & child));
          one = static_cast<Lanes>(one | child);
        }
        const auto single = static_cast<Lanes>(one & ~more & need);
        if (single == 0) break;
        for (uint32_t c = n.a; c < n.a + n.n; ++c) {
          const uint32_t child = tape_.children[c];
          needed_[child] = static_cast<Lanes>(needed_[child] | (single & possible_[child]));
        }
        break;
      }
      case NodeOp::kAtom: {
        Comparison& c = comparisons_[tape_.nodes[n.a].n];
        if ((n.n & kLess) == 0) c.less = static_cast<Lanes>(c.less & ~need);
        if ((n.n & kEqual) == 0) c.equal = static_cast<Lanes>(c.equal & ~need);
        if ((n.n & kGreater) == 0) c.greater = static_cast<Lanes>(c.greater & ~need);
        needed_[n.a] |= need;
        break;
      }
      case NodeOp::kThreshold:
        RequireThreshold(i);
        break;
      default:
        BackwardNumber(i);
    }
  }
  for (const TapeVariable& v : tape_.variables) {
    if (!v.integral) continue;
    Batch& b = values_[v.node];
    for (int l = 0; l < kLanes; ++l) {
      b.nl[l] = std::floor(b.nl[l]);
      b.hi[l] = std::floor(b.hi[l]);
    }
  }
}

void Contractor::RequireThreshold(uint32_t i) {
  const Node& n = tape_.nodes[i];
  const Lanes need = needed_[i];
  const Threshold& t = tape_.thresholds[n.n];
  const Comparison& c = comparisons_[n.n];
  Batch& v = values_[n.a];
  for (int l = 0; l < kLanes; ++l) {
    if ((need >> l & 1) == 0) continue;
    const bool less = (c.less >> l & 1) != 0;
    const bool greater = (c.greater >> l & 1) != 0;
    if (!greater) v.hi[l] = std::min(v.hi[l], t.above);
    if (!less) v.nl[l] = std::min(v.nl[l], -t.below);
  }
  needed_[n.a] |= need;
}

// The branch that is taken has the value, and a branch that cannot have it is not taken.
void Contractor::RequireChoice(uint32_t i) {
  const Node& n = tape_.nodes[i];
  const auto [yes, no] = tape_.conditions[n.n];
  const Lanes need = needed_[i];
  Batch a, b;
  k_.meet(values_[n.a], values_[i], a);
  k_.meet(values_[n.b], values_[i], b);
  const auto no_a = static_cast<Lanes>((k_.empty(a) | ~possible_[yes]) & need);
  const auto no_b = static_cast<Lanes>((k_.empty(b) | ~possible_[no]) & need);
  needed_[no] |= no_a;
  needed_[yes] |= no_b;
  if (tape_.nodes[n.a].op != NodeOp::kConstant) Blend(no_b, a, values_[n.a]);
  if (tape_.nodes[n.b].op != NodeOp::kConstant) Blend(no_a, b, values_[n.b]);
  needed_[n.a] |= no_b;
  needed_[n.b] |= no_a;
}

void Contractor::BackwardNumber(uint32_t i) {
  const Node& n = tape_.nodes[i];
  if (n.op == NodeOp::kVariable || n.op == NodeOp::kConstant) return;
  if (n.op == NodeOp::kChoose) return RequireChoice(i);
  const Lanes need = needed_[i];
  const bool binary = IsBinary(n.op);
  const Batch& z = values_[i];
  // Constants stay what they are for the boxes to come.
  Batch constant_a, constant_b;
  const auto argument = [&](uint32_t node, Batch& constant) -> Batch& {
    if (tape_.nodes[node].op != NodeOp::kConstant) return values_[node];
    constant = values_[node];
    return constant;
  };
  Batch& a = argument(n.a, constant_a);
  Batch& b = argument(n.b, constant_b);
  Batch old_a, old_b;
  const bool some = need != 0xff;
  if (some) {
    old_a = a;
    if (binary) old_b = b;
  }
  switch (n.op) {
    case NodeOp::kAdd:
      k_.add_inverse(z, a, b);
      break;
    case NodeOp::kSub:
      k_.sub_inverse(z, a, b);
      break;
    case NodeOp::kMul:
      k_.mul_inverse(z, a, b);
      break;
    case NodeOp::kDiv:
      k_.div_inverse(z, a, b);
      break;
    case NodeOp::kMin:
      k_.min_inverse(z, a, b);
      break;
    case NodeOp::kMax:
      k_.max_inverse(z, a, b);
      break;
    case NodeOp::kNeg:
      k_.neg_inverse(z, a);
      break;
    case NodeOp::kSqr:
      k_.sqr_inverse(z, a);
      break;
    case NodeOp::kPow:
      k_.pow_inverse(z, a, static_cast<int>(n.n));
      break;
    case NodeOp::kSqrt:
      k_.sqrt_inverse(z, a);
      break;
    case NodeOp::kAbs:
      k_.abs_inverse(z, a);
      break;
    case NodeOp::kSin:
      k_.sin_inverse(z, a);
      break;
    case NodeOp::kCos:
      k_.cos_inverse(z, a);
      break;
    case NodeOp::kAsin:
      k_.asin_inverse(z, a);
      break;
    case NodeOp::kAcos:
      k_.acos_inverse(z, a);
      break;
    case NodeOp::kAtan:
      k_.atan_inverse(z, a);
      break;
    case NodeOp::kExp:
      k_.exp_inverse(z, a);
      break;
    case NodeOp::kLog:
      k_.log_inverse(z, a);
      break;
    default:
      break;  // tan and atan2 are not inverted
  }
  if (some) {
    const auto others = static_cast<Lanes>(~need);
    Blend(others, old_a, a);
    if (binary) Blend(others, old_b, b);
  }
  needed_[n.a] |= need;
  if (binary) needed_[n.b] |= need;
}

}  // namespace rondo::solve::icp
