#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/result.h"

namespace rondo::base {

/// The bytes of a regular file. @error when it cannot be read, is a folder, or is larger than 64 MiB.
Result<std::string> ReadFile(const std::filesystem::path& path);

/// Writes all of `text` or nothing: a temporary file beside `path` is renamed over it. Creates missing
/// folders.
Result<bool> WriteFileAtomically(const std::filesystem::path& path, std::string_view text);

}  // namespace rondo::base
