#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "runtime/rounds/adder_test.h"
#include "runtime/sessions/talker_test.h"
#include "transport/sessions.h"
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

/// Threads, a real clock: each message is taken once, in order, and all know when it is over.
inline void ExpectSessionsEnd(const std::vector<std::unique_ptr<Transport>>& ways) {
  namespace sessions = runtime::sessions;
  constexpr int kMessages = 20;
  const auto robots = static_cast<uint32_t>(ways.size());
  std::vector<sessions::Talker> talkers(robots);
  std::vector<sessions::Outcome> outcomes(robots);
  std::vector<std::thread> threads;
  for (uint32_t r = 0; r < robots; ++r) {
    talkers[r].robots = robots;
    talkers[r].self = r;
    for (int i = 0; r + 1 < robots && i < kMessages; ++i) talkers[r].to_send.push_back({r + 1, 100.0 * i});
    threads.emplace_back([&, r] {
      sessions::MemberSettings settings;
      settings.self = r;
      settings.robots = robots;
      settings.patience = 10'000'000'000;
      sessions::Member member(settings, talkers[r], talkers[r]);
      Drive(member, *ways[r], base::StopToken(), [](sessions::Time) {});
      outcomes[r] = member.outcome();
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(outcomes, std::vector(robots, sessions::Outcome::kOver));
  for (uint32_t r = 0; r + 1 < robots; ++r) {
    const auto& taken = talkers[r + 1].taken[r];
    ASSERT_EQ(taken.size(), size_t{kMessages});
    for (int i = 0; i < kMessages; ++i) EXPECT_EQ(taken[static_cast<size_t>(i)], 100.0 * i);
  }
}

}  // namespace rondo::transport
