#pragma once

#include <optional>
#include <string>

#include "diag/diagnostic.h"
#include "koord/check/model.h"

namespace rondo::driver {

/// What one run reads, and everything that was said about it.
struct Session {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
};

/// Adds a file to the sources; nothing, after a message, when it cannot be read.
std::optional<diag::FileId> ReadSource(const std::string& path, Session& session);

struct LoadOptions {
  std::string file;
  std::string spec;  ///< a specification; empty: the file beside the program with the extension `.spec`, if
                     ///< there is one
  bool with_spec = true;
};

/// Reads and parses a Koord program and the specification beside it. nullopt, after a message, when a file
/// cannot be read; syntax errors are in `session.diagnostics`.
std::optional<koord::Program> Load(const LoadOptions& options, Session& session);

}  // namespace rondo::driver
