// What every shared memory, lock and barrier has to keep, whatever it is made of.
#include "runtime/rounds/parts.h"

#include <random>

#include "runtime/rounds/every_exchange_test.h"
#include "runtime/rounds/fleet_test.h"

namespace rondo::runtime::rounds {
namespace {

class PartsConformance : public testing::TestWithParam<Exchange> {
 protected:
  static std::vector<Member> Members(uint32_t robots) {
    std::vector<Member> members;
    for (uint32_t r = 0; r < robots; ++r) members.push_back({2 * r + 1, 7});
    return members;
  }
};

TEST_P(PartsConformance, WhoCollectsAndCountsIsAMember) {
  const Parts parts = PartsOf(GetParam());
  for (uint32_t robots = 1; robots < 6; ++robots) {
    const std::vector<Member> members = Members(robots);
    for (uint64_t epoch = 1; epoch < 9; ++epoch) {
      for (const auto& hub :
           {parts.memory->Collector(epoch, members), parts.barrier->Counter(epoch, members)})
        EXPECT_TRUE(!hub || (*hub % 2 == 1 && *hub < 2 * robots)) << epoch;
    }
  }
}

TEST_P(PartsConformance, EverybodyHasATurnInARoundAndIsFirstInOneOfSoManyRounds) {
  const Parts parts = PartsOf(GetParam());
  for (size_t robots = 1; robots < 6; ++robots) {
    std::set<size_t> first;
    for (uint64_t round = 3; round < 3 + robots; ++round) {
      std::set<size_t> all;
      for (size_t turn = 0; turn < robots; ++turn) all.insert(parts.locks->Who(round, turn, robots));
      EXPECT_EQ(all.size(), robots);
      EXPECT_LT(*all.rbegin(), robots);
      first.insert(parts.locks->Who(round, 0, robots));
    }
    EXPECT_EQ(first.size(), robots);
  }
}

TEST_P(PartsConformance, AllHaveTheSameStoresAndAct) {
  for (uint32_t robots = 1; robots < 8; ++robots) {
    AdderFleet fleet(robots, GetParam());
    fleet.Run(1500 * kMillisecond);
    EXPECT_GE(fleet.Least(), 13U) << robots;
    EXPECT_GE(fleet.acts, static_cast<int>(robots) * 13);
  }
}

TEST_P(PartsConformance, RoundsGoOnOverARadioThatLoses) {
  for (const double loss : {0.1, 0.2, 0.4}) {
    std::mt19937 random(1);
    AdderFleet fleet(5, GetParam());
    fleet.lets = [&](uint32_t, uint32_t, View) {
      return std::generate_canonical<double, 32>(random) >= loss;
    };
    fleet.Run(6000 * kMillisecond);
    EXPECT_GE(fleet.Least(), 20U) << loss;
  }
}

TEST_P(PartsConformance, WhoeverIsGoneTheOthersGoOn) {
  for (uint32_t lost = 0; lost < 4; ++lost) {
    AdderFleet fleet(4, GetParam());
    fleet.Run(500 * kMillisecond);
    fleet.gone.insert(lost);
    const uint64_t before = fleet.Least();
    fleet.Run(4000 * kMillisecond);
    EXPECT_GE(fleet.Least(), before + 5) << lost;
  }
}

// Who is not heard by everybody, because all goes over one robot, is there nevertheless.
TEST_P(PartsConformance, WhoComesBackTakesNobodysPlace) {
  for (uint32_t seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    AdderFleet fleet(6, GetParam());
    const double loss = 0.1 * (seed % 3);
    fleet.lets = [&](uint32_t, uint32_t, View) {
      return std::generate_canonical<double, 32>(random) >= loss;
    };
    fleet.Run(700 * kMillisecond);
    fleet.gone.insert(4);
    fleet.Run(3000 * kMillisecond);
    const uint64_t without = fleet.teams.rbegin()->first;
    fleet.Restart(4, GetParam());
    fleet.Run(3000 * kMillisecond);
    for (auto it = fleet.teams.upper_bound(without); it != fleet.teams.end(); ++it)
      EXPECT_GE(it->second.size(), 6U) << "epoch " << it->first << " of seed " << seed;
    EXPECT_EQ(fleet.teams.rbegin()->second.size(), 6U) << seed;
  }
}

// Until everything arrives again.
TEST_P(PartsConformance, AFleetThatIsCutInTwoIsOneAgain) {
  AdderFleet fleet(5, GetParam());
  fleet.Run(450 * kMillisecond);
  fleet.lets = [](uint32_t from, uint32_t to, View) { return (from < 2) == (to < 2); };
  fleet.Run(3000 * kMillisecond);
  fleet.lets = [](uint32_t, uint32_t, View) { return true; };
  const uint64_t before = fleet.Least();
  fleet.Run(4000 * kMillisecond);
  EXPECT_GE(fleet.Least(), before + 5);
}

RONDO_FOR_EVERY_EXCHANGE(PartsConformance);

uint64_t Datagrams(uint32_t robots, Exchange exchange) {
  AdderFleet fleet(robots, exchange);
  fleet.Run(300 * kMillisecond);
  const uint64_t before = fleet.sent, round = fleet.Least();
  fleet.Run(1000 * kMillisecond);
  EXPECT_EQ(fleet.Least(), round + 10);
  return (fleet.sent - before) / 10;
}

// Frames and news of all to all, against: one frame to all, all others to one, all of them to all, news to one, one word
// to all.
TEST(Parts, OneRobotInTheMiddleSavesDatagrams) {
  for (const uint32_t n : {3U, 8U}) {
    EXPECT_EQ(Datagrams(n, Exchange::kAllToAll), 2 * n * (n - 1));
    EXPECT_EQ(Datagrams(n, Exchange::kSequencer), 5 * (n - 1));
    EXPECT_EQ(Datagrams(n, Exchange::kCentral), 5 * (n - 1));
  }
}

// Robots 0 and 1 do not hear each other; whoever is in the middle of epoch 1, one of them misses it or is missed by it.
TEST(Parts, WithASequencerRobotsHelpEachOther) {
  AdderFleet fleet(3, Exchange::kSequencer);
  fleet.Run(350 * kMillisecond);
  EXPECT_EQ(PartsOf(Exchange::kSequencer).memory->Collector(1, std::vector<Member>{{0, 1}, {1, 1}, {2, 1}}),
            1U);
  fleet.lets = [](uint32_t from, uint32_t to, View) { return from + to != 1; };
  const uint64_t before = fleet.Least();
  fleet.Run(1000 * kMillisecond);
  EXPECT_GE(fleet.Least(), before + 8);
  EXPECT_EQ(fleet.cores[0]->place().epoch, 1U);
}

}  // namespace
}  // namespace rondo::runtime::rounds
