#include "solve/cache/proof_cache.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdlib>

#include "base/file.h"

namespace rondo::solve::cache {
namespace {

constexpr std::string_view kMagic = "rondo proof 1\n";

}  // namespace

std::filesystem::path ProofCache::DefaultFolder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0') {
    return std::filesystem::path(cache) / "rondo" / "proofs";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return std::filesystem::path(home) / ".cache" / "rondo" / "proofs";
  }
  return {};
}

std::filesystem::path ProofCache::PathOf(const std::string& question) const {
  const XXH128_hash_t hash = XXH3_128bits(question.data(), question.size());
  const std::string name = fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  return folder_ / name.substr(0, 2) / name.substr(2);
}

// magic, engine, number of core groups, the groups, one a line; then the question to the end of the file.
std::optional<ProofCache::Entry> ProofCache::Find(const std::string& question) const {
  if (folder_.empty()) return std::nullopt;
  const auto file = base::ReadFile(PathOf(question));
  if (!file.ok()) return std::nullopt;
  std::string_view text = file.value();
  if (!text.starts_with(kMagic)) return std::nullopt;
  text.remove_prefix(kMagic.size());
  const auto line = [&]() -> std::optional<std::string> {
    const size_t end = text.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    std::string result(text.substr(0, end));
    text.remove_prefix(end + 1);
    return result;
  };
  Entry entry;
  const auto engine = line();
  const auto count = line();
  if (!engine || !count || count->empty() || count->size() > 4 ||
      count->find_first_not_of("0123456789") != std::string::npos) {
    return std::nullopt;
  }
  entry.engine = *engine;
  for (int i = std::stoi(*count); i > 0; --i) {
    const auto group = line();
    if (!group) return std::nullopt;
    entry.core.push_back(*group);
  }
  if (text != question) return std::nullopt;
  return entry;
}

void ProofCache::Store(const std::string& question, const Entry& entry) const {
  if (folder_.empty()) return;
  std::string text = fmt::format("{}{}\n{}\n", kMagic, entry.engine, entry.core.size());
  for (const std::string& group : entry.core) text += group + "\n";
  text += question;
  const std::filesystem::path path = PathOf(question);
  if (!base::MakeFolders(path.parent_path()).ok()) return;
  const auto ignored = base::WriteFileAtomically(path, text);
  static_cast<void>(ignored.ok());
}

}  // namespace rondo::solve::cache
