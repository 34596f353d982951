#include "deploy/planner.h"

#include <gtest/gtest.h>

namespace rondo::deploy {
namespace {

sim::World WithAWall() {
  sim::World world;
  world.boxes.push_back({{0, 0, 1}, {0.2, 6, 2}});
  return world;
}

sim::PlanRequest Across(double y) {
  sim::PlanRequest request;
  request.start = {-3, y, 0};
  request.goal = {3, 0, 0};
  request.clearance = 0.3;
  request.seed = 5;
  return request;
}

TEST(PlannerThread, WhoAsksDoesNotWait) {
  PlannerThread planner(0.1);
  EXPECT_FALSE(planner.Ask(WithAWall(), Across(0), false).ready);
  for (int i = 0; i < 2000; ++i) {
    const auto planned = planner.Ask(WithAWall(), Across(0), false);
    if (!planned.ready) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    ASSERT_TRUE(planned.path);
    EXPECT_EQ(*planned.path, *sim::Plan(WithAWall(), Across(0)));
    return;
  }
  FAIL() << "there is no answer";
}

TEST(PlannerThread, AnAnswerBeginsWhereTheRobotIsNow) {
  PlannerThread planner(0.1);
  const auto first = planner.Ask(WithAWall(), Across(0), true);
  ASSERT_TRUE(first.ready && first.path);
  const auto near = planner.Ask(WithAWall(), Across(0.05), false);
  ASSERT_TRUE(near.ready && near.path);
  EXPECT_EQ(near.path->front(), Across(0.05).start);
  EXPECT_EQ(near.path->size(), first.path->size() + 1);
  EXPECT_FALSE(planner.Ask(WithAWall(), Across(1), false).ready);  // that is elsewhere
}

TEST(PlannerThread, NoWayIsAnAnswer) {
  sim::World world = WithAWall();
  world.boxes.push_back({{3, 0, 1}, {2, 2, 2}});  // around the goal
  PlannerThread planner(0.1);
  const auto planned = planner.Ask(world, Across(0), true);
  EXPECT_TRUE(planned.ready);
  EXPECT_FALSE(planned.path);
}

}  // namespace
}  // namespace rondo::deploy
