#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "base/id.h"

/// Source texts, and places in them.
namespace rondo::diag {

/// Names a text of one SourceSet.
using FileId = base::Id<struct FileTag>;

/// Covers the bytes [begin, end) of one file. An invalid file means "nowhere": the diagnostic is not about
/// one place.
struct Span {
  FileId file;
  uint32_t begin = 0;
  uint32_t end = 0;

  /// Returns the least span that covers both, if they lie in one file; this one if they do not; the other one
  /// if either is nowhere.
  Span To(Span other) const;
  friend bool operator==(const Span&, const Span&) = default;
};

/// Is a place as people count: lines and columns from 1. Columns count Unicode code points, so that they
/// agree with what an editor shows.
struct Position {
  uint32_t line = 1;
  uint32_t column = 1;
};

/// Owns the texts that a run reads. Files stay where they are once added; views into them remain valid.
class SourceSet {
 public:
  /// Adds a text under the name that messages show. Nothing is read from disk.
  FileId Add(std::string path, std::string text);

  size_t size() const { return files_.size(); }
  std::string_view path(FileId file) const { return files_[file.index()].path; }
  std::string_view text(FileId file) const { return files_[file.index()].text; }
  /// Returns the bytes of a span; none if it is nowhere.
  std::string_view Text(Span span) const;
  /// Returns the line and column of a byte; an offset beyond the end counts as the end. Cost: logarithmic in
  /// the lines, linear in the length of the line.
  Position Locate(FileId file, uint32_t offset) const;
  /// Returns the text of a 1-based line without its line end (`\n` or `\r\n`); empty when there is no such
  /// line.
  std::string_view Line(FileId file, uint32_t line) const;

 private:
  struct File {
    std::string path;
    std::string text;
    std::vector<uint32_t> line_starts;
  };
  std::deque<File> files_;
};

/// Returns a text that can be shown anywhere: control characters and bytes that are no UTF-8 as `\x1b`; line ends stay.
std::string Escaped(std::string_view text);

/// Returns the number of code points in UTF-8 text: of its bytes that continue no code point. A stray
/// continuation byte in malformed text is not counted.
uint32_t CountCodePoints(std::string_view text);

}  // namespace rondo::diag
