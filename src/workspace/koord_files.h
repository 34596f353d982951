#pragma once

#include <memory>
#include <optional>
#include <string>

#include "koord/check/check.h"
#include "workspace/session.h"

/// Loads Koord programs and their specifications.
namespace rondo::workspace {

/// Says which files a program is read from.
struct LoadOptions {
  std::string file;
  std::string spec;  ///< a specification; empty: the file beside the program with the extension `.spec`, if
                     ///< there is one
  bool with_spec = true;
};

/// Reads and parses a Koord program and the specification beside it. Returns nullopt, after a report, when a
/// file cannot be read; syntax errors are in `session.diagnostics`.
std::optional<koord::Program> ReadKoord(const LoadOptions& options, Session& session);

/// Holds a Koord program that was read and checked. The model points into the program.
struct LoadedKoord {
  koord::Program program;
  koord::Model model;
};

/// Reads, parses and checks a Koord program. Returns nullptr if there is any error, which is in
/// `session.diagnostics` then.
std::unique_ptr<LoadedKoord> LoadKoord(const LoadOptions& options, Session& session);

/// Does the same for texts that are no files (any more). `spec` may be empty.
std::unique_ptr<LoadedKoord> LoadKoordTexts(const std::string& name, const std::string& program,
                                            const std::string& spec, Session& session);

}  // namespace rondo::workspace
