#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "choreo/node/senses.h"
#include "choreo/process/flow.h"
#include "choreo/project/project.h"
#include "runtime/sessions/session.h"

namespace rondo::choreo {

/// Holds what each robot of a choreography does: its process, or its projection if it has none. Refers to the graph.
struct Cast {
  Graph* graph = nullptr;
  Declarations* declarations = nullptr;
  std::vector<std::optional<Flow>> processes;  ///< by robot
  std::vector<LocalType> types;                ///< by robot
};

/// Returns what everybody does. The choreography must be well-formed and its processes well-typed.
/// @param projections  leave processes out
Cast MakeCast(const Module& module, Graph& graph, Declarations& declarations, bool projections);

/// Returns what one robot does, to be run. Everything must outlive it.
std::unique_ptr<runtime::sessions::Program> ScriptOf(const Cast& cast, RobotId robot, Senses& senses);

}  // namespace rondo::choreo
