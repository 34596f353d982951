#pragma once

#include <string>
#include <vector>

#include "choreo/graph/calls.h"
#include "choreo/graph/graph.h"

/// Represents processes as graphs.
namespace rondo::choreo {

using FlowId = base::Id<struct FlowTag>;

/// Names the steps of a process.
enum class FlowKind : uint8_t { kSend, kReceive, kMove, kIf, kAssign, kExit };

/// Represents one case of a `receive`. Its names stand for what the message carries in everything behind it.
struct FlowCase {
  const Case* source = nullptr;
  RobotId peer;
  FlowId next;
};

/// Represents a step of a process. What it mentions is evaluated later, when it is known what messages carry.
struct FlowNode {
  FlowKind kind = FlowKind::kExit;
  diag::Span span;
  const Act* act = nullptr;
  RobotId peer;                       ///< kSend
  std::vector<FlowCase> cases;        ///< kReceive
  FlowId next;                        ///< kSend, kMove, kAssign; kIf: if the guard holds
  FlowId otherwise;                   ///< kIf: where the guard does not hold
  std::vector<const Case*> bindings;  ///< the cases whose names are in scope, the innermost last
};

/// Represents a process as a graph: loops are edges back. Every loop has a step that others can see.
struct Flow {
  const ProcessDef* source = nullptr;
  RobotId robot;
  std::vector<FlowNode> nodes;
  FlowId start;
  const FlowNode& operator[](FlowId id) const { return nodes[id.index()]; }
};

/// Returns the graph of a process; nothing after a report (robots and recursions that do not exist, loops
/// that do nothing).
std::optional<Flow> BuildFlow(const ProcessDef& process, const Graph& graph, Declarations& declarations);

}  // namespace rondo::choreo
