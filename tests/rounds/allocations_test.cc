// After a fleet has got going, a round takes no memory from the system: neither the cores nor the programs, whose lists
// become no longer than they were, nor the way between the robots.
#include <gtest/gtest.h>

#include "counted_allocations.h"
#include "koord/node/compiled_test.h"
#include "koord/node/node.h"
#include "runtime/rounds/core.h"
#include "runtime/rounds/every_exchange_test.h"

namespace rondo::runtime::rounds {
namespace {

// Locks, lists of up to four orders, sensors, what all write, and an urgent event.
constexpr const char* kProgram = R"(
using Motion:
    sensors:
        pos psn
        List<float> ranges
    actuators:
        pos target
allwrite:
    List<int> orders
    int taken = 0
allread:
    List<pos> path[N_sys]
local:
    int n = 0
Order:
    pre: len(orders) < 4
    eff:
        atomic:
            orders.append(pid + n)
        n = (n + 1) % 7
Take:
    pre: len(orders) > 2
    eff:
        atomic:
            taken = orders[0]
            orders.remove(orders[0])
        path[pid] = [Motion.psn, pos(taken, n, 0)]
        Motion.target = Motion.psn
Far:
    pre urgent: n == 5
    eff:
        n = 0
)";

class Steps : public koord::node::Sensors {
 public:
  explicit Steps(koord::semantics::Team& team) : team_(team) {}
  void Read(size_t robot, uint64_t round, koord::node::Cell,
            std::span<koord::semantics::Word> words) override {
    const auto value = [&](uint64_t i) {
      return koord::semantics::FromFloat(static_cast<double>((round + robot + i) % 10));
    };
    if (words.size() == 1) {
      const koord::semantics::Word ranges[] = {value(0), value(3), value(5)};
      words[0] = team_.heap().Intern(ranges);
      return;
    }
    for (size_t i = 0; i < words.size(); ++i) words[i] = value(i);
  }

 private:
  koord::semantics::Team& team_;
};

// Robots whose datagrams come in the order in which they were sent, from one ring.
class Fleet {
 public:
  static constexpr uint32_t kRobots = 4;
  explicit Fleet(Exchange exchange) : program_(kProgram), ring_(1024) {
    for (auto& [to, bytes] : ring_) bytes.reserve(1300);
    for (uint32_t r = 0; r < kRobots; ++r) {
      teams_.push_back(program_.Team(kRobots));
      senses_.push_back(std::make_unique<Steps>(*teams_[r]));
      nodes_.push_back(std::make_unique<koord::node::Node>(*teams_[r], r, senses_[r].get(), 1));
      Settings settings;
      settings.self = r;
      settings.robots = kRobots;
      settings.on_loss = OnLoss::kEvict;
      settings.parts = PartsOf(exchange);
      cores_.push_back(std::make_unique<Core>(settings, *nodes_[r], nullptr, std::nullopt));
    }
  }
  void Until(uint64_t round) {
    for (; cores_[0]->place().round < round; now_ += 1'000'000) {
      for (uint32_t r = 0; r < kRobots; ++r) Step(r, {});
      for (; first_ != end_; ++first_) {
        std::swap(datagram_, ring_[first_ % ring_.size()].second);
        Step(ring_[first_ % ring_.size()].first, datagram_);
      }
    }
  }
  size_t events = 0, acts = 0;

 private:
  void Step(uint32_t robot, View datagram) {
    outputs_.Clear();
    cores_[robot]->Step(now_, datagram, outputs_);
    for (const Output& output : outputs_) {
      if (const auto* send = std::get_if<Send>(&output)) {
        for (uint32_t to = 0; to < kRobots; ++to) {
          if (to == robot || (send->to != kAll && send->to != to)) continue;
          auto& [receiver, bytes] = ring_[end_++ % ring_.size()];
          receiver = to;
          bytes.assign(send->bytes.begin(), send->bytes.end());
        }
      }
      if (std::holds_alternative<Act>(output)) acts += nodes_[robot]->Act().size();
      if (std::holds_alternative<Stored>(output)) {
        for (const auto& event : nodes_[robot]->applied().events) events += event ? 1 : 0;
      }
    }
  }

  koord::node::Compiled program_;
  std::vector<std::unique_ptr<koord::semantics::Team>> teams_;
  std::vector<std::unique_ptr<Steps>> senses_;
  std::vector<std::unique_ptr<koord::node::Node>> nodes_;
  std::vector<std::unique_ptr<Core>> cores_;
  std::vector<std::pair<uint32_t, Bytes>> ring_;
  size_t first_ = 0, end_ = 0;
  Bytes datagram_;
  Outputs outputs_;
  Time now_ = 0;
};

class Allocations : public testing::TestWithParam<Exchange> {};

TEST_P(Allocations, ARoundTakesNoMemory) {
  Fleet fleet(GetParam());
  fleet.Until(3000);
  fleet.events = fleet.acts = 0;
  counting = true;
  fleet.Until(4000);
  counting = false;
  EXPECT_EQ(allocations, 0U);
  allocations = 0;
  EXPECT_GT(fleet.events, 2000U);
  EXPECT_GT(fleet.acts, 500U);
}

RONDO_FOR_EVERY_EXCHANGE(Allocations);

}  // namespace
}  // namespace rondo::runtime::rounds
