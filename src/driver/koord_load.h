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

}  // namespace rondo::driver
