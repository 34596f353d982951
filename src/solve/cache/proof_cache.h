#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The proof cache: refutations that outlive the process.
namespace rondo::solve::cache {

/// Keeps proved obligations on disk, found by content. An entry holds the complete question; a hit compares
/// all of it, so a hash collision, a damaged or a half-written file can only miss, never prove. Thread-safe;
/// several processes may share the folder.
class ProofCache {
 public:
  /// Nothing is read or written when `folder` is empty: every question misses.
  explicit ProofCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Returns $XDG_CACHE_HOME/rondo/proofs, or ~/.cache/rondo/proofs; empty when neither is set.
  static std::filesystem::path DefaultFolder();

  /// Is what is known of a question that was proved: by which engine, and the groups of its core.
  struct Entry {
    std::string engine;
    std::vector<std::string> core;
  };
  /// Returns the entry of a question; nothing if there is none, or none that can be read.
  std::optional<Entry> Find(const std::string& question) const;
  /// Stores an entry. Failures to write are ignored: the cache only saves time.
  void Store(const std::string& question, const Entry& entry) const;

 private:
  std::filesystem::path PathOf(const std::string& question) const;
  std::filesystem::path folder_;
};

}  // namespace rondo::solve::cache
