#pragma once

#include <optional>
#include <string>

#include "workspace/session.h"

namespace rondo::workspace {

/// Checks a file, and what belongs to it (the specification beside a program, imports): everything that can be said without a
/// solver. What is wrong is in the session.
void CheckFile(const std::string& file, Session& session);

/// Returns the canonical text of a program, a specification or a `.rondo` file: one that means the same, and has the same comments.
/// Nothing if it cannot be read or has errors, which are in the session then.
std::optional<std::string> FormattedFile(const std::string& file, Session& session);

}  // namespace rondo::workspace
