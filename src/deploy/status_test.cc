#include "deploy/status.h"

#include <gtest/gtest.h>

#include "deploy/echo.h"
#include "deploy/latencies.h"

namespace rondo::deploy {
namespace {

TEST(RobotStatus, IsReadAsItWasWritten) {
  RobotStatus s;
  s.robot = "car1";
  s.program = "delivery.koord";
  s.phase = "collecting";
  s.agreement = "0123";
  s.epoch = 2;
  s.round = 77;
  s.active = true;
  s.median = 1.5;
  s.p99 = 20;
  s.fallbacks = 3;
  s.blind = 4;
  s.late = 5;
  s.refused = 6;
  s.unheard = {"car0", "drone1"};
  const auto message = MessageOf(s, 1);
  ASSERT_EQ(message.status.size(), 1U);
  EXPECT_EQ(message.status[0].level, 1);  // a warning
  EXPECT_EQ(message.status[0].message, "does not hear car0, drone1");
  const auto all = StatusesOf(message);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].robot, "car1");
  EXPECT_EQ(all[0].round, 77U);
  EXPECT_EQ(all[0].unheard, s.unheard);
  EXPECT_TRUE(all[0].active);
  EXPECT_EQ(all[0].late, 5U);
}

TEST(RobotStatus, TheWorstIsSaid) {
  RobotStatus s;
  s.active = true;
  EXPECT_EQ(MessageOf(s, 1).status[0].level, 0);
  s.unheard = {"car0"};
  s.sensors = "`psn`: nothing has come on /car1/odom yet";
  EXPECT_EQ(MessageOf(s, 1).status[0].level, 2);
  EXPECT_EQ(MessageOf(s, 1).status[0].message, s.sensors);
}

TEST(RobotStatus, DiagnosticsOfOthersAreLeftOut) {
  ros::diagnostic_msgs::DiagnosticArray message;
  message.status.emplace_back().name = "battery";
  EXPECT_TRUE(StatusesOf(message).empty());
}

TEST(Echo, AQuestionIsAnsweredOnce) {
  const std::string question = Encoded({7, 1000, 0});
  const auto answer = AnswerTo(question);
  ASSERT_TRUE(answer);
  const auto echo = Decoded(*answer);
  ASSERT_TRUE(echo);
  EXPECT_EQ(echo->number, 7U);
  EXPECT_EQ(echo->asked, 1000);
  EXPECT_GT(echo->answered, 1000);
  EXPECT_FALSE(AnswerTo(*answer));  // else two robots would go on for ever
  EXPECT_FALSE(AnswerTo("nonsense"));
  EXPECT_FALSE(Decoded(question.substr(0, question.size() - 8)));
}

TEST(Latencies, QuantilesAreRightToFiveInAHundred) {
  Latencies latencies;
  EXPECT_EQ(latencies.Quantile(0.5), 0);
  for (int64_t i = 1; i <= 1000; ++i) latencies.Add(i * 1'000'000);
  EXPECT_NEAR(latencies.Quantile(0.5), 0.5, 0.03);
  EXPECT_NEAR(latencies.Quantile(0.99), 0.99, 0.05);
  EXPECT_DOUBLE_EQ(latencies.Quantile(1), 1);
  EXPECT_DOUBLE_EQ(latencies.Most(), 1);
}

}  // namespace
}  // namespace rondo::deploy
