#pragma once

#include <memory>
#include <optional>

#include "choreo/graph/declarations.h"
#include "choreo/graph/graph.h"
#include "choreo/process/typing.h"
#include "driver/load.h"

namespace rondo::driver {

/// Robots, worlds, choreographies and processes that were read, and the graphs of the choreographies.
struct Motion {
  choreo::Module module;
  expr::Arena arena;
  std::unique_ptr<choreo::Declarations> declarations;  ///< if nothing was wrong so far
  std::vector<choreo::Graph> graphs;
};

/// Is it a file about robots that move: `.rondo`, `.chor` or `.rosl`?
bool IsMotionFile(const std::string& file);

/// Reads files in order, and what they import, each once; builds the graphs. Nothing after a message when one
/// cannot be read. What is wrong is in `session.diagnostics`.
/// `options`: such as `equal_durations`, for every choreography. `loose`: a parameter of robots that may have
/// any value between two bounds; outlives the result.
std::unique_ptr<Motion> LoadMotion(const std::vector<std::string>& files,
                                   const std::vector<std::string>& options, Session& session,
                                   const robot::Loose* loose = nullptr);

/// Well-formedness, projections and processes of everything that was loaded. What the typing of processes
/// leaves open; nothing if something is wrong.
std::optional<std::vector<choreo::SideCondition>> CheckStructure(Motion& motion, Session& session);

/// Everything that can be said of files without a solver: names, units, well-formedness, projections,
/// processes. False if one cannot be read.
bool CheckMotion(const std::vector<std::string>& files, const std::vector<std::string>& options,
                 Session& session);

}  // namespace rondo::driver
