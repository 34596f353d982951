#include "lang/suggest.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace rondo::lang {
namespace {

// Levenshtein distance; a change of case costs nothing.
size_t Distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                        std::tolower(static_cast<unsigned char>(b[j - 1]));
      const size_t change = diagonal + (same ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string Suggest(std::string_view name, const std::vector<std::string>& candidates) {
  std::string best;
  size_t least = name.size() <= 3 ? 2 : 3;  // distances below this count as a typo
  for (const std::string& candidate : candidates) {
    if (candidate == name || (candidate.size() == 1 && name.size() == 1)) continue;
    const size_t d = Distance(name, candidate);
    if (d < least && d < std::max(name.size(), candidate.size())) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace rondo::lang
