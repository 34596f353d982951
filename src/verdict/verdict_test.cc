#include "verdict/verdict.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "verdict/basis.h"

namespace rondo::verdict {
namespace {

constexpr std::array kVerdicts{Verdict::kProved, Verdict::kConditional, Verdict::kUnknown,
                               Verdict::kNotInductive, Verdict::kRefuted};
constexpr std::array kStatuses{ExitStatus::kEstablished, ExitStatus::kUndecided, ExitStatus::kRejected,
                               ExitStatus::kUsage, ExitStatus::kBug};

TEST(Verdict, OnlyProofsEstablish) {
  for (const Verdict v : kVerdicts)
    EXPECT_EQ(StatusOf(v) == ExitStatus::kEstablished, v == Verdict::kProved) << Name(v);
}

TEST(Verdict, WhatIsNotDecidedIsNoRefutation) {
  EXPECT_EQ(StatusOf(Verdict::kUnknown), ExitStatus::kUndecided);
  EXPECT_EQ(StatusOf(Verdict::kConditional), ExitStatus::kUndecided);
  EXPECT_EQ(StatusOf(Verdict::kNotInductive), ExitStatus::kRejected);
}

TEST(Verdict, TheWorseOfTwoIsWhatBothTogetherAre) {
  for (size_t a = 0; a < kVerdicts.size(); ++a) {
    for (size_t b = 0; b < kVerdicts.size(); ++b)
      EXPECT_EQ(Worse(kVerdicts[a], kVerdicts[b]), kVerdicts[std::max(a, b)]);
  }
}

// Statuses are numbered as the command line promises, which is not how bad they are.
TEST(ExitStatus, AnUnknownNeverHidesARefutation) {
  for (size_t a = 0; a < kStatuses.size(); ++a) {
    for (size_t b = 0; b < kStatuses.size(); ++b)
      EXPECT_EQ(Worse(kStatuses[a], kStatuses[b]), kStatuses[std::max(a, b)]);
  }
}

TEST(ExitStatus, HasTheNumbersThatAreDocumented) {
  EXPECT_EQ(static_cast<int>(ExitStatus::kEstablished), 0);
  EXPECT_EQ(static_cast<int>(ExitStatus::kRejected), 1);
  EXPECT_EQ(static_cast<int>(ExitStatus::kUsage), 2);
  EXPECT_EQ(static_cast<int>(ExitStatus::kUndecided), 3);
  EXPECT_EQ(static_cast<int>(ExitStatus::kBug), 4);
}

TEST(Basis, KeepsEveryLineAsData) {
  const Basis basis{
      {"Motion.holds"}, {{"Motion.stays_near", Engine::kReachability, {"of Car"}}}, {"alpha > 0"}};
  const nlohmann::json json = ToJson(basis);
  EXPECT_EQ(json["assumed"], nlohmann::json({"Motion.holds"}));
  EXPECT_EQ(json["unused"], nlohmann::json({"alpha > 0"}));
  EXPECT_EQ(json["proved"][0]["claim"], "Motion.stays_near");
  EXPECT_EQ(json["proved"][0]["by"], "reachability");
  EXPECT_EQ(json["proved"][0]["limits"], nlohmann::json({"of Car"}));
}

}  // namespace
}  // namespace rondo::verdict
