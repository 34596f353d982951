#include "sim/world/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rondo::sim {
namespace {

World Scene() {
  World world;
  world.low = {-5, -5, 0};
  world.high = {5, 5, 3};
  world.boxes = {{{2, 0, 0.5}, {1, 2, 1}}, {{-2, 1, 0.5}, {0.5, 0.5, 1}}};
  world.cylinders = {{{0, -2, 0.5}, 0.7, 1}};
  return world;
}

TEST(World, ARayEndsWhereTheFirstObstacleBegins) {
  const World world = Scene();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Point from{-4 + 8 * unit(random), -4 + 8 * unit(random), 0.5};
    if (world.DistanceTo(from) < 0.01) continue;
    const double angle = 6.3 * unit(random);
    const double distance = world.Cast(from, angle, 20);
    const auto at = [&](double d) {
      return Point{from[0] + d * std::cos(angle), from[1] + d * std::sin(angle), 0.5};
    };
    const double end = std::min(distance, 12.0);
    for (double d = 0; d < end - 0.01; d += 0.01)
      ASSERT_GT(world.DistanceTo(at(d)), 0) << d << " of " << distance;
    if (distance < 20) {
      EXPECT_NEAR(world.DistanceTo(at(distance)), 0, 1e-9);
    }
  }
  EXPECT_EQ(world.Cast({0, 0, 2}, 0, 20), std::numeric_limits<double>::infinity());  // above them all
}

TEST(World, PathsAreAsFarApartAsTheirNearestPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-3, 3);
  const auto point = [&] { return Point{unit(random), unit(random), unit(random)}; };
  for (int i = 0; i < 300; ++i) {
    const std::vector<Point> p =
        i % 5 == 0 ? std::vector<Point>{point()} : std::vector<Point>{point(), point(), point()};
    const std::vector<Point> q{point(), point()};
    double sampled = 1e9;
    const auto on = [](const std::vector<Point>& path, double t) {
      if (path.size() == 1) return path[0];
      const double s = t * static_cast<double>(path.size() - 1);
      const auto k = std::min(static_cast<size_t>(s), path.size() - 2);
      const double f = s - static_cast<double>(k);
      Point r{};
      for (size_t a = 0; a < 3; ++a) r[a] = path[k][a] + f * (path[k + 1][a] - path[k][a]);
      return r;
    };
    for (int a = 0; a <= 200; ++a) {
      for (int b = 0; b <= 200; ++b)
        sampled = std::min(sampled, Distance(on(p, a / 200.0), on(q, b / 200.0)));
    }
    const double exact = PathDistance(p, q);
    EXPECT_LE(exact, sampled + 1e-12);
    EXPECT_NEAR(exact, sampled, 0.12);
    EXPECT_DOUBLE_EQ(exact, PathDistance(q, p));
  }
}

TEST(World, PlansKeepClearAndAreTheSameEachTime) {
  const World world = Scene();
  PlanRequest request;
  request.start = {-4, 0, 0.5};
  request.goal = {4, 0, 0.5};
  request.clearance = 0.4;
  request.seed = 5;
  const auto path = Plan(world, request);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->front(), request.start);
  EXPECT_EQ(path->back(), request.goal);
  for (size_t i = 0; i + 1 < path->size(); ++i) {
    for (int k = 0; k <= 100; ++k) {
      Point p{};
      for (size_t a = 0; a < 3; ++a) p[a] = (*path)[i][a] + k / 100.0 * ((*path)[i + 1][a] - (*path)[i][a]);
      EXPECT_GT(world.DistanceTo(p), 0.38);
    }
  }
  PlanRequest other = request;
  other.seed = 6;
  static_cast<void>(Plan(world, other));
  EXPECT_EQ(Plan(world, request), path);
  request.goal = {2, 0, 0.5};  // inside a box
  EXPECT_FALSE(Plan(world, request));
}

TEST(Contacts, FindsWhatTouches) {
  const World world = Scene();
  Contacts contacts(world, {0.3, 0.3, 0.3});
  contacts.Move({{0, 0, 0.5}, {3, 3, 0.5}, {-3, -3, 0.5}});
  EXPECT_TRUE(contacts.Touching().empty());
  contacts.Move({{0, 0, 0.5}, {0.5, 0, 0.5}, {1.3, -0.5, 0.5}});
  const std::vector<std::pair<int, int>> expected{{0, 1}, {2, -1}};
  EXPECT_EQ(contacts.Touching(), expected);
  EXPECT_EQ(contacts.LeastBetweenRobots(), 0);
  contacts.Move({{0, 2, 0.5}, {0, 4, 0.5}, {-4, 4, 0.5}});
  EXPECT_NEAR(contacts.LeastBetweenRobots(), 1.4, 1e-6);
  EXPECT_NEAR(contacts.LeastToObstacles(), std::hypot(1.5, 1.0) - 0.3, 1e-3);
}

}  // namespace
}  // namespace rondo::sim
