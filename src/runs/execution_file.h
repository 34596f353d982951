#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "reach/problem/numeric.h"
#include "workspace/session.h"

/// Writes, reads and replays trajectories that break contracts.
namespace rondo::runs {

/// Holds a trajectory that breaks a contract, as `rondo reach` writes it and `rondo replay` reads it.
struct ExecutionFile {
  std::vector<std::string> files;
  std::string spec;
  std::string contract, claim;
  reach::Execution execution;
  double time = 0;  ///< when the claim fails, in seconds from the start
};

/// Writes the file as a whole or not at all.
/// @error if it cannot be written.
base::Result<bool> SaveExecution(const std::string& path, const ExecutionFile& file);

/// Reports whether this is the text of such a file.
bool IsExecution(std::string_view text);

/// Reads the text of such a file.
/// @error says what is wrong with it.
base::Result<ExecutionFile> ReadExecution(std::string_view text);

/// Integrates the trajectory again, and returns a text that says that it breaks the claim at that time.
/// @error says why it does not, or why the contract cannot be used.
base::Result<std::string> ReplayExecution(const ExecutionFile& file, workspace::Session& session);

}  // namespace rondo::runs
