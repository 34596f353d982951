#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/result.h"

/// Files are read and written as a whole: what goes wrong is a `Result`, never an exception.
namespace rondo::base {

/// Returns the bytes of a file. @error when it cannot be read, is a folder, or has more than `largest` bytes.
Result<std::string> ReadFile(const std::filesystem::path& path, uint64_t largest = uint64_t{64} << 20);

/// Makes a folder, and those that it lies in, unless they are there. @error in the words of the system.
Result<bool> MakeFolders(const std::filesystem::path& folder);

/// Makes a folder for things that stay a while, with a name that nothing else has. @error in the words of the system.
Result<std::string> MakeTemporaryFolder();

/// Writes all of `text` or nothing: a temporary file beside `path` is renamed over it.
///
/// @error when the file cannot be written, or its folder is not there; a file that was there before is then unchanged.
Result<bool> WriteFileAtomically(const std::filesystem::path& path, std::string_view text);

}  // namespace rondo::base
