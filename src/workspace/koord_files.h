#pragma once

#include <memory>
#include <optional>
#include <string>

#include "koord/check/check.h"
#include "workspace/session.h"

namespace rondo::workspace {

struct LoadOptions {
  std::string file;
  std::string spec;  ///< a specification; empty: the file beside the program with the extension `.spec`, if
                     ///< there is one
  bool with_spec = true;
};

/// Reads and parses a Koord program and the specification beside it. nullopt, after a report, when a file
/// cannot be read; syntax errors are in `session.diagnostics`.
std::optional<koord::Program> ReadKoord(const LoadOptions& options, Session& session);

/// A Koord program that was read and checked. The model points into the program.
struct LoadedKoord {
  koord::Program program;
  koord::Model model;
};

/// nullptr if it cannot be run or proved: what is wrong is in `session.diagnostics`.
std::unique_ptr<LoadedKoord> LoadKoord(const LoadOptions& options, Session& session);

/// The same for texts that are no files (any more). `spec` may be empty.
std::unique_ptr<LoadedKoord> LoadKoordTexts(const std::string& name, const std::string& program,
                                            const std::string& spec, Session& session);

}  // namespace rondo::workspace
