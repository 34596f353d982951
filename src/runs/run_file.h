#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/result.h"
#include "koord/semantics/team.h"

/// Writes and reads runs.
namespace rondo::runs {

/// Holds a run that breaks something, as `explore` and `prove --reach` write it and `replay` reads it.
struct RunFile {
  std::string program;
  std::string spec;  ///< empty: beside the program
  size_t robots = 0;
  std::string property;  ///< what it breaks: `invariant NAME`, `well-defined`, ...
  std::string engine;
  nlohmann::json steps;
  /// Holds values of parameters, and of what `explore` declares none for, that came from a counterexample.
  nlohmann::json params = nlohmann::json::object();
  nlohmann::json choices = nlohmann::json::object();
};

/// Puts `params` and `choices` of the file into the options of the team that runs it, and their lists and texts into its
/// heap.
void AdoptParameters(const RunFile& run, const koord::Model& model, koord::semantics::TeamOptions& options,
                     koord::semantics::Heap& heap);
/// Puts what the options say into the file, the reverse of `AdoptParameters`.
void KeepParameters(RunFile& run, const koord::Model& model, const koord::semantics::TeamOptions& options);

/// Writes the run as a whole or not at all.
/// @error if it cannot be written.
base::Result<bool> SaveRun(const std::string& path, const RunFile& run);

/// Reads the text of such a file.
/// @error says what is wrong with it.
base::Result<RunFile> ReadRun(const std::string& text);

}  // namespace rondo::runs
