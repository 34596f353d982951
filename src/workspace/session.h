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

/// Names what a file is read as.
enum class Wanted : uint8_t {
  kKoord,   ///< a program or specification
  kMotion,  ///< robots and choreographies (`.rondo`)
  kToml,    ///< fleets, networks, scenarios
  kText,    ///< any text
};

/// Adds a file to the sources, without its byte order mark. Returns nothing, after a report, if it cannot be read, is no text, or
/// plainly something else than what is wanted.
std::optional<diag::FileId> ReadSource(const std::string& path, Wanted wanted, Session& session);

}  // namespace rondo::workspace
