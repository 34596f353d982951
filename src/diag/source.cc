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

uint32_t CountCodePoints(std::string_view text) {
  uint32_t count = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0u) != 0x80u) ++count;
  }
  return count;
}

}  // namespace rondo::diag
