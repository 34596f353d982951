#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "reach/problem/numeric.h"
#include "workspace/session.h"

namespace rondo::runs {

/// A trajectory that breaks a contract, as `rondo reach` writes it and `rondo replay` reads it.
struct ExecutionFile {
  std::vector<std::string> files;
  std::string spec;
  std::string contract, claim;
  reach::Execution execution;
  double time = 0;  ///< at which the claim fails
};

/// Writes it as a whole or not at all.
base::Result<bool> SaveExecution(const std::string& path, const ExecutionFile& file);

/// Is this the text of such a file?
bool IsExecution(std::string_view text);

/// @error says what is wrong with the text.
base::Result<ExecutionFile> ReadExecution(std::string_view text);

/// Integrates the trajectory again: does it break the claim at that time? The text says so, or why not.
base::Result<std::string> ReplayExecution(const ExecutionFile& file, workspace::Session& session);

}  // namespace rondo::runs
