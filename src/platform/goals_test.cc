#include "platform/goals.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace rondo::platform {
namespace {

constexpr int8_t kExecuting = 2, kSucceeded = 4, kAborted = 6;
struct Status {
  uint8_t id;
  int32_t accepted;  // seconds
  int8_t status;
};

ros::action_msgs::GoalStatusArray Array(std::initializer_list<Status> all) {
  ros::action_msgs::GoalStatusArray m;
  for (const Status& s : all) {
    auto& status = m.status_list.emplace_back();
    status.goal_info.goal_id.uuid[15] = s.id;
    status.goal_info.stamp.sec = s.accepted;
    status.status = s.status;
  }
  return m;
}

int64_t At(int64_t seconds) { return seconds * 1'000'000'000; }

TEST(Goals, NothingIsReachedBeforeAnOrder) {
  Goals goals;
  EXPECT_FALSE(goals.reached().has_value());
  goals.Hear(Array({{1, 5, kSucceeded}}));
  EXPECT_FALSE(goals.reached().has_value());
}

TEST(Goals, OnlyWhatWasAcceptedAfterTheOrderCounts) {
  Goals goals;
  goals.Hear(Array({{1, 5, kExecuting}}));
  goals.Begin(At(10));
  EXPECT_EQ(goals.reached(), false);
  goals.Hear(Array({{1, 5, kSucceeded}}));  // somebody else's, of before
  EXPECT_EQ(goals.reached(), false);
  goals.Hear(Array({{2, 9, kSucceeded}}));  // accepted before, heard late
  EXPECT_EQ(goals.reached(), false);
  goals.Hear(Array({{2, 9, kSucceeded}, {3, 10, kExecuting}}));
  EXPECT_EQ(goals.reached(), false);
  goals.Hear(Array({{2, 9, kSucceeded}, {3, 10, kSucceeded}}));
  EXPECT_EQ(goals.reached(), true);
}

TEST(Goals, ClocksMayDifferALittle) {
  Goals goals;
  goals.Begin(At(10) + 200'000'000);  // this clock is ahead
  goals.Hear(Array({{1, 10, kSucceeded}}));
  EXPECT_EQ(goals.reached(), true);
}

TEST(Goals, ThoseOfTheOrderBeforeDoNotCountForTheNext) {
  Goals goals;
  goals.Begin(At(10));
  goals.Hear(Array({{1, 10, kExecuting}}));
  goals.Begin(At(10));  // at once, by a clock that is coarse
  goals.Hear(Array({{1, 10, kSucceeded}}));
  EXPECT_EQ(goals.reached(), false);
  goals.Hear(Array({{1, 10, kAborted}, {2, 11, kSucceeded}}));
  EXPECT_EQ(goals.reached(), true);
}

TEST(Goals, TheLatestOfAnOrderThatWasGivenTwiceCounts) {
  Goals goals;
  goals.Begin(At(10));
  goals.Hear(Array({{1, 10, kAborted}, {2, 12, kExecuting}}));
  EXPECT_EQ(goals.reached(), false);
  goals.Hear(Array({{1, 10, kSucceeded}, {2, 12, kExecuting}}));
  EXPECT_EQ(goals.reached(), false);
  goals.Hear(Array({{2, 12, kSucceeded}}));
  EXPECT_EQ(goals.reached(), true);
}

}  // namespace
}  // namespace rondo::platform
