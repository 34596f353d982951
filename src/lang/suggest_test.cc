#include "lang/suggest.h"

#include <gtest/gtest.h>

namespace rondo::lang {
namespace {

TEST(Suggest, FindsTypos) {
  EXPECT_EQ(Suggest("taget", {"position", "target"}), "target");
  EXPECT_EQ(Suggest("PSN", {"psn"}), "psn");
  EXPECT_EQ(Suggest("per", {"eff", "pre"}), "pre");
  EXPECT_EQ(Suggest("kyes", {"help", "keys"}), "keys");
  EXPECT_EQ(Suggest("all_task", {"all_tasks", "all_paths"}), "all_tasks");
}

TEST(Suggest, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(Suggest("velocity", {"target", "psn"}), "");
  EXPECT_EQ(Suggest("x", {"y"}), "");
}

}  // namespace
}  // namespace rondo::lang
