#pragma once

#include <optional>
#include <string>

#include "diag/diagnostic.h"

/// Files, loaded and checked once. Prints nothing: what is wrong is a diagnostic.
namespace rondo::workspace {

/// What one request reads, and everything that was said about it.
struct Session {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
};

/// Adds a file to the sources. Reports one that cannot be read, and returns nothing.
std::optional<diag::FileId> ReadSource(const std::string& path, Session& session);

}  // namespace rondo::workspace
