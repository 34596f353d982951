#include "sim/functions/encoding.h"

#include <gtest/gtest.h>

#include <limits>

namespace rondo::sim {
namespace {

TEST(Encoding, PointsComeBack) {
  Word words[3];
  WritePoint({1.5, -2, 1e300}, words);
  EXPECT_EQ(ReadPoint(words), (Point{1.5, -2, 1e300}));
}

TEST(Encoding, ZeroHasOneSign) {
  Word words[3];
  WritePoint({-0.0, 0, -0.0}, words);
  for (const Word w : words) EXPECT_EQ(w, 0U);
}

TEST(Encoding, PathsComeBack) {
  Heap heap;
  const std::vector<Point> path{{0, 0, 0}, {1, -2, 3}, {0.25, 1e-9, 7}};
  EXPECT_EQ(DecodePath(heap, EncodePath(heap, path)), path);
}

TEST(Encoding, TheEmptyPathIsZero) {
  Heap heap;
  EXPECT_EQ(EncodePath(heap, {}), 0U);
  EXPECT_TRUE(DecodePath(heap, 0).empty());
}

TEST(Encoding, RaysComeBack) {
  Heap heap;
  const double infinity = std::numeric_limits<double>::infinity();
  const Rays rays{-0.5, 0.25, 10, {1, infinity, 2.5}};
  const Rays again = DecodeRays(heap, EncodeRays(heap, rays));
  EXPECT_EQ(again.first, -0.5);
  EXPECT_EQ(again.step, 0.25);
  EXPECT_EQ(again.range, 10);
  EXPECT_EQ(again.distances, rays.distances);
}

TEST(Encoding, NoScanHasNoRays) {
  const Heap heap;
  EXPECT_TRUE(DecodeRays(heap, 0).distances.empty());
}

TEST(Encoding, MapsComeBack) {
  Heap heap;
  // 35 cells: the last word is not full.
  GridMap map{0.5, 5, 7, -1, 2.5, std::vector<int8_t>(35, GridMap::kUnknown)};
  map.At(1, 2) = GridMap::kEmpty;
  map.At(4, 6) = GridMap::kOccupied;
  map.At(3, 1) = GridMap::kOccupied;
  const auto again = DecodeMap(heap, EncodeMap(heap, map));
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->cell, 0.5);
  EXPECT_EQ(again->columns, 5);
  EXPECT_EQ(again->rows, 7);
  EXPECT_EQ(again->x0, -1);
  EXPECT_EQ(again->y0, 2.5);
  EXPECT_EQ(again->cells, map.cells);
}

TEST(Encoding, NothingIsKnownOfTheEmptyMap) {
  const Heap heap;
  EXPECT_FALSE(DecodeMap(heap, 0).has_value());
}

TEST(Encoding, MapsThatDifferInACellDiffer) {
  Heap heap;
  GridMap map{1, 3, 3, 0, 0, std::vector<int8_t>(9, GridMap::kUnknown)};
  const Word before = EncodeMap(heap, map);
  map.At(2, 2) = GridMap::kEmpty;
  EXPECT_NE(EncodeMap(heap, map), before);
}

}  // namespace
}  // namespace rondo::sim
