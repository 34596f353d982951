#include "solve/smtlib/process.h"

#include <gtest/gtest.h>

namespace rondo::solve::smtlib {
namespace {

using std::chrono::seconds;

TEST(RunProcess, PassesInputAndReturnsOutput) {
  const std::string big(1 << 20, 'x');  // more than a pipe holds, both ways
  const auto output = RunProcess({"cat"}, big, seconds(60), {});
  ASSERT_TRUE(output.ok());
  EXPECT_EQ(output.value().text, big);
  EXPECT_EQ(output.value().status, 0);
}

TEST(RunProcess, AProgramThatIsNotThereIsAnError) {
  EXPECT_FALSE(RunProcess({"rondo-no-such-program"}, "", seconds(60), {}).ok());
}

TEST(RunProcess, AChildThatDoesNotReadIsHarmless) {
  const auto output = RunProcess({"true"}, std::string(1 << 20, 'x'), seconds(60), {});
  ASSERT_TRUE(output.ok());
  EXPECT_EQ(output.value().status, 0);
}

TEST(RunProcess, ACancelledTokenKillsTheChild) {
  const base::StopToken stop;
  stop.RequestStop();
  const auto output = RunProcess({"sleep", "1000"}, "", seconds(1000), stop);
  ASSERT_TRUE(output.ok());
  EXPECT_TRUE(output.value().timed_out);
}

TEST(RunProcess, AChildThatClosesItsOutputIsKilledWhenTimeIsOver) {
  const auto output = RunProcess({"sh", "-c", "exec >&-; sleep 1000"}, "", std::chrono::milliseconds(50), {});
  ASSERT_TRUE(output.ok());
  EXPECT_TRUE(output.value().timed_out);
}

}  // namespace
}  // namespace rondo::solve::smtlib
