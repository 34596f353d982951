#pragma once

#include <string>
#include <vector>

#include "choreo/graph/declarations.h"
#include "choreo/process/flow.h"
#include "choreo/project/project.h"

/// Checks that each process does what its projection asks of it (Definition 4.10 and Table 1 of the paper).
namespace rondo::choreo {

/// Holds a choreography with the local types of all its robots.
struct Typed {
  Graph* graph;  ///< gets the motions that only processes do
  std::vector<LocalType> types;
};

/// States what the structure leaves open: that `goal` holds wherever `hypothesis` does, for a robot that is
/// in one of the nodes `at`.
struct SideCondition {
  diag::Span span;
  std::string what;  ///< "whether the choreography offers this alternative", ...
  expr::TermId hypothesis, goal;
  std::vector<NodeId> at;
  bool moving = false;  ///< all the time while the robot moves; else when it gets there
  RobotId robot{};
  const Graph* graph = nullptr;
};

/// Types one process. Reports the first step that the local type does not allow: a message to or from the
/// wrong robot, with the wrong label or payload, a case that is missing, another motion or another argument,
/// an alternative that the choreography does not offer. Follows process and type together, each pair once.
/// The conditions that need a solver are returned; the process is well-typed if all of them are valid.
/// `graph` gets the motions that only the process does.
std::vector<SideCondition> TypeProcess(const Flow& flow, Graph& graph, const LocalType& type,
                                       Declarations& declarations);

/// Types every process of the module, and returns the side conditions of all of them.
std::vector<SideCondition> CheckProcesses(const Module& module, const std::vector<Typed>& typed,
                                          Declarations& declarations);

}  // namespace rondo::choreo
