#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <set>

#include "runtime/rounds/adder_test.h"
#include "runtime/rounds/core.h"

namespace rondo::runtime::rounds {

constexpr Time kMillisecond = 1'000'000;

/// Is a fleet of adders whose datagrams take a millisecond, if `lets` lets them through.
class AdderFleet {
 public:
  static Settings SettingsOf(uint32_t robot, uint32_t robots, Exchange exchange, uint64_t incarnation = 1) {
    Settings settings;
    settings.self = robot;
    settings.robots = robots;
    settings.incarnation = incarnation;
    settings.on_loss = robots == 2 ? OnLoss::kWait : OnLoss::kEvict;
    settings.parts = PartsOf(exchange);
    return settings;
  }

  explicit AdderFleet(uint32_t robots, Exchange exchange = Exchange::kAllToAll) {
    for (uint32_t r = 0; r < robots; ++r) {
      programs.push_back(std::make_unique<Adder>(r));
      cores.push_back(
          std::make_unique<Core>(SettingsOf(r, robots, exchange), *programs[r], nullptr, std::nullopt));
    }
  }

  void Run(Time span) {
    for (const Time end = now + span; now < end; now += kMillisecond) {
      std::vector<std::pair<uint32_t, Bytes>> arriving;
      std::swap(arriving, waiting);
      for (uint32_t r = 0; r < cores.size(); ++r) Step(r, {});
      for (const auto& [to, bytes] : arriving) Step(to, bytes);
    }
  }

  void Step(uint32_t robot, View datagram) {
    if (gone.contains(robot)) return;
    outputs.Clear();
    cores[robot]->Step(now, datagram, outputs);
    for (const Output& output : outputs) {
      if (const auto* send = std::get_if<Send>(&output)) {
        for (uint32_t to = 0; to < cores.size(); ++to) {
          if (to == robot || (send->to != kAll && send->to != to)) continue;
          ++sent;
          if (lets(robot, to, send->bytes)) waiting.emplace_back(to, send->bytes);
        }
      }
      if (const auto* stored = std::get_if<Stored>(&output)) {
        const auto [it, fresh] = digests.emplace(stored->at, stored->digest);
        EXPECT_EQ(it->second, stored->digest) << stored->at.round;
      }
      if (const auto* act = std::get_if<Act>(&output)) {
        // What is acted on is what the program has when the step is over.
        Bytes store;
        programs[robot]->Save(store);
        EXPECT_EQ(codec::Sum(store), digests.at(act->at)) << act->at.round;
        ++acts;
      }
      if (const auto* adopted = std::get_if<Adopted>(&output))
        teams[adopted->decision.epoch] = adopted->decision.members;
      EXPECT_FALSE(std::holds_alternative<Broken>(output));
    }
  }

  /// Begins another life of a robot, which has forgotten everything.
  void Restart(uint32_t robot, Exchange exchange) {
    const auto robots = static_cast<uint32_t>(cores.size());
    programs[robot] = std::make_unique<Adder>(robot);
    cores[robot] = std::make_unique<Core>(SettingsOf(robot, robots, exchange, ++lives[robot] + 1),
                                          *programs[robot], nullptr, std::nullopt);
    gone.erase(robot);
  }

  /// Returns the round of the robot that is behind all others.
  uint64_t Least() const {
    uint64_t least = UINT64_MAX;
    for (uint32_t r = 0; r < cores.size(); ++r) {
      if (!gone.contains(r)) least = std::min(least, cores[r]->place().round);
    }
    return least;
  }

  std::vector<std::unique_ptr<Adder>> programs;
  std::vector<std::unique_ptr<Core>> cores;
  std::function<bool(uint32_t, uint32_t, View)> lets = [](uint32_t, uint32_t, View) { return true; };
  std::vector<std::pair<uint32_t, Bytes>> waiting;
  std::map<Place, uint64_t> digests;
  std::map<uint64_t, std::vector<codec::Member>> teams;  ///< by epoch
  std::map<uint32_t, uint64_t> lives;                    ///< that are over
  std::set<uint32_t> gone;                               ///< robots that do nothing any more
  Outputs outputs;
  Time now = 0;
  int acts = 0;
  uint64_t sent = 0;  ///< datagrams, each receiver counted
};

}  // namespace rondo::runtime::rounds
