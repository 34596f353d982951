#pragma once

#include <string>
#include <utility>
#include <vector>

/// Lays out tables of text.
namespace rondo::koord {

/// Collects rows of text and lays them out in aligned columns, for people.
class TextTable {
 public:
  /// Adds a row; rows may differ in their number of cells.
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// Returns the rows as lines that are indented by two blanks, without blanks at their ends and without a
  /// last newline.
  std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace rondo::koord
