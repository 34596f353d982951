#include "base/stop.h"

#include <gtest/gtest.h>

namespace rondo::base {
namespace {

TEST(StopToken, CopiesShareTheFlag) {
  StopToken token;
  const StopToken copy = token.WithDeadline(StopToken::Clock::time_point::max());
  EXPECT_FALSE(copy.StopRequested());
  token.RequestStop();
  EXPECT_TRUE(copy.cancelled());
}

TEST(StopToken, TheEarlierDeadlineCounts) {
  const auto past = StopToken::Clock::now() - std::chrono::seconds(1);
  const StopToken token = StopToken().WithDeadline(past).WithDeadline(StopToken::Clock::time_point::max());
  EXPECT_TRUE(token.expired());
  EXPECT_FALSE(token.cancelled());
}

}  // namespace
}  // namespace rondo::base
