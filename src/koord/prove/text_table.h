#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rondo::koord {

/// Rows of text in aligned columns, for people.
class TextTable {
 public:
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// Lines indented by two blanks, without blanks at their ends and without a last newline.
  std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace rondo::koord
