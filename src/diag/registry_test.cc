#include <gtest/gtest.h>

#include <set>

#include "diag/kind.h"

namespace rondo::diag {
namespace {

TEST(Registry, IdsAreUniqueAndFound) {
  std::set<std::string_view> ids;
  for (const KindInfo& info : AllKinds()) {
    EXPECT_TRUE(ids.insert(info.id).second) << info.id;
    ASSERT_NE(FindKind(info.id), nullptr);
    EXPECT_EQ(FindKind(info.id)->kind, info.kind);
  }
  EXPECT_EQ(FindKind("no-such-kind"), nullptr);
}

TEST(Registry, EveryKindIsExplained) {
  for (const KindInfo& info : AllKinds()) {
    EXPECT_FALSE(info.summary.empty()) << info.id;
    EXPECT_GT(info.explanation.size(), 60u) << info.id;
    EXPECT_FALSE(info.example.empty()) << info.id;
    const std::string_view verb = info.verb.substr(0, info.verb.find(' '));
    EXPECT_TRUE(verb == "check" || verb == "prove" || verb == "solve" || verb == "certify" ||
                verb == "explore" || verb == "simulate" || verb == "reach" || verb == "build")
        << info.id;
  }
}

TEST(Registry, SummariesFollowTheStyle) {
  for (const KindInfo& info : AllKinds()) {
    EXPECT_NE(info.summary.back(), '.') << info.id;
    EXPECT_FALSE(std::isupper(static_cast<unsigned char>(info.summary.front()))) << info.id;
  }
}

}  // namespace
}  // namespace rondo::diag
