#include "base/file.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace rondo::base {
Result<std::string> ReadFile(const std::filesystem::path& path, uint64_t largest) {
  const auto too_large = [&] { return Error{fmt::format("is larger than {} MiB", largest >> 20)}; };
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) return Error{"no such file"};
  if (std::filesystem::is_directory(status)) return Error{"is a folder, not a file"};
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, failure) > largest)
    return too_large();
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{std::strerror(errno)};
  // Pipes have no size beforehand, and some files have no end.
  std::string text;
  for (std::array<char, 1 << 16> part; in; text.append(part.data(), static_cast<size_t>(in.gcount()))) {
    if (text.size() > largest) return too_large();
    in.read(part.data(), part.size());
  }
  if (in.bad()) return Error{"could not be read to its end"};
  return text;
}

Result<bool> MakeFolders(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) return Error{failure.message()};
  return true;
}

Result<std::string> MakeTemporaryFolder() {
  std::error_code wrong;
  std::string folder =
      (std::filesystem::temp_directory_path(wrong) / "rondo-").string() + std::string(6, 'X');
  if (::mkdtemp(folder.data()) == nullptr) return Error{std::strerror(errno)};
  return folder;
}

Result<bool> WriteFileAtomically(const std::filesystem::path& path, std::string_view text) {
  static std::atomic<unsigned> serial{0};
  std::error_code failure;
  if (path.has_parent_path() && !std::filesystem::exists(path.parent_path(), failure))
    return Error{fmt::format("there is no folder `{}`", path.parent_path().string())};
  // A device or a folder must not be replaced.
  if (std::filesystem::exists(path, failure) && !std::filesystem::is_regular_file(path, failure))
    return Error{"it is not a regular file"};
  failure.clear();
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.{}.tmp", ::getpid(), serial++);
  {
    std::ofstream out(temporary, std::ios::binary);
    if (!out) return Error{std::strerror(errno)};
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) {
      std::filesystem::remove(temporary, failure);
      return Error{"could not be written to its end"};
    }
  }
  // Keep the permissions of the file that is replaced.
  if (const auto old = std::filesystem::status(path, failure); std::filesystem::exists(old)) {
    std::filesystem::permissions(temporary, old.permissions(), failure);
  }
  std::filesystem::rename(temporary, path, failure);
  if (failure) {
    const std::string message = failure.message();
    std::filesystem::remove(temporary, failure);
    return Error{message};
  }
  return true;
}

}  // namespace rondo::base
