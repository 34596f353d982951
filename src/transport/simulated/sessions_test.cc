#include <gtest/gtest.h>

#include <queue>

#include "runtime/sessions/talker_test.h"
#include "transport/simulated/network.h"

/// Sessions of robots over a radio with faults, in virtual time.
namespace rondo::transport::simulated {
namespace {

using runtime::sessions::Member;
using runtime::sessions::MemberSettings;
using runtime::sessions::Outcome;
using runtime::sessions::Phase;
using runtime::sessions::Talker;

constexpr Time kMillisecond = 1'000'000, kSecond = 1'000'000'000;

class Air {
 public:
  Air(uint32_t robots, uint64_t seed) : network(robots, seed), talkers(robots) {
    for (uint32_t r = 0; r < robots; ++r) {
      talkers[r].robots = robots;
      talkers[r].self = r;
      MemberSettings& s = settings.emplace_back();
      s.session = 5;
      s.self = r;
      s.robots = robots;
    }
  }
  void Begin() {
    for (size_t r = 0; r < talkers.size(); ++r)
      members.push_back(std::make_unique<Member>(settings[r], talkers[r], talkers[r]));
  }

  // Lets time pass until then, or until all have an outcome.
  void Until(Time end) {
    for (; now <= end; now += kMillisecond) {
      while (!under_way.empty() && under_way.top().at <= now) {
        const Delivery d = under_way.top();
        under_way.pop();
        Do(d.to, d.bytes);
      }
      for (uint32_t r = 0; r < members.size(); ++r) {
        if (members[r]->wake() <= now) Do(r, {});
      }
    }
  }
  void Do(uint32_t robot, const std::vector<uint8_t>& bytes) {
    if (off.contains(robot)) return;
    for (const Member::Letter& letter : members[robot]->Step(now, bytes)) {
      std::vector<Delivery> arrives;
      for (uint32_t to = 0; to < members.size(); ++to) {
        if (to != robot && (!letter.to || *letter.to == to))
          network.Send(now, robot, to, letter.bytes, arrives);
      }
      for (Delivery& d : arrives) under_way.push(std::move(d));
    }
    // Whoever is at the end has to be right.
    if (members[robot]->outcome() == Outcome::kOver || members[robot]->phase() == Phase::kFinished) {
      for (const Talker& t : talkers) EXPECT_TRUE(t.to_send.empty());
    }
  }
  std::vector<Outcome> Outcomes() const {
    std::vector<Outcome> all;
    for (const auto& m : members) all.push_back(m->outcome());
    return all;
  }

  struct Later {
    bool operator()(const Delivery& a, const Delivery& b) const { return a.at > b.at; }
  };
  Network network;
  std::vector<Talker> talkers;
  std::vector<MemberSettings> settings;
  std::vector<std::unique_ptr<Member>> members;
  std::priority_queue<Delivery, std::vector<Delivery>, Later> under_way;
  std::set<uint32_t> off;
  Time now = 0;
};

TEST(Sessions, MessagesComeOnceAndInOrderWhateverTheNetworkDoes) {
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    std::mt19937_64 random(seed);
    const auto robots = static_cast<uint32_t>(2 + random() % 4);
    Air air(robots, seed);
    air.network.conditions = {static_cast<double>(random() % 5) / 10, 0.3, 0.1, 0,
                              static_cast<Time>(random() % 60) * kMillisecond};
    // Only ever from a lower to a higher robot at first, and around the ring: nobody waits in a circle at the start.
    for (uint32_t r = 0; r + 1 < robots; ++r) {
      for (int i = 0; i < 8; ++i) air.talkers[r].to_send.push_back({r + 1, static_cast<double>(100 * i)});
    }
    air.talkers[0].to_send.push_back({1, 800.0 + 10 * static_cast<double>(random() % 2)});
    air.Begin();
    air.Until(60 * kSecond);
    EXPECT_EQ(air.Outcomes(), std::vector(robots, Outcome::kOver)) << seed;
    for (uint32_t r = 1; r < robots; ++r) {
      const auto& taken = air.talkers[r].taken[r - 1];
      EXPECT_TRUE(std::ranges::is_sorted(taken, std::less_equal<>())) << seed;
      EXPECT_GE(taken.size(), 8U) << seed;
    }
  }
}

TEST(Sessions, BeginWhenAllHaveHeardOfAll) {
  Air air(3, 1);
  air.off = {2};
  air.Begin();
  air.Until(5 * kSecond);
  EXPECT_EQ(air.members[0]->phase(), Phase::kGathering);
  EXPECT_EQ(air.members[0]->Missing(), std::vector<uint32_t>{2});
  air.off = {};
  air.network.Cut(2, 1);
  air.Until(6 * kSecond);
  EXPECT_EQ(air.members[0]->phase(), Phase::kGathering);
  EXPECT_EQ(air.members[0]->Missing(), std::vector<uint32_t>{1});  // which does not hear the last one
  EXPECT_EQ(air.members[2]->phase(), Phase::kGathering);
  air.network.Mend(2, 1);
  air.Until(8 * kSecond);
  EXPECT_EQ(air.Outcomes(), std::vector(3, Outcome::kOver));
}

// Somebody who has no end.
void Endless(Air& air) {
  for (int i = 0; i < 100'000; ++i) air.talkers[0].to_send.push_back({1, 0});
}

TEST(Sessions, WhoIsSilentIsGivenUpByAll) {
  Air air(3, 1);
  Endless(air);
  air.Begin();
  air.Until(kSecond);
  EXPECT_EQ(air.Outcomes(), std::vector(3, Outcome::kOpen));
  air.off = {2};
  air.Until(kSecond + air.settings[0].patience + 200 * kMillisecond);
  EXPECT_EQ(air.members[0]->outcome(), Outcome::kLost);
  EXPECT_EQ(air.members[1]->outcome(), Outcome::kLost);
  EXPECT_EQ(air.members[0]->phase(), Phase::kGone);
  const auto name = [](uint32_t r) { return "r" + std::to_string(r); };
  const std::set<std::string> why{air.members[0]->Why(name), air.members[1]->Why(name)};
  EXPECT_TRUE(why.contains("r2 is silent")) << *why.begin();
  // Whoever was away hears of it.
  air.off = {};
  air.Until(air.now + 200 * kMillisecond);
  EXPECT_EQ(air.members[2]->outcome(), Outcome::kLost);
}

TEST(Sessions, AShortSilenceIsNone) {
  Air air(2, 1);
  for (int i = 0; i < 100; ++i) air.talkers[0].to_send.push_back({1, static_cast<double>(100 * i)});
  air.Begin();
  air.Until(100 * kMillisecond);
  air.network.Cut(0, 1);
  air.network.Cut(1, 0);
  air.Until(100 * kMillisecond + air.settings[0].patience / 2);
  air.network.Mend(0, 1);
  air.network.Mend(1, 0);
  air.Until(20 * kSecond);
  EXPECT_EQ(air.Outcomes(), std::vector(2, Outcome::kOver));
  EXPECT_EQ(air.talkers[1].taken[0].size(), 100U);
}

TEST(Sessions, WhoStartsAgainDoesNotGoOn) {
  Air air(2, 1);
  Endless(air);
  air.Begin();
  air.Until(300 * kMillisecond);
  ++air.settings[1].incarnation;
  Talker again;
  again.robots = 2;
  again.self = 1;
  air.members[1] = std::make_unique<Member>(air.settings[1], again, again);
  air.Until(600 * kMillisecond);
  EXPECT_EQ(air.members[0]->outcome(), Outcome::kLost);
  EXPECT_EQ(air.members[0]->Why([](uint32_t) { return "it"; }),
            "it started again, and does not know where it was");
  EXPECT_TRUE(again.taken.empty());
}

TEST(Sessions, WhoIsStoppedTellsTheOthers) {
  Air air(3, 1);
  Endless(air);
  air.Begin();
  air.Until(300 * kMillisecond);
  air.members[1]->Leave();
  air.Until(400 * kMillisecond);
  EXPECT_EQ(air.Outcomes(), (std::vector{Outcome::kStopped, Outcome::kLeft, Outcome::kStopped}));
}

TEST(Sessions, RobotsOfAnotherChoreographyAreNoneOfThem) {
  Air air(2, 1);
  air.settings[1].agreement = 9;
  air.Begin();
  air.Until(kSecond);
  EXPECT_EQ(air.members[0]->phase(), Phase::kGathering);
  EXPECT_GT(air.members[0]->foreign(), 0U);
  Air other(2, 1);
  other.settings[1].session = 9;
  other.Begin();
  other.Until(kSecond);
  EXPECT_GT(other.members[0]->strange(), 0U);
}

}  // namespace
}  // namespace rondo::transport::simulated
