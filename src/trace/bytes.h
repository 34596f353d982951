#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

/// Little-endian bytes, as MCAP and CDR want them: writing at the end of a text, reading from the front of
/// one.
namespace rondo::trace {

static_assert(std::endian::native == std::endian::little, "bytes are copied as they are");

/// Appends the bytes of a number.
template <typename T>
void Put(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}
/// Appends a text with its length before it, in four bytes, as MCAP writes strings.
inline void PutText(std::string& out, std::string_view text) {
  Put<uint32_t>(out, static_cast<uint32_t>(text.size()));
  out.append(text);
}

/// Returns the CRC-32 (IEEE 802.3) of bytes, or of those that gave `before` and these behind them.
uint32_t Checksum(std::string_view bytes, uint32_t before = 0);

/// Reads from the front of `bytes`, which must outlive it. Once the bytes do not suffice, it returns nothing
/// and stays where it is.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}
  /// Returns the next number.
  template <typename T>
  std::optional<T> Take() {
    if (rest_.size() < sizeof(T)) return std::nullopt;
    T value;
    std::memcpy(&value, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    return value;
  }
  /// Returns the next `size` bytes.
  std::optional<std::string_view> Take(uint64_t size) {
    if (rest_.size() < size) return std::nullopt;
    const std::string_view part = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return part;
  }
  /// Returns the next text, whose length stands before it in four bytes.
  std::optional<std::string_view> TakeText() {
    const auto size = Take<uint32_t>();
    return size ? Take(*size) : std::nullopt;
  }
  bool empty() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

}  // namespace rondo::trace
