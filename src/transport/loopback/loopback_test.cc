#include "transport/loopback/loopback.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <thread>

#include "runtime/rounds/adder_test.h"
#include "transport/conformance_test.h"

namespace rondo::transport::loopback {
namespace {

using namespace runtime::rounds;  // NOLINT: the words of the protocol

constexpr Time kSecond = 1'000'000'000;

struct Loopback {
  std::vector<std::unique_ptr<Transport>> Connect(size_t robots) {
    hub = std::make_unique<Hub>(robots);
    std::vector<std::unique_ptr<Transport>> ways;
    for (uint32_t r = 0; r < robots; ++r) ways.push_back(hub->Connect(r));
    return ways;
  }
  std::unique_ptr<Hub> hub;
};

TEST(Loopback, TheOldestGiveWay) {
  Hub hub(2, 3);
  const auto a = hub.Connect(0), b = hub.Connect(1);
  for (uint8_t i = 0; i < 5; ++i) a->Send(1, Bytes{i});
  Bytes datagram;
  for (uint8_t i = 2; i < 5; ++i) {
    EXPECT_TRUE(b->Receive(b->Now(), datagram));
    EXPECT_EQ(datagram, Bytes{i});
  }
  EXPECT_FALSE(b->Receive(b->Now(), datagram));
}

// Threads, a real clock: all act on the same stores, one round after the other.
TEST(Drive, AFleetOfThreadsAgrees) {
  constexpr uint32_t kRobots = 4;
  constexpr uint64_t kRounds = 10;
  Hub hub(kRobots);
  base::StopToken stop;
  std::mutex mutex;
  std::map<uint64_t, std::set<uint64_t>> acted;  // by round: sums
  std::vector<uint64_t> last(kRobots);
  std::vector<std::thread> threads;
  for (uint32_t r = 0; r < kRobots; ++r) {
    threads.emplace_back([&, r] {
      Settings settings;
      settings.self = r;
      settings.robots = kRobots;
      settings.on_loss = OnLoss::kWait;
      settings.delta = 2'000'000;
      settings.lease = settings.patience = 5 * kSecond;
      Adder adder(r);
      Core core(settings, adder, nullptr, std::nullopt);
      const auto way = hub.Connect(r);
      Drive(core, *way, stop, [&](Time, const Output& output) {
        const auto* act = std::get_if<Act>(&output);
        if (act == nullptr) return;
        const std::lock_guard lock(mutex);
        acted[act->at.round].insert(adder.sum());
        last[r] = act->at.round;
        if (std::ranges::all_of(last, [](uint64_t round) { return round >= kRounds; })) stop.RequestStop();
      });
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_GE(acted.size(), kRounds);
  for (const auto& [round, sums] : acted) EXPECT_EQ(sums, std::set<uint64_t>{10 * round}) << round;
}

}  // namespace
}  // namespace rondo::transport::loopback

namespace rondo::transport {
INSTANTIATE_TYPED_TEST_SUITE_P(Loopback, TransportConformance, loopback::Loopback);
}  // namespace rondo::transport
