#pragma once

#include <memory>
#include <string>

#include "driver/load.h"
#include "koord/check/check.h"

namespace rondo::driver {

/// A Koord program that was read and checked. The model points into the program.
struct LoadedKoord {
  koord::Program program;
  koord::Model model;
};

/// nullptr if it cannot be run or proved: a file cannot be read (said already), or errors are in
/// `session.diagnostics`.
std::unique_ptr<LoadedKoord> LoadKoord(const LoadOptions& options, Session& session);

/// The same for texts that are no files (any more). `spec` may be empty.
std::unique_ptr<LoadedKoord> LoadKoordTexts(const std::string& name, const std::string& program,
                                            const std::string& spec, Session& session);

}  // namespace rondo::driver
