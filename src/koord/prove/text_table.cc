#include "koord/prove/text_table.h"

#include <algorithm>

namespace rondo::koord {

std::string TextTable::Text() const {
  std::vector<size_t> widths;
  for (const auto& row : rows_) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t c = 0; c < row.size(); ++c)
      widths[c] = std::max(widths[c], std::min<size_t>(row[c].size(), 40));
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line = " ";
    for (size_t c = 0; c < row.size(); ++c) {
      if (widths[c] == 0) continue;
      line += " " + row[c] + std::string(widths[c] > row[c].size() ? widths[c] - row[c].size() : 0, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += (text.empty() ? "" : "\n") + line;
  }
  return text;
}

}  // namespace rondo::koord
