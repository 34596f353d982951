#include "platform/clock.h"

#include <gtest/gtest.h>

#include "dds/domain_test.h"
#include "platform/topics.h"
#include "ros/rosgraph_msgs.h"
#include "transport/mailbox.h"

namespace rondo::platform {
namespace {

TEST(Clock, IsThatOfTheMachine) {
  const Clock clock(false);
  EXPECT_TRUE(clock.begun());
  EXPECT_LT(std::abs(clock.Now() - transport::BootTime()), 1'000'000'000);
  EXPECT_LT(std::abs(clock.Stamp() - WallTime()), 1'000'000'000);
}

TEST(Clock, FollowsWhatIsSaidAndNeverStepsBack) {
  const auto participant = dds::Participant::Open(dds::TestNetwork()).value();
  const size_t node = participant->AddNode({"/", "simulator"});
  Clock clock(true);
  ASSERT_TRUE(clock.Begin(*participant, node).ok());
  EXPECT_FALSE(clock.begun());
  const auto publisher =
      participant->Publish(node, "/clock", ros::rosgraph_msgs::Clock::kMessage, {.depth = 1}).value();
  ASSERT_TRUE(dds::Eventually([&] { return publisher->matched() > 0; }));
  const auto say = [&](int64_t stamp) {
    ros::rosgraph_msgs::Clock m;
    m.clock = StampOf(stamp);
    EXPECT_TRUE(publisher->Publish(m).ok());
    return dds::Eventually([&] { return clock.Stamp() == stamp; });
  };
  ASSERT_TRUE(say(5'000'000'000));
  EXPECT_TRUE(clock.begun());
  const Time first = clock.Now();
  EXPECT_EQ(first, 5'000'000'000);  // the same for all who hear it
  ASSERT_TRUE(say(5'250'000'000));
  EXPECT_EQ(clock.Now() - first, 250'000'000);
  ASSERT_TRUE(say(1'000'000'000));  // the simulator began again
  EXPECT_EQ(clock.Now() - first, 250'000'000);
  EXPECT_EQ(clock.set_back(), 1U);
  ASSERT_TRUE(say(1'500'000'000));
  EXPECT_EQ(clock.Now() - first, 750'000'000);
}

}  // namespace
}  // namespace rondo::platform
