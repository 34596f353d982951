#include "choreo/process/ways.h"

#include <map>
#include <set>

#include "expr/defined.h"

namespace rondo::choreo {
namespace {

using expr::TermId;

// Conditions have no loops: each node comes behind those that it leads to.
std::vector<FlowId> Backwards(const Flow& flow, FlowId start) {
  std::vector<FlowId> order;
  std::set<FlowId> seen;
  std::vector<std::pair<FlowId, bool>> todo{{start, false}};
  while (!todo.empty()) {
    const auto [id, behind] = todo.back();
    todo.pop_back();
    if (behind) {
      order.push_back(id);
      continue;
    }
    if (!seen.insert(id).second) continue;
    todo.emplace_back(id, true);
    const FlowNode& node = flow[id];
    if (node.kind == FlowKind::kIf) todo.emplace_back(node.otherwise, false);
    if (node.kind == FlowKind::kIf || node.kind == FlowKind::kAssign) todo.emplace_back(node.next, false);
  }
  return order;
}

}  // namespace

std::vector<Way> WaysThrough(const Flow& flow, FlowId start, Compare& compare, expr::Arena& arena) {
  const std::vector<FlowId> order = Backwards(flow, start);
  std::map<FlowId, std::vector<TermId>> conditions{{start, {arena.True()}}};
  std::vector<Way> ways;
  for (size_t i = order.size(); i-- > 0;) {
    const FlowNode& node = flow[order[i]];
    const TermId condition = arena.Or(conditions[order[i]]);
    if (condition == arena.False()) continue;
    if (node.kind == FlowKind::kAssign) {
      compare.CheckAssignment(node);
      conditions[node.next].push_back(arena.True());
    } else if (node.kind == FlowKind::kIf) {
      const TermId guard = compare.GuardOf(node);
      conditions[node.next].push_back(arena.And(condition, guard));
      conditions[node.otherwise].push_back(arena.And(condition, expr::Complement(arena, guard)));
    } else {
      ways.push_back({order[i], condition});
    }
  }
  return ways;
}

}  // namespace rondo::choreo
