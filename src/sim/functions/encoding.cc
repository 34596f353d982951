#include "sim/functions/encoding.h"

#include <algorithm>

namespace rondo::sim {

using koord::semantics::FromFloat;
using koord::semantics::FromInt;
using koord::semantics::ToFloat;
using koord::semantics::ToInt;

Point ReadPoint(const Word* words) { return {ToFloat(words[0]), ToFloat(words[1]), ToFloat(words[2])}; }

void WritePoint(const Point& point, Word* words) {
  for (size_t i = 0; i < 3; ++i) words[i] = FromFloat(point[i] + 0.0);
}

Word EncodeMap(Heap& heap, const GridMap& map) {
  std::vector<Word> words{FromFloat(map.cell), FromInt(map.columns), FromInt(map.rows), FromFloat(map.x0),
                          FromFloat(map.y0)};
  for (size_t i = 0; i < map.cells.size(); i += 8) {
    Word w = 0;
    for (size_t k = i; k < std::min(i + 8, map.cells.size()); ++k)
      w |= static_cast<Word>(static_cast<uint8_t>(map.cells[k])) << (8 * (k - i));
    words.push_back(w);
  }
  return heap.Intern(words);
}

std::optional<GridMap> DecodeMap(const Heap& heap, Word handle) {
  const auto words = heap[handle];
  if (words.size() < 5) return std::nullopt;
  GridMap map{ToFloat(words[0]),
              static_cast<int>(ToInt(words[1])),
              static_cast<int>(ToInt(words[2])),
              ToFloat(words[3]),
              ToFloat(words[4]),
              {}};
  const size_t count = static_cast<size_t>(map.columns) * static_cast<size_t>(map.rows);
  for (size_t i = 0; i < count; ++i)
    map.cells.push_back(static_cast<int8_t>(static_cast<uint8_t>(words[5 + i / 8] >> (8 * (i % 8)))));
  return map;
}

Word EncodeRays(Heap& heap, const Rays& rays) {
  std::vector<Word> words{FromFloat(rays.first), FromFloat(rays.step), FromFloat(rays.range)};
  for (const double d : rays.distances) words.push_back(FromFloat(d));
  return heap.Intern(words);
}

Rays DecodeRays(const Heap& heap, Word handle) {
  const auto words = heap[handle];
  if (words.size() < 3) return {};
  Rays rays{ToFloat(words[0]), ToFloat(words[1]), ToFloat(words[2]), {}};
  for (size_t i = 3; i < words.size(); ++i) rays.distances.push_back(ToFloat(words[i]));
  return rays;
}

Word EncodePath(Heap& heap, const std::vector<Point>& path) {
  std::vector<Word> words(path.size() * 3);
  for (size_t i = 0; i < path.size(); ++i) WritePoint(path[i], words.data() + 3 * i);
  return heap.Intern(words);
}

std::vector<Point> DecodePath(const Heap& heap, Word handle) {
  std::vector<Point> path;
  DecodePath(heap, handle, path);
  return path;
}

void DecodePath(const Heap& heap, Word handle, std::vector<Point>& path) {
  path.clear();
  const auto words = heap[handle];
  for (size_t i = 0; i + 2 < words.size(); i += 3) path.push_back(ReadPoint(words.data() + i));
}

}  // namespace rondo::sim
