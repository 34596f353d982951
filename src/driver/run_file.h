#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/result.h"
#include "koord/semantics/team.h"

namespace rondo::driver {

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

/// The text as the name of a file: letters, digits, `-` and `_`.
std::string FileName(std::string text);
/// The absolute path of a file; nothing of nothing.
std::string Absolute(const std::string& file);
/// Where runs go unless the user says where: a folder for cached data.
std::string DefaultRunFile(const std::string& program, const std::string& property);

/// Writes the run as a whole or not at all.
base::Result<bool> SaveRun(const std::string& path, const RunFile& run);

/// nullopt in `error` style: the message says what is wrong with the file.
base::Result<RunFile> LoadRun(const std::string& path);

}  // namespace rondo::driver
