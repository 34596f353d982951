#pragma once

#include <optional>
#include <vector>

#include "koord/semantics/machine/heap.h"
#include "sim/functions/grid_map.h"

/// How maps, scans, paths and points are kept in words of programs. The handle 0 is a map of which nothing is known, and
/// an empty path.
namespace rondo::sim {

using koord::semantics::Heap;
using koord::semantics::Word;

Point ReadPoint(const Word* words);
void WritePoint(const Point& point, Word* words);

Word EncodeMap(Heap& heap, const GridMap& map);
std::optional<GridMap> DecodeMap(const Heap& heap, Word handle);
Word EncodeRays(Heap& heap, const Rays& rays);
Rays DecodeRays(const Heap& heap, Word handle);
Word EncodePath(Heap& heap, const std::vector<Point>& path);
std::vector<Point> DecodePath(const Heap& heap, Word handle);

}  // namespace rondo::sim
