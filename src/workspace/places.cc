#include "workspace/places.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>

#include "base/file.h"
#include "solve/cache/proof_cache.h"

namespace rondo::workspace {

std::string FileName(std::string text) {
  for (char& c : text) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  }
  return text;
}

std::string Absolute(const std::string& file) {
  std::error_code ignored;
  return file.empty() ? file : std::filesystem::absolute(file, ignored).lexically_normal().string();
}

std::string DefaultRunFile(const std::string& program, const std::string& property) {
  const std::filesystem::path folder = solve::cache::ProofCache::DefaultFolder().parent_path() / "runs";
  // Who cannot make it is told when the file is written.
  static_cast<void>(base::MakeFolders(folder).ok());
  const std::string name = FileName(std::filesystem::path(program).stem().string() + "-" + property);
  return (folder / (name + ".json")).string();
}

}  // namespace rondo::workspace
