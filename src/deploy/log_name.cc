#include "deploy/log_name.h"

#include <fmt/format.h>

#include <filesystem>

namespace rondo::deploy {

std::string UnusedLogName(const std::string& wanted) {
  std::error_code ignored;
  const std::filesystem::path path(wanted);
  std::string name = wanted;
  for (int life = 2; std::filesystem::is_regular_file(name, ignored) ||
                     std::filesystem::is_regular_file(name + ".partial", ignored);
       ++life)
    name =
        (path.parent_path() / fmt::format("{}.{}{}", path.stem().string(), life, path.extension().string()))
            .string();
  return name;
}

}  // namespace rondo::deploy
