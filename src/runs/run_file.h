#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/result.h"
#include "koord/semantics/team.h"

namespace rondo::runs {

/// A run that breaks something, as `explore` and `prove --reach` write it and `replay` reads it.
struct RunFile {
  std::string program;
  std::string spec;  ///< empty: beside the program
  size_t robots = 0;
  std::string property;
  std::string engine;
  nlohmann::json steps;
  /// Values of parameters, and of what `explore` declares none for, that came from a counterexample.
  nlohmann::json params = nlohmann::json::object();
  nlohmann::json choices = nlohmann::json::object();
};

/// Puts `params` and `choices` of the file into the options.
void AdoptParameters(const RunFile& run, const koord::Model& model, koord::semantics::TeamOptions& options);
/// The reverse, into the file.
void KeepParameters(RunFile& run, const koord::Model& model, const koord::semantics::TeamOptions& options);

/// Writes the run as a whole or not at all.
base::Result<bool> SaveRun(const std::string& path, const RunFile& run);

/// @error says what is wrong with the text of such a file.
base::Result<RunFile> ReadRun(const std::string& text);

}  // namespace rondo::runs
