#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "runtime/rounds/adder_test.h"
#include "transport/transport.h"

namespace rondo::transport {

/// Threads, a real clock: all act on the same stores, one round after the other.
inline void ExpectThreadsAgree(const std::vector<std::unique_ptr<Transport>>& ways) {
  namespace rounds = runtime::rounds;
  constexpr uint64_t kRounds = 10;
  const auto robots = static_cast<uint32_t>(ways.size());
  base::StopToken stop;
  std::mutex mutex;
  std::map<uint64_t, std::set<uint64_t>> acted;  // by round: sums
  std::vector<uint64_t> last(robots);
  std::vector<std::thread> threads;
  for (uint32_t r = 0; r < robots; ++r) {
    threads.emplace_back([&, r] {
      rounds::Settings settings;
      settings.self = r;
      settings.robots = robots;
      settings.on_loss = rounds::OnLoss::kWait;
      settings.delta = 2'000'000;
      settings.lease = settings.patience = 5'000'000'000;
      rounds::Adder adder(r);
      rounds::Core core(settings, adder, nullptr, std::nullopt);
      Drive(core, *ways[r], stop, [&](rounds::Time, const rounds::Output& output) {
        const auto* act = std::get_if<rounds::Act>(&output);
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
  const uint64_t each = robots * (robots + 1) / 2;
  for (const auto& [round, sums] : acted) EXPECT_EQ(sums, std::set<uint64_t>{each * round}) << round;
}

}  // namespace rondo::transport
