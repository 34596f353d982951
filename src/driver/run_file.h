#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/result.h"
#include "koord/check/model.h"

namespace rondo::driver {

/// A run that breaks something, as `explore` and `prove --reach` write it and `replay` reads it.
struct RunFile {
  std::string program;
  std::string spec;  ///< empty: beside the program
  size_t robots = 0;
  std::string property;
  std::string engine;
  nlohmann::json steps;
};

/// Where runs go unless the user says where: a folder for cached data.
std::string DefaultRunFile(const std::string& program, const std::string& property);

/// Writes the run as a whole or not at all.
base::Result<bool> SaveRun(const std::string& path, const RunFile& run, const koord::Model& model);

/// nullopt in `error` style: the message says what is wrong with the file.
base::Result<RunFile> LoadRun(const std::string& path);

}  // namespace rondo::driver
