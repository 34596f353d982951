#pragma once

#include "diag/diagnostic.h"
#include "koord/check/model.h"

/// Checks Koord programs before anything else is done with them.
namespace rondo::koord {

/// Resolves names and types and applies every static rule, reporting all violations. The model is usable for
/// proving only if no error was reported.
Model Check(const Program& program, diag::Diagnostics& diagnostics);

}  // namespace rondo::koord
