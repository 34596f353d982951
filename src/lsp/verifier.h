#pragma once

#include <sys/types.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

namespace rondo::lsp {

/// Proves files in a process of its own, one at a time: it can be ended at any moment.
class Verifier {
 public:
  /// @param executable  `EXECUTABLE prove FILE --json` is what it runs; empty: nothing is ever proved.
  explicit Verifier(std::string executable) : executable_(std::move(executable)) {}
  Verifier(const Verifier&) = delete;
  Verifier& operator=(const Verifier&) = delete;
  ~Verifier() { Cancel(); }

  /// Begins with a file; what was under way is ended.
  void Start(const std::string& file, int64_t version);
  void Cancel();
  /// Returns what can be read from when there is something to read; -1: nothing is under way.
  int descriptor() const { return pipe_; }
  const std::string& file() const { return file_; }
  int64_t version() const { return version_; }
  /// Reads what is there. Returns what was proved when all is; nothing before. An object without `command` if the process did not end
  /// as it should.
  std::optional<nlohmann::json> Read();

 private:
  std::string executable_, file_, text_;
  int64_t version_ = 0;
  pid_t child_ = 0;
  int pipe_ = -1;
};

}  // namespace rondo::lsp
