#include "base/check.h"

#include <gtest/gtest.h>

namespace {

TEST(Check, PassesSilently) {
  CHECK(1 + 1 == 2) << "never printed";
  SUCCEED();
}

TEST(CheckDeathTest, ExitsWithFourAndTheValues) {
  EXPECT_EXIT(CHECK(1 > 2) << "x=" << 7, testing::ExitedWithCode(4), "internal check failed: 1 > 2 x=7");
}

}  // namespace
