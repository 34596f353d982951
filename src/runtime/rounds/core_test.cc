#include "runtime/rounds/core.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/rounds/fleet_test.h"

namespace rondo::runtime::rounds {
namespace {

constexpr uint32_t kRobots = 3;

Settings SettingsOf(uint32_t robot, uint64_t incarnation = 1) {
  return AdderFleet::SettingsOf(robot, kRobots, Exchange::kAllToAll, incarnation);
}

bool IsStatus(View bytes) {
  codec::Message message;
  return codec::Decode(bytes, 0, 0, kRobots, message) == codec::Refused::kNothing &&
         std::holds_alternative<codec::Status>(message.body);
}

TEST(Core, RoundsGoOnAndAllAct) {
  AdderFleet trio(kRobots);
  trio.Run(1500 * kMillisecond);
  for (const auto& core : trio.cores) EXPECT_GE(core->place().round, 13U);
  EXPECT_GE(trio.acts, 3 * 13);
  EXPECT_EQ(trio.programs[0]->sum() % 6, 0U);
}

TEST(Core, WhoActsHasNotGoneOnWhenTheStepIsOver) {
  AdderFleet trio(kRobots);
  trio.Run(350 * kMillisecond);
  // Robot 0 hears what others do, but not that they have stored it; then it is behind, and catches up in one step.
  trio.lets = [](uint32_t, uint32_t to, View bytes) { return to != 0 || !IsStatus(bytes); };
  trio.Run(900 * kMillisecond);
  EXPECT_GE(trio.acts, 3 * 9);
}

TEST(Core, WhatNobodyAcceptsIsASkip) {
  AdderFleet trio(kRobots);
  trio.programs[1]->foul = true;
  trio.Run(1500 * kMillisecond);
  for (const auto& core : trio.cores) EXPECT_GE(core->place().round, 13U);
  for (const auto& program : trio.programs) EXPECT_EQ(program->sum(), 4 * trio.cores[0]->place().round);
  EXPECT_GT(trio.cores[1]->refused()[static_cast<size_t>(codec::Refused::kMalformed)], 0U);
}

// Returns the first message of this kind that is sent; nothing if none is.
template <typename Body>
std::optional<Body> Sent(const Outputs& outputs) {
  for (const Output& output : outputs) {
    const auto* send = std::get_if<Send>(&output);
    codec::Message message;
    if (send == nullptr || codec::Decode(send->bytes, 0, 0, kRobots, message) != codec::Refused::kNothing)
      continue;
    if (const auto* body = std::get_if<Body>(&message.body)) return *body;
  }
  return std::nullopt;
}

// One core, and messages as others would send them.
class OneCoreTest : public testing::Test {
 protected:
  Outputs Hear(uint32_t from, codec::Body body, uint64_t incarnation = 1) {
    Bytes bytes;
    codec::Encode({0, 0, {from, incarnation}, std::move(body)}, bytes);
    Outputs outputs;
    now_ += kMillisecond;
    core_.Step(now_, bytes, outputs);
    return outputs;
  }
  static size_t CountStored(const Outputs& outputs) {
    size_t count = 0;
    for (const Output& output : outputs) count += std::holds_alternative<Stored>(output) ? 1 : 0;
    return count;
  }
  static uint64_t DigestOf(uint64_t sum) {
    Bytes store;
    codec::Writer(store).Number(sum);
    return codec::Sum(store);
  }
  const std::vector<Member> everybody_{{0, 1}, {1, 1}, {2, 1}};

  Adder program_{0};
  Core core_{SettingsOf(0), program_, nullptr, std::nullopt};
  Time now_ = 0;
};

// Else a majority seems to have the store, of which one promised that it does not.
TEST_F(OneCoreTest, WhoPromisedStoresNothingMoreOfItsEpoch) {
  EXPECT_EQ(CountStored(Hear(1, codec::Decided{{1, everybody_, {0, 0}, DigestOf(0)}})), 1U);
  Hear(1, codec::Decided{{2, everybody_, {1, 3}, DigestOf(18)}});
  EXPECT_EQ(core_.phase(), Phase::kFetching);
  const auto promise = Sent<codec::Promise>(Hear(2, codec::Prepare{3, {5, 2, 1}}));
  ASSERT_TRUE(promise.has_value());
  EXPECT_EQ(promise->newest, (Place{1, 0}));
  Bytes store;
  codec::Writer(store).Number(18);
  const codec::Part part{codec::What::kStore, {2, 3}, std::nullopt, codec::Sum(store), 0, 1, store};
  EXPECT_EQ(CountStored(Hear(1, part)), 0U);
  EXPECT_EQ(core_.phase(), Phase::kFetching);
  // The decision sets it free.
  Hear(2, codec::Decided{{3, everybody_, {2, 3}, DigestOf(18)}});
  EXPECT_EQ(CountStored(Hear(
                1, codec::Part{codec::What::kStore, {3, 3}, std::nullopt, codec::Sum(store), 0, 1, store})),
            1U);
}

// A life that forgot the ballots of the one before makes others.
TEST_F(OneCoreTest, AnswersToAnEarlierLifeDoNotCount) {
  Adder program(0);
  Core second(SettingsOf(0, 2), program, nullptr, std::nullopt);
  Outputs outputs;
  const auto hear = [&](uint32_t from, codec::Body body) {
    Bytes bytes;
    codec::Encode({0, 0, {from, 1}, std::move(body)}, bytes);
    outputs.Clear();
    now_ += kMillisecond;
    second.Step(now_, bytes, outputs);
  };
  std::optional<codec::Prepare> prepare;
  for (int i = 0; i < 50 && !prepare; ++i) {
    hear(1 + static_cast<uint32_t>(i) % 2, codec::Status{});
    prepare = Sent<codec::Prepare>(outputs);
  }
  ASSERT_TRUE(prepare.has_value());
  EXPECT_EQ(prepare->ballot.incarnation, 2U);
  const auto promise = [&](uint64_t incarnation) {
    const Ballot ballot{prepare->ballot.number, 0, incarnation};
    return codec::Promise{1, ballot, std::nullopt, std::nullopt, {0, 0}, DigestOf(0)};
  };
  for (uint32_t r = 1; r < kRobots; ++r) hear(r, promise(1));
  EXPECT_FALSE(Sent<codec::Accept>(outputs).has_value());
  hear(1, promise(2));
  hear(2, promise(2));
  EXPECT_TRUE(Sent<codec::Accept>(outputs).has_value());
}

// A disk that is full for a while costs its own vote for so long, and not for ever.
TEST(Core, WhoseDiskIsMendedVotesForWhatItProposed) {
  struct FullDisk : Disk {
    bool Keep(View) override { return !full; }
    bool full = false;
  } disk;
  Adder program(0);
  Core core(SettingsOf(0), program, &disk, std::nullopt);
  Time now = 0;
  const auto hear = [&](uint32_t from, codec::Body body) {
    Bytes bytes;
    codec::Encode({0, 0, {from, 1}, std::move(body)}, bytes);
    Outputs outputs;
    core.Step(now += kMillisecond, bytes, outputs);
    return outputs;
  };
  std::optional<codec::Prepare> prepare;
  for (uint32_t i = 0; i < 50 && !prepare; ++i)
    prepare = Sent<codec::Prepare>(hear(1 + i % 2, codec::Status{}));
  ASSERT_TRUE(prepare.has_value());
  Bytes store;
  program.Save(store);
  const codec::Promise promise{1, prepare->ballot, std::nullopt, std::nullopt, {0, 0}, codec::Sum(store)};
  hear(1, promise);
  disk.full = true;
  EXPECT_TRUE(Sent<codec::Accept>(hear(2, promise)).has_value());
  hear(1, codec::Accepted{1, prepare->ballot});
  EXPECT_FALSE(Sent<codec::Decided>(hear(2, codec::Accepted{1, prepare->ballot})).has_value());
  disk.full = false;
  bool decided = false;
  for (int i = 0; i < 50 && !decided; ++i)
    decided = Sent<codec::Decided>(hear(1, codec::Status{})).has_value();
  EXPECT_TRUE(decided);
}

// A robot that came back without its memory votes when it has the store of an epoch that admitted it.
TEST_F(OneCoreTest, WhoForgotVotesWhenItHasTheStore) {
  Hear(1, codec::Decided{{4, everybody_, {3, 7}, DigestOf(42)}});
  EXPECT_FALSE(Sent<codec::Promise>(Hear(2, codec::Prepare{5, {5, 2, 1}})).has_value());
  Bytes store;
  codec::Writer(store).Number(42);
  EXPECT_EQ(CountStored(Hear(
                1, codec::Part{codec::What::kStore, {4, 7}, std::nullopt, codec::Sum(store), 0, 1, store})),
            1U);
  EXPECT_TRUE(Sent<codec::Promise>(Hear(2, codec::Prepare{5, {5, 2, 1}})).has_value());
}

// Else everybody who is left waits for it for ever.
TEST_F(OneCoreTest, AStoreThatNobodyHasIsGivenUp) {
  Hear(1, codec::Decided{{1, everybody_, {0, 0}, DigestOf(0)}});
  Hear(1, codec::Decided{{2, everybody_, {1, 3}, DigestOf(18)}});
  std::optional<codec::Prepare> prepare;
  codec::Status waits;
  waits.at = {2, 3};
  for (int i = 0; i < 3000 && !prepare; ++i)
    prepare = Sent<codec::Prepare>(Hear(1 + static_cast<uint32_t>(i) % 2, waits));
  ASSERT_TRUE(prepare.has_value());
  EXPECT_EQ(prepare->epoch, 3U);
}

TEST_F(OneCoreTest, ABaseIsWhatWasDecided) {
  Hear(1, codec::Decided{{4, everybody_, {3, 7}, DigestOf(42)}});
  Bytes store;
  codec::Writer(store).Number(41);
  EXPECT_EQ(CountStored(Hear(
                1, codec::Part{codec::What::kStore, {4, 7}, std::nullopt, codec::Sum(store), 0, 1, store})),
            0U);
  EXPECT_EQ(core_.phase(), Phase::kFetching);
}

TEST(Core, WhoCannotBeIsHalted) {
  Adder program(0);
  Settings settings = SettingsOf(7);
  Core core(settings, program, nullptr, std::nullopt);
  Outputs outputs;
  core.Step(0, {}, outputs);
  ASSERT_EQ(outputs.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<Broken>(outputs[0]));
  EXPECT_EQ(core.wake(), INT64_MAX);
}

// With `halt`, who was left before anything was done does not wait for ever.
TEST(Core, AFleetThatNeverBeganHalts) {
  Adder program(0);
  Settings settings = SettingsOf(0);
  settings.on_loss = OnLoss::kHalt;
  Core core(settings, program, nullptr, std::nullopt);
  Bytes bytes;
  const std::vector<Member> everybody{{0, 1}, {1, 1}, {2, 1}};
  Bytes store;
  program.Save(store);
  codec::Encode({0, 0, {1, 1}, codec::Decided{{1, everybody, {0, 0}, codec::Sum(store)}}}, bytes);
  Outputs outputs;
  core.Step(0, bytes, outputs);
  EXPECT_EQ(core.phase(), Phase::kStored);
  for (Time now = 0; now < 2000 * kMillisecond; now += kMillisecond) core.Step(now, {}, outputs);
  EXPECT_EQ(core.phase(), Phase::kHalted);
  EXPECT_TRUE(
      std::ranges::any_of(outputs, [](const Output& o) { return std::holds_alternative<FallBack>(o); }));
}

}  // namespace
}  // namespace rondo::runtime::rounds
