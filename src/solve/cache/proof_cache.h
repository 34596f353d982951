#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rondo::solve::cache {

/// Proved obligations on disk, found by content. An entry holds the complete question; a hit compares all of
/// it, so a hash collision, a damaged or a half-written file can only miss, never prove. Thread-safe; several
/// processes may share the folder.
class ProofCache {
 public:
  /// Nothing is read or written when `folder` is empty.
  explicit ProofCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// $XDG_CACHE_HOME/rondo/proofs, or ~/.cache/rondo/proofs; empty when neither is set.
  static std::filesystem::path DefaultFolder();

  struct Entry {
    std::string engine;
    std::vector<std::string> core;
  };
  std::optional<Entry> Find(const std::string& question) const;
  /// Failures to write are ignored: the cache only saves time.
  void Store(const std::string& question, const Entry& entry) const;

 private:
  std::filesystem::path PathOf(const std::string& question) const;
  std::filesystem::path folder_;
};

}  // namespace rondo::solve::cache
