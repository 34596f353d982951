#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondo::lsp {

/// Takes the bytes of a stream apart into messages of the protocol: each with a header that says how long it is.
class FrameReader {
 public:
  /// Bounds what is kept of a message that says how long it is: more is no message.
  static constexpr size_t kMost = size_t{64} << 20;  // bytes

  void Add(std::string_view bytes) { bytes_ += bytes; }
  /// Returns the next message that is whole; nothing if there is none yet.
  std::optional<std::string> Next();
  /// Reports that what came is no stream of messages: nothing more will come of it.
  bool broken() const { return broken_; }

 private:
  std::string bytes_;
  bool broken_ = false;
};

/// Returns a message with its header.
std::string Framed(std::string_view message);

}  // namespace rondo::lsp
