#include "sim/functions/grid_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace rondo::sim {
namespace {

World Room() {
  World world;
  world.low = {-6, -6, 0};
  world.high = {6, 6, 2};
  for (const double s : {-5.5, 5.5}) {
    world.boxes.push_back({{s, 0, 0.5}, {0.2, 11, 1}});
    world.boxes.push_back({{0, s, 0.5}, {11, 0.2, 1}});
  }
  world.boxes.push_back({{2, 1, 0.5}, {0.98, 0.98, 1}});
  world.cylinders.push_back({{-2, -2, 0.5}, 0.4, 1});
  return world;
}

Rays Look(const World& world, const Point& from, int beams) {
  Rays rays{0.1, 2 * std::numbers::pi / beams, 10, {}};
  for (int i = 0; i < beams; ++i) rays.distances.push_back(world.Cast(from, rays.first + i * rays.step, 10));
  return rays;
}

TEST(GridMap, NeverMarksACellOccupiedThatIsNotNorEmptyThatIsCovered) {
  const World world = Room();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-4.8, 4.8);
  GridMap map = EmptyMap(world, 1);
  for (int i = 0; i < 200; ++i) {
    const Point from{unit(random), unit(random), 0.5};
    if (world.DistanceTo(from) < 0.3) continue;
    Draw(map, from, Look(world, from, 360), 8);
  }
  int occupied = 0;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.columns; ++c) {
      if (map.At(c, r) == GridMap::kOccupied) {
        ++occupied;
        EXPECT_TRUE(TrulyOccupied(map, world, c, r)) << c << " " << r;
      }
      // The middle of a cell that is called empty is free.
      if (map.At(c, r) == GridMap::kEmpty) {
        const Point m = map.Centre(c, r);
        EXPECT_GT(world.DistanceTo({m[0], m[1], 0.5}), 0) << c << " " << r;
      }
    }
  }
  EXPECT_GT(occupied, 44);
  Point target{};
  EXPECT_FALSE(Frontier(map, {0, 0, 0}, target));
}

TEST(GridMap, TheFrontierIsReachableAndBesideTheUnknown) {
  const World world = Room();
  GridMap map = EmptyMap(world, 1);
  Point target{};
  EXPECT_FALSE(Frontier(map, {0.5, 0.5, 0.5}, target));  // nothing is known to be empty
  Draw(map, {0.5, 0.5, 0.5}, Look(world, {0.5, 0.5, 0.5}, 360), 3);
  ASSERT_TRUE(Frontier(map, {0.5, 0.5, 0.5}, target));
  EXPECT_EQ(map.At(map.Column(target[0]), map.Row(target[1])), GridMap::kEmpty);
}

TEST(GridMap, MergingKeepsWhatEitherKnows) {
  const World world = Room();
  GridMap a = EmptyMap(world, 1);
  GridMap b = a;
  a.At(3, 3) = GridMap::kEmpty;
  b.At(4, 4) = GridMap::kOccupied;
  const GridMap both = Merge(a, b);
  EXPECT_EQ(both.At(3, 3), GridMap::kEmpty);
  EXPECT_EQ(both.At(4, 4), GridMap::kOccupied);
  EXPECT_EQ(both.At(5, 5), GridMap::kUnknown);
  EXPECT_EQ(Merge(a, b).cells, Merge(b, a).cells);
}

}  // namespace
}  // namespace rondo::sim
