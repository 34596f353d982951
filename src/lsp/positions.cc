#include "lsp/positions.h"

#include <algorithm>

namespace rondo::lsp {

namespace {

// How many bytes the code point has that begins here; 1 where there is none.
size_t LengthAt(std::string_view text, size_t at) {
  const auto first = static_cast<unsigned char>(text[at]);
  const size_t length = first < 0xc0 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf8 ? 4 : 1;
  if (at + length > text.size()) return 1;
  for (size_t i = 1; i < length; ++i) {
    if ((static_cast<unsigned char>(text[at + i]) & 0xc0U) != 0x80U) return 1;
  }
  return length;
}

size_t UnitsOf(size_t bytes, Encoding encoding) {
  if (encoding == Encoding::kUtf8) return bytes;
  return bytes == 4 ? 2 : 1;
}

}  // namespace

size_t OffsetOf(std::string_view text, Position position, Encoding encoding) {
  size_t at = 0;
  for (size_t line = 0; line < position.line; ++line) {
    const size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return text.size();
    at = end + 1;
  }
  size_t units = 0;
  while (at < text.size() && text[at] != '\n' && text.substr(at, 2) != "\r\n") {
    const size_t length = LengthAt(text, at);
    units += UnitsOf(length, encoding);
    if (units > position.character) break;
    at += length;
  }
  return at;
}

Position PositionOf(std::string_view text, size_t offset, Encoding encoding) {
  offset = std::min(offset, text.size());
  Position position;
  position.line =
      static_cast<size_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
  const size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  for (size_t at = before == std::string_view::npos ? 0 : before + 1; at < offset;) {
    const size_t length = LengthAt(text, at);
    if (at + length > offset) break;
    position.character += UnitsOf(length, encoding);
    at += length;
  }
  return position;
}

}  // namespace rondo::lsp
