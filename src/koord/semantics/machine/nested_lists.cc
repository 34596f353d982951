#include "koord/semantics/machine/nested_lists.h"

#include <algorithm>
#include <vector>

namespace rondo::koord::semantics {
namespace {

Word PackLevel(Heap& heap, const Shape& shape, size_t level, std::span<const Word> words) {
  if (level + 1 == shape.dimensions.size()) return heap.Intern(words);
  const size_t part = words.size() / shape.dimensions[level];
  std::vector<Word> lists;
  for (size_t at = 0; at < words.size(); at += part)
    lists.push_back(PackLevel(heap, shape, level + 1, words.subspan(at, part)));
  return heap.Intern(lists);
}

// Moves `to` behind what it writes.
bool UnpackLevel(const Heap& heap, const Shape& shape, size_t level, Word list, Word*& to) {
  const auto items = heap[list];
  const bool last = level + 1 == shape.dimensions.size();
  if (items.size() != static_cast<size_t>(shape.dimensions[level]) * (last ? shape.width : 1)) return false;
  if (last) {
    to = std::copy(items.begin(), items.end(), to);
    return true;
  }
  return std::all_of(items.begin(), items.end(),
                     [&](Word item) { return UnpackLevel(heap, shape, level + 1, item, to); });
}

}  // namespace

Word Pack(Heap& heap, const Shape& shape, std::span<const Word> words) {
  return PackLevel(heap, shape, 0, words);
}

bool Unpack(const Heap& heap, const Shape& shape, Word list, Word* to) {
  return UnpackLevel(heap, shape, 0, list, to);
}

}  // namespace rondo::koord::semantics
