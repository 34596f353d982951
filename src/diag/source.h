#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "base/id.h"

namespace rondo::diag {

using FileId = base::Id<struct FileTag>;

/// Bytes [begin, end) of one file. An invalid file means "nowhere": the diagnostic is not about one place.
struct Span {
  FileId file;
  uint32_t begin = 0;
  uint32_t end = 0;

  /// The least span that covers both; the other one if either is nowhere.
  Span To(Span other) const;
  friend bool operator==(const Span&, const Span&) = default;
};

/// 1-based; columns count Unicode code points, so that they agree with what an editor shows.
struct Position {
  uint32_t line = 1;
  uint32_t column = 1;
};

/// The texts that a run reads. Files stay where they are once added; views into them remain valid.
class SourceSet {
 public:
  FileId Add(std::string path, std::string text);

  size_t size() const { return files_.size(); }
  std::string_view path(FileId file) const { return files_[file.index()].path; }
  std::string_view text(FileId file) const { return files_[file.index()].text; }
  std::string_view Text(Span span) const;
  Position Locate(FileId file, uint32_t offset) const;
  /// The text of a 1-based line without its line end; empty when there is no such line.
  std::string_view Line(FileId file, uint32_t line) const;

 private:
  struct File {
    std::string path;
    std::string text;
    std::vector<uint32_t> line_starts;
  };
  std::deque<File> files_;
};

/// The number of code points in UTF-8 text; a malformed byte counts as one.
uint32_t CountCodePoints(std::string_view text);

}  // namespace rondo::diag
