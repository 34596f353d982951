#include "runtime/rounds/merge.h"

#include <gtest/gtest.h>

namespace rondo::runtime::rounds {
namespace {

const std::vector<uint32_t> kRobots{1, 4, 6};

std::vector<Contribution> Each(std::vector<Alternative> alternatives) {
  return std::vector<Contribution>(3, Contribution{{}, std::move(alternatives)});
}

std::vector<Turn> TurnsOf(uint64_t round, const std::vector<Contribution>& contributions) {
  std::vector<Turn> turns;
  Merge(round, *PartsOf(Exchange::kAllToAll).locks, kRobots, contributions, turns);
  return turns;
}

TEST(Merge, TheOrderBeginsWithAnotherRobotInEachRound) {
  const auto contributions = Each({});
  for (uint64_t round = 0; round < 7; ++round) {
    const auto turns = TurnsOf(round, contributions);
    ASSERT_EQ(turns.size(), 3U);
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(turns[i].robot, kRobots[(round + i) % 3]);
  }
}

TEST(Merge, ALockHasOneHolderAndTheOthersDoWhatElseTheyCan) {
  const auto contributions = Each({{5, true, {}}, {7, false, {}}});
  const auto turns = TurnsOf(1, contributions);
  ASSERT_NE(turns[0].does, nullptr);
  EXPECT_EQ(turns[0].robot, 4U);
  EXPECT_EQ(turns[0].does->event, 5U);
  EXPECT_EQ(turns[1].does->event, 7U);
  EXPECT_EQ(turns[2].does->event, 7U);
}

TEST(Merge, WhoseLocksAreTakenSkips) {
  const auto contributions = Each({{5, true, {}}, {6, true, {}}});
  const auto turns = TurnsOf(0, contributions);
  EXPECT_EQ(turns[0].does->event, 5U);
  EXPECT_EQ(turns[1].does->event, 6U);
  EXPECT_EQ(turns[2].does, nullptr);
}

TEST(Merge, EverybodyGetsALockWithinAsManyRoundsAsThereAreRobots) {
  const auto contributions = Each({{5, true, {}}});
  std::vector<bool> had(7);
  for (uint64_t round = 10; round < 13; ++round) had[TurnsOf(round, contributions)[0].robot] = true;
  for (const uint32_t robot : kRobots) EXPECT_TRUE(had[robot]) << robot;
}

TEST(Merge, ContributionsComeBackAsTheyWere) {
  const Bytes inputs{1, 2}, effect{3, 4, 5};
  const Contribution contribution{inputs, {{5, true, effect}, {6, false, {}}}};
  Bytes bytes;
  Encode(contribution, bytes);
  Contribution back;
  ASSERT_TRUE(Decode(bytes, back));
  Bytes again;
  Encode(back, again);
  EXPECT_EQ(again, bytes);
  EXPECT_EQ(back.alternatives[0].event, 5U);
  for (size_t length = 0; length < bytes.size(); ++length)
    EXPECT_FALSE(Decode(View(bytes).first(length), back)) << length;
}

}  // namespace
}  // namespace rondo::runtime::rounds
