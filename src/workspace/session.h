#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/file.h"
#include "diag/diagnostic.h"

/// Loads and checks files, each once for one request. Prints nothing: what is wrong is a diagnostic.
namespace rondo::workspace {

/// Holds what one request reads, and everything that was said about it.
struct Session {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  /// Returns the text of a file; others than the disk can take its place.
  std::function<base::Result<std::string>(const std::string& path)> read = [](const std::string& path) {
    return base::ReadFile(path);
  };
};

/// Adds a file to the sources. Returns nothing, after a report, if it cannot be read.
std::optional<diag::FileId> ReadSource(const std::string& path, Session& session);

}  // namespace rondo::workspace
