#pragma once

#include <memory>
#include <optional>

#include "choreo/graph/declarations.h"
#include "choreo/graph/graph.h"
#include "choreo/process/typing.h"
#include "workspace/session.h"

/// Loads files about robots that move, and checks them.
namespace rondo::workspace {

/// Holds robots, worlds, choreographies and processes that were read, and the graphs of the choreographies.
struct LoadedModule {
  choreo::Module module;
  expr::Arena arena;
  std::unique_ptr<choreo::Declarations> declarations;  ///< if nothing was wrong so far
  std::vector<choreo::Graph> graphs;
};

/// Reports whether it is a file about robots that move, by its name: `.rondo`, `.chor` or `.rosl`.
bool IsModuleFile(const std::string& file);

/// Reads files in order, and what they import, each once, and builds the graphs. What is wrong is in
/// `session.diagnostics`; then there are no graphs. Never nullptr.
/// @param options  such as `equal_durations`, for every choreography.
/// @param loose  a parameter of robots that may have any value between two bounds; outlives the result.
std::unique_ptr<LoadedModule> LoadModule(const std::vector<std::string>& files,
                                         const std::vector<std::string>& options, Session& session,
                                         const robot::Loose* loose = nullptr);

/// Checks well-formedness, projections and processes of everything that was loaded. Returns what the typing
/// of processes leaves open; nothing if something is wrong, which is in the session.
std::optional<std::vector<choreo::SideCondition>> CheckStructure(LoadedModule& module, Session& session);

/// Checks everything that can be said of files without a solver: names, units, well-formedness, projections,
/// processes. What is wrong is in the session.
void CheckModule(const std::vector<std::string>& files, const std::vector<std::string>& options,
                 Session& session);

}  // namespace rondo::workspace
