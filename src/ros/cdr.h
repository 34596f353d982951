#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

/// Common Data Representation, version 1 (OMG DDS-XTYPES 7.4.1), of final types: what ROS 2 sends.
namespace rondo::ros {

static_assert(std::endian::native == std::endian::little, "bytes are copied as they are");

/// Writes values one behind the other, in little endian, each at a multiple of its size behind the header.
class CdrWriter {
 public:
  CdrWriter() : out_("\x00\x01\x00\x00", 4) {}
  template <class T>
    requires std::is_arithmetic_v<T>
  void Value(T value) {
    while ((out_.size() - 4) % sizeof(T) != 0) out_ += '\0';
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    out_.append(bytes, sizeof(T));
  }
  /// Writes a text, with a zero behind it that counts.
  void Value(std::string_view text) {
    Count(text.size() + 1);
    out_.append(text);
    out_ += '\0';
  }
  void Value(const std::string& text) { Value(std::string_view(text)); }
  /// Writes how many items follow.
  void Count(size_t count) { Value(static_cast<uint32_t>(count)); }
  std::string Take() { return std::move(out_); }

 private:
  std::string out_;
};

/// Reads what a `CdrWriter`, or anybody else, wrote, in either order of bytes. From the first thing on that is not there,
/// everything is zero and empty, and `ok` false. Takes no more memory than the bytes that are there account for.
class CdrReader {
 public:
  explicit CdrReader(std::string_view bytes);

  template <class T>
    requires std::is_arithmetic_v<T>
  void Value(T& value) {
    char bytes[sizeof(T)] = {};
    Take(bytes, sizeof(T));
    if constexpr (std::is_same_v<T, bool>) {
      value = bytes[0] != 0;
    } else {
      std::memcpy(&value, bytes, sizeof(T));
    }
  }
  /// Reads a text of at most `most` bytes, without the zero behind it.
  void Value(std::string& text, size_t most = SIZE_MAX);
  /// Reads how many items follow, each of `size` bytes at least.
  size_t Count(size_t size);

  bool ok() const { return ok_; }
  /// Reports whether everything was there, and nothing but padding is left.
  bool Complete() const { return ok_ && bytes_.size() - at_ < 8; }

 private:
  void Take(char* out, size_t size);

  std::string_view bytes_;  // behind the header
  size_t at_ = 0;
  bool swap_ = false;
  bool ok_ = true;
};

}  // namespace rondo::ros
