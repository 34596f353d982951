// Which variables need not be split?
#include "solve/icp/tape/tape.h"

namespace rondo::solve::icp {
namespace {

enum class Use : uint8_t {
  kSplit,  // what it is part of is used several times
  kExact,  // all the way up to a comparison, each number is used once
  kSum,    // used once, in a sum with something that varies
};

struct Uses {
  std::vector<uint32_t> count;
  std::vector<uint32_t> last;  // one node that uses it
};

Uses Count(const Tape& tape) {
  Uses uses{std::vector<uint32_t>(tape.nodes.size()), std::vector<uint32_t>(tape.nodes.size())};
  for (uint32_t i = 0; i < tape.nodes.size(); ++i) {
    const Node& n = tape.nodes[i];
    if (!IsComposite(n.op)) continue;
    ++uses.count[n.a];
    uses.last[n.a] = i;
    if (!IsBinary(n.op)) continue;
    ++uses.count[n.b];
    uses.last[n.b] = i;
  }
  return uses;
}

// The other summand, if the use is kSum.
Use UseOf(const Tape& tape, const Uses& uses, uint32_t node, uint32_t& other) {
  while (uses.count[node] == 1) {
    const uint32_t parent = uses.last[node];
    const Node& n = tape.nodes[parent];
    other = n.a == node ? n.b : n.a;
    const bool sum = n.op == NodeOp::kAdd || n.op == NodeOp::kSub;
    if (sum && tape.nodes[other].op != NodeOp::kConstant && uses.count[parent] > 1) return Use::kSum;
    node = parent;
  }
  return uses.count[node] == 0 ? Use::kExact : Use::kSplit;
}

// By node: does it depend on a wanted variable?
std::vector<char> Dependent(const Tape& tape, const std::vector<char>& wanted) {
  std::vector<char> result(tape.nodes.size());
  for (uint32_t i = 0; i < tape.nodes.size(); ++i) {
    const Node& n = tape.nodes[i];
    if (n.op == NodeOp::kVariable) {
      result[i] = wanted[n.a];
    } else if (IsComposite(n.op)) {
      result[i] = result[n.a] != 0 || (IsBinary(n.op) && result[n.b] != 0) ? 1 : 0;
    }
  }
  return result;
}

}  // namespace

bool IsBinary(NodeOp op) {
  switch (op) {
    case NodeOp::kAdd:
    case NodeOp::kSub:
    case NodeOp::kMul:
    case NodeOp::kDiv:
    case NodeOp::kMin:
    case NodeOp::kMax:
    case NodeOp::kAtan2:
    case NodeOp::kChoose:
      return true;
    default:
      return false;
  }
}

void MarkSingle(Tape& tape) {
  const Uses uses = Count(tape);
  std::vector<Use> use;
  std::vector<uint32_t> others(tape.variables.size());
  std::vector<char> split;
  for (size_t v = 0; v < tape.variables.size(); ++v) {
    use.push_back(UseOf(tape, uses, tape.variables[v].node, others[v]));
    split.push_back(use.back() == Use::kSplit ? 1 : 0);
  }
  const std::vector<char> dependent = Dependent(tape, split);
  for (size_t v = 0; v < tape.variables.size(); ++v)
    tape.variables[v].single = use[v] == Use::kExact || (use[v] == Use::kSum && dependent[others[v]] != 0);
}

}  // namespace rondo::solve::icp
