#pragma once

#include <string>
#include <vector>

#include "choreo/process/flow.h"
#include "choreo/project/project.h"

/// How choreographies, projections and processes run: the operational semantics (Figure 3 and Definition 4.11
/// of the paper) as transition systems. Messages are synchronous and take no time; time passes for all robots
/// at once, and only while each of them moves. What guards say is not looked at: every alternative is
/// possible.
namespace rondo::choreo {

struct MachineEdge {
  enum class Kind : uint8_t { kSend, kReceive, kMove, kChoose } kind = Kind::kChoose;
  RobotId peer;       ///< of messages
  std::string label;  ///< of the message or motion
  Duration duration;  ///< kMove
  size_t to = 0;
};

struct MachineState {
  std::vector<MachineEdge> edges;
  bool ends = false;
};

/// What one robot may do, whatever told it so. It begins in the first state.
struct Machine {
  std::vector<MachineState> states;
};

Machine MachineOf(const Graph& graph, const LocalType& type);

/// Of a process. Motions are those that its type was checked with: `declarations` made the graph.
Machine MachineOf(Graph& graph, const Flow& flow, Declarations& declarations);

}  // namespace rondo::choreo
