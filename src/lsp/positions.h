#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace rondo::lsp {

/// Names what columns count.
enum class Encoding : uint8_t {
  kUtf16,  ///< units of UTF-16, as the protocol wants it unless both sides agree on something else
  kUtf8,   ///< bytes
};

/// Is a place in a text: from 0.
struct Position {
  size_t line = 0;
  size_t character = 0;
  friend bool operator==(const Position&, const Position&) = default;
};

/// Returns the byte at a place. What lies behind the end of a line or of the text is that end.
size_t OffsetOf(std::string_view text, Position position, Encoding encoding);

/// Returns the place of a byte. Bytes inside of a code point count as its beginning; bytes that are no UTF-8 count one unit each.
Position PositionOf(std::string_view text, size_t offset, Encoding encoding);

}  // namespace rondo::lsp
