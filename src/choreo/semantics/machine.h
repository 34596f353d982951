#pragma once

#include <string>
#include <vector>

#include "choreo/process/flow.h"
#include "choreo/project/project.h"

/// Executes choreographies, projections and processes: the operational semantics (Figure 3 and Definition
/// 4.11 of the paper) as transition systems. Messages are synchronous and take no time; time passes for all
/// robots at once, and only while each of them moves. What guards say is not looked at: every alternative is
/// possible.
namespace rondo::choreo {

/// Represents one thing that a robot may do next.
struct MachineEdge {
  enum class Kind : uint8_t { kSend, kReceive, kMove, kChoose } kind = Kind::kChoose;
  RobotId peer;       ///< of messages
  std::string label;  ///< of the message or motion
  Duration duration;  ///< kMove: how long it takes, in seconds
  size_t to = 0;
};

/// Represents a state of one robot: what it may do there, and whether it may be at its end.
struct MachineState {
  std::vector<MachineEdge> edges;
  bool ends = false;
};

/// Represents what one robot may do, whether a local type or a process says so. It begins in the first state.
struct Machine {
  std::vector<MachineState> states;
};

/// Returns the machine of a local type.
Machine MachineOf(const Graph& graph, const LocalType& type);

/// Returns the machine of a process. Motions are those that its type was checked with: `declarations` made
/// the graph.
Machine MachineOf(Graph& graph, const Flow& flow, Declarations& declarations);

}  // namespace rondo::choreo
