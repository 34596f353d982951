#pragma once

#include <optional>
#include <vector>

#include "koord/semantics/machine/heap.h"
#include "sim/functions/grid_map.h"

/// Keeps maps, scans, paths and points in words of programs. The handle 0 is a map of which nothing is known,
/// and an empty path.
namespace rondo::sim {

using koord::semantics::Heap;
using koord::semantics::Word;

/// Converts a point from and to three words, x first.
Point ReadPoint(const Word* words);
void WritePoint(const Point& point, Word* words);

/// Converts maps, scans and paths to handles of the heap, and back; equal ones have equal handles.
/// `DecodeMap` returns nothing for what is no map.
Word EncodeMap(Heap& heap, const GridMap& map);
std::optional<GridMap> DecodeMap(const Heap& heap, Word handle);
Word EncodeRays(Heap& heap, const Rays& rays);
Rays DecodeRays(const Heap& heap, Word handle);
Word EncodePath(Heap& heap, const std::vector<Point>& path);
std::vector<Point> DecodePath(const Heap& heap, Word handle);
void DecodePath(const Heap& heap, Word handle, std::vector<Point>& path);

}  // namespace rondo::sim
