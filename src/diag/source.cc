#include "diag/source.h"

#include <algorithm>

namespace rondo::diag {

Span Span::To(Span other) const {
  if (!file.valid()) return other;
  if (!other.file.valid() || other.file != file) return *this;
  return {file, std::min(begin, other.begin), std::max(end, other.end)};
}

FileId SourceSet::Add(std::string path, std::string text) {
  File file{std::move(path), std::move(text), {0}};
  for (size_t i = 0; i < file.text.size(); ++i) {
    if (file.text[i] == '\n') file.line_starts.push_back(static_cast<uint32_t>(i + 1));
  }
  files_.push_back(std::move(file));
  return FileId(files_.size() - 1);
}

std::string_view SourceSet::Text(Span span) const {
  if (!span.file.valid()) return {};
  return text(span.file).substr(span.begin, span.end - span.begin);
}

Position SourceSet::Locate(FileId file, uint32_t offset) const {
  const File& f = files_[file.index()];
  offset = std::min(offset, static_cast<uint32_t>(f.text.size()));
  const auto next = std::upper_bound(f.line_starts.begin(), f.line_starts.end(), offset);
  const auto line = static_cast<uint32_t>(next - f.line_starts.begin());
  const uint32_t start = f.line_starts[line - 1];
  return {line, CountCodePoints(std::string_view(f.text).substr(start, offset - start)) + 1};
}

std::string_view SourceSet::Line(FileId file, uint32_t line) const {
  const File& f = files_[file.index()];
  if (line == 0 || line > f.line_starts.size()) return {};
  const uint32_t start = f.line_starts[line - 1];
  const size_t end = line < f.line_starts.size() ? f.line_starts[line] - 1 : f.text.size();
  std::string_view result = std::string_view(f.text).substr(start, end - start);
  if (result.ends_with('\r')) result.remove_suffix(1);
  return result;
}

namespace {

// How many bytes the code point has that begins here; 0: it is none.
size_t Length(std::string_view text) {
  const auto at = [&](size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const unsigned char first = at(0);
  const size_t length = first < 0x80                    ? 1
                        : first >= 0xC2 && first < 0xE0 ? 2
                        : first >= 0xE0 && first < 0xF0 ? 3
                        : first >= 0xF0 && first < 0xF5 ? 4
                                                        : 0;
  for (size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xC0U) != 0x80U) return 0;
  }
  // Too long for what they say, half of a pair, beyond the last.
  if ((first == 0xE0 && at(1) < 0xA0) || (first == 0xED && at(1) >= 0xA0) ||
      (first == 0xF0 && at(1) < 0x90) || (first == 0xF4 && at(1) >= 0x90))
    return 0;
  return length;
}

bool Controls(std::string_view point) {
  const auto first = static_cast<unsigned char>(point[0]);
  if (point.size() == 1) return first < 0x20 || first == 0x7F;
  // U+0080 to U+009F, and what changes the direction of what follows.
  if (first == 0xC2) return static_cast<unsigned char>(point[1]) < 0xA0;
  return (point >= "\xE2\x80\xAA" && point <= "\xE2\x80\xAE") ||
         (point >= "\xE2\x81\xA6" && point <= "\xE2\x81\xA9");
}

}  // namespace

std::string Escaped(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (size_t i = 0; i < text.size();) {
    const size_t length = Length(text.substr(i));
    const std::string_view point = text.substr(i, std::max<size_t>(length, 1));
    if (length > 0 && (point == "\n" || !Controls(point))) {
      out += point;
    } else {
      for (const char c : point) {
        out += "\\x";
        out += kDigits[static_cast<unsigned char>(c) >> 4];
        out += kDigits[static_cast<unsigned char>(c) & 15];
      }
    }
    i += point.size();
  }
  return out;
}

uint32_t CountCodePoints(std::string_view text) {
  uint32_t count = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0u) != 0x80u) ++count;
  }
  return count;
}

}  // namespace rondo::diag
