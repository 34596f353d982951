// The cores of three robots, run in every way: each datagram comes at any moment, in any order, or never; timers
// fire at any moment, as if clocks did not matter to each other; robots crash at any moment. (What leases need of
// clocks is an argument of its own: docs/theory.md, "Rounds on robots".)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <unordered_set>

#include "base/mixed.h"
#include "history/explain.h"
#include "history/record.h"
#include "koord/node/compiled_test.h"
#include "koord/node/node.h"
#include "runtime/rounds/core.h"

namespace rondo::runtime::rounds {
namespace {

using koord::semantics::Word;

constexpr uint32_t kRobots = 3;

// Orders and locks show in the store.
constexpr const char* kProgram = R"(
allwrite:
    int last = -1
    int sum = 0
local:
    int n = 0
Add:
    eff:
        atomic:
            sum = 10 * sum + pid + 1
        n = n + 1
Last:
    eff:
        last = pid
)";

struct Memory : Disk {
  bool Keep(View bytes) override {
    if (!full) record = Bytes(bytes.begin(), bytes.end());
    return !full;
  }
  bool full = false;  // until the next life
  std::optional<Bytes> record;
};

// The store of one robot in one of the worlds; all worlds share the node that computes for it, and its heap: nothing in the
// program lives there.
class Store : public Program {
 public:
  explicit Store(koord::node::Node& node) : node_(&node), state_(node.state()) {}
  void Contribute(uint64_t round, Bytes& out) override { Here().Contribute(round, out); }
  bool Accepts(uint32_t robot, View inputs, std::span<const Alternative> all) const override {
    return Here().Accepts(robot, inputs, all);
  }
  void Apply(uint64_t round, std::span<const Turn> turns) override {
    Here().Apply(round, turns);
    state_ = node_->state();
  }
  void Save(Bytes& out) const override { Here().Save(out); }
  bool Load(View bytes) override {
    const bool loaded = Here().Load(bytes);
    state_ = node_->state();
    return loaded;
  }
  const std::vector<Word>& state() const { return state_; }

 private:
  koord::node::Node& Here() const {
    node_->Reset(state_, 1);
    return *node_;
  }
  koord::node::Node* node_;
  std::vector<Word> state_;
};

struct Robot {
  explicit Robot(const Store& s) : store(s) {}
  Robot(const Robot& other)
      : store(other.store),
        disk(other.disk),
        core(other.core == nullptr
                 ? nullptr
                 : std::make_unique<Core>(*other.core, store, other.keeps ? &disk : nullptr)),
        keeps(other.keeps),
        now(other.now),
        life(other.life) {}
  // Sums up everything that decides what it does from now on.
  void Describe() {
    Bytes bytes;
    codec::Writer w(bytes);
    w.Number(life);
    w.Byte(core == nullptr ? 0 : 1);
    if (core != nullptr) core->Describe(bytes);
    store.Save(bytes);
    if (disk.record) w.Block(*disk.record);
    w.Byte(disk.full ? 1 : 0);
    description = codec::Sum(bytes);
  }
  Store store;
  Memory disk;
  std::unique_ptr<Core> core;  // nullptr: it is gone
  bool keeps = false;
  Time now = 0;
  uint64_t life = 0;
  uint64_t description = 0;
};

// What was seen in a run so far, as far as it says what may happen later.
struct Seen {
  std::map<Place, uint64_t> stores;               // digests
  std::map<Place, std::set<uint32_t>> have;       // who stored it
  std::map<uint64_t, std::vector<Member>> teams;  // by epoch
  std::map<std::pair<Place, std::pair<uint32_t, uint64_t>>, uint64_t> said;
  Place acted;  // the newest place on which somebody acted
};

struct World {
  std::vector<std::shared_ptr<const Robot>> robots;
  // All datagrams that were ever sent, by number: each may come at any time, again and again, or never.
  std::vector<uint32_t> flying;
  std::shared_ptr<const Seen> seen = std::make_shared<Seen>();
  int ticks = 0, crashes = 0, full = 0;  // that are left
};

struct Limits {
  int ticks = 3;
  int crashes = 0;
  bool disks = false;
  int full = 0;  // disks that take nothing from some moment on
  OnLoss on_loss = OnLoss::kEvict;
  Exchange exchange = Exchange::kAllToAll;
  uint64_t rounds = 2;
  size_t states = 0;  // 0: all
  Time delta = 0;     // rounds follow each other, so that no timer is needed where nothing is lost
};

class Exploration {
 public:
  explicit Exploration(const Limits& limits)
      : limits_(limits), program_(kProgram), judge_(program_.Team(kRobots)) {
    for (uint32_t r = 0; r < kRobots; ++r) {
      teams_.push_back(program_.Team(kRobots));
      nodes_.push_back(std::make_unique<koord::node::Node>(*teams_.back(), r, nullptr, 1));
      koord::semantics::Machine& machine = teams_[r]->machine();
      std::vector<Word> state = teams_[r]->blank();
      machine.SetMemory(state.data());
      for (const auto& i : teams_[r]->declared()) {
        for (size_t k = 0; k < kRobots; ++k) machine.Run(i.entry, k, true);
      }
      nodes_[r]->Reset(state, 1);
      world_.robots.push_back(std::make_shared<Robot>(Store(*nodes_[r])));
    }
    start_ = nodes_[0]->state();
    for (uint32_t r = 0; r < kRobots; ++r) world_ = Begin(world_, r);
  }

  // Lets everything come in order until all robots have acted on the beginning of a round.
  void Settle(uint64_t round) {
    if (round == 0) return;
    size_t next = 0;
    // Over one robot, some are always ahead: rounds follow each other without a pause here.
    const Phase other = limits_.exchange == Exchange::kAllToAll ? Phase::kCommitted : Phase::kCollecting;
    while (!AllIn(round, other)) {
      if (next < world_.flying.size()) {
        const uint32_t datagram = world_.flying[next++];
        if (auto after = Step(world_, datagrams_[datagram].first, datagram)) world_ = std::move(*after);
        continue;
      }
      uint32_t first = 0;
      for (uint32_t r = 0; r < kRobots; ++r) {
        if (world_.robots[r]->core->wake() < world_.robots[first]->core->wake()) first = r;
      }
      world_ = *Step(world_, first, kTick);
    }
    // What came cannot matter any more; where all wait for the end of the round, neither can what did not.
    const size_t over = AllIn(round, Phase::kCommitted) ? world_.flying.size() : next;
    world_.flying.erase(world_.flying.begin(), world_.flying.begin() + static_cast<ptrdiff_t>(over));
  }

  void Run() {
    world_.ticks = limits_.ticks;
    world_.crashes = limits_.crashes;
    world_.full = limits_.full;
    Visit(world_);
  }

  size_t states() const { return visited_.size(); }
  const std::set<std::string>& wrong() const { return wrong_; }
  uint64_t furthest() const { return furthest_; }
  uint64_t epochs() const { return epochs_; }
  size_t explained() const { return explained_.size(); }
  bool complete() const { return complete_; }

 private:
  bool AllIn(uint64_t round, Phase other) const {
    return std::ranges::all_of(world_.robots, [&](const auto& robot) {
      const Phase phase = robot->core->phase();
      return robot->core->place().round >= round && (phase == Phase::kCommitted || phase == other);
    });
  }

  Settings SettingsOf(uint32_t robot, uint64_t life) const {
    Settings settings;
    settings.self = robot;
    settings.robots = kRobots;
    settings.incarnation = life;
    settings.on_loss = limits_.on_loss;
    settings.parts = PartsOf(limits_.exchange);
    settings.delta = limits_.delta;
    settings.resend = 100;
    settings.lease = settings.patience = 200;
    settings.stop_time = 0;
    settings.drift_ppm = 0;
    return settings;
  }

  // A life begins.
  World Begin(const World& world, uint32_t r) {
    nodes_[r]->Reset(start_, 1);
    auto robot = std::make_shared<Robot>(Store(*nodes_[r]));
    robot->disk = world.robots[r]->disk;
    robot->life = world.robots[r]->life + 1;
    robot->now = world.robots[r]->now;
    robot->disk.full = false;
    robot->keeps = limits_.disks;
    const std::optional<Bytes> kept = limits_.disks ? robot->disk.record : std::nullopt;
    robot->core = std::make_unique<Core>(SettingsOf(r, robot->life), robot->store,
                                         robot->keeps ? &robot->disk : nullptr,
                                         kept ? std::optional(View(*kept)) : std::nullopt);
    World next = world;
    Carry(next, r, Move(std::move(robot), r, kBegin));
    return next;
  }

  static constexpr uint32_t kTick = UINT32_MAX, kBegin = UINT32_MAX - 1;

  // What a robot does with a datagram, or when it wakes up (`kTick`). Robots of one description do the same.
  struct Reaction {
    std::shared_ptr<const Robot> robot;
    std::vector<uint32_t> sends;  // datagrams
    std::vector<Output> outputs;  // all others
  };
  const Reaction& React(const std::shared_ptr<const Robot>& before, uint32_t r, uint32_t datagram) {
    const auto [it, fresh] = reactions_.try_emplace(std::tuple(r, before->description, datagram));
    if (fresh) it->second = Move(std::make_shared<Robot>(*before), r, datagram);
    return it->second;
  }
  Reaction Move(std::shared_ptr<Robot> robot, uint32_t r, uint32_t datagram) {
    Reaction reaction;
    if (datagram == kTick) robot->now = std::max(robot->now, robot->core->wake());
    Outputs outputs;
    const Bytes bytes = datagram >= kBegin ? Bytes() : datagrams_[datagram].second;
    robot->core->Step(robot->now, bytes, outputs);
    robot->Describe();
    for (const Output& output : outputs) {
      if (const auto* send = std::get_if<Send>(&output))
        Number(r, *send, reaction.sends);
      else
        reaction.outputs.push_back(output);
    }
    reaction.robot = std::move(robot);
    return reaction;
  }

  // The world after that; nothing if it changes nothing.
  std::optional<World> Step(const World& world, uint32_t r, uint32_t datagram) {
    const Reaction& reaction = React(world.robots[r], r, datagram);
    const bool same = reaction.robot->description == world.robots[r]->description && datagram != kTick;
    const auto known = [&](uint32_t d) { return std::ranges::binary_search(world.flying, d); };
    if (same && std::ranges::all_of(reaction.sends, known)) return std::nullopt;
    World next = world;
    Carry(next, r, reaction);
    return next;
  }

  void Carry(World& world, uint32_t r, const Reaction& reaction) {
    world.robots[r] = reaction.robot;
    for (const uint32_t d : reaction.sends) {
      const auto at = std::ranges::lower_bound(world.flying, d);
      if (at == world.flying.end() || *at != d) world.flying.insert(at, d);
    }
    if (reaction.outputs.empty()) return;
    Seen seen = *world.seen;
    for (const Output& output : reaction.outputs)
      std::visit([&](const auto& o) { See(seen, *reaction.robot, r, o); }, output);
    world.seen = std::make_shared<Seen>(std::move(seen));
  }

  // Gives a number to a datagram for each of its receivers.
  void Number(uint32_t r, const Send& send, std::vector<uint32_t>& numbers) {
    for (uint32_t to = 0; to < kRobots; ++to) {
      if (to == r || (send.to != kAll && send.to != to)) continue;
      const auto [it, fresh] =
          numbers_.emplace(std::pair(to, send.bytes), static_cast<uint32_t>(datagrams_.size()));
      if (fresh) datagrams_.emplace_back(to, send.bytes);
      numbers.push_back(it->second);
    }
  }

  // -- what must hold

  void Wrong(const std::string& what) { wrong_.insert(what); }

  void See(Seen&, const Robot&, uint32_t, const Send&) {}
  void See(Seen& seen, const Robot& robot, uint32_t r, const Contributed& c) {
    if (!seen.said.emplace(std::pair(c.at, std::pair(r, robot.life)), codec::Sum(c.payload)).second)
      Wrong("a robot says something twice in one round");
  }
  void See(Seen& seen, const Robot& robot, uint32_t r, const Stored& s) {
    const auto [it, fresh] = seen.stores.emplace(s.at, s.digest);
    if (!fresh && it->second != s.digest) Wrong("two stores for one place");
    seen.have[s.at].insert(r);
    furthest_ = std::max(furthest_, s.at.round);
    images_.emplace(s.digest, history::ImageOf(*teams_[r], robot.store.state()));
    if (s.at.round > 0) Explain(seen, s);
  }
  // A round of the program leads to each store: from that of the round before, in this epoch.
  void Explain(const Seen& seen, const Stored& s) {
    const auto before = seen.stores.find({s.at.epoch, s.at.round - 1});
    if (before == seen.stores.end()) return;
    const std::vector<Member>& team = seen.teams.at(s.at.epoch);
    if (!explained_.emplace(before->second, s.digest, team).second) return;
    std::vector<bool> may_skip(kRobots, true);
    for (const Member& m : team) may_skip[m.robot] = false;
    history::Explainer explainer(*judge_);
    const auto state = [&](uint64_t digest) { return history::StateOf(*judge_, images_.at(digest)); };
    if (!explainer.Explain(state(before->second), state(s.digest), s.at.round == 1, may_skip))
      Wrong("no round of the program leads there");
  }
  void See(Seen& seen, const Robot&, uint32_t, const Committed& c) {
    if (2 * seen.have[c.at].size() <= kRobots) Wrong("final without a majority");
  }
  void See(Seen& seen, const Robot&, uint32_t, const Act& act) {
    if (2 * seen.have[act.at].size() <= kRobots) Wrong("acts without a majority");
    if (act.at.epoch >= seen.acted.epoch && act.at.round + 1 < seen.acted.round)
      Wrong("acts on an old round");
    seen.acted = std::max(seen.acted, act.at);
  }
  void See(Seen&, const Robot&, uint32_t, const FallBack&) {}
  void See(Seen& seen, const Robot&, uint32_t, const Adopted& a) {
    const Decision& d = a.decision;
    const auto [it, fresh] = seen.teams.emplace(d.epoch, d.members);
    if (!fresh && it->second != d.members) Wrong("two decisions on one epoch");
    if (fresh && d.epoch > 1 && d.base < seen.acted) Wrong("a round on which somebody acted is lost");
    epochs_ = std::max(epochs_, d.epoch);
  }
  void See(Seen&, const Robot&, uint32_t, const Broken& b) { Wrong(b.what); }

  // -- the search

  // A number for the world; two worlds of one number are taken for the same.
  uint64_t Digest(const World& world) const {
    Bytes bytes;
    codec::Writer w(bytes);
    for (const auto& robot : world.robots) w.Fixed(robot->description);
    for (const uint32_t datagram : world.flying) w.Number(datagram);
    for (const auto& [place, digest] : world.seen->stores) w.Fixed(digest);
    for (const auto& [place, robots] : world.seen->have) {
      for (const uint32_t r : robots) w.Number(r);
    }
    codec::Write(w, world.seen->acted);
    w.Number(static_cast<uint64_t>(world.ticks));
    w.Number(static_cast<uint64_t>(world.crashes));
    w.Number(static_cast<uint64_t>(world.full));
    return codec::Sum(bytes);
  }

  void Visit(const World& world) {
    if (limits_.states != 0 && visited_.size() >= limits_.states) {
      complete_ = false;
      return;
    }
    if (!wrong_.empty() || !visited_.insert(Digest(world)).second) return;
    for (const uint32_t datagram : world.flying) {
      const uint32_t to = datagrams_[datagram].first;
      const Robot& robot = *world.robots[to];
      if (robot.core == nullptr || robot.core->place().round > limits_.rounds) continue;
      if (const auto next = Step(world, to, datagram)) Visit(*next);
    }
    for (uint32_t r = 0; r < kRobots; ++r) {
      const Robot& robot = *world.robots[r];
      if (robot.core == nullptr) {
        Visit(Begin(world, r));
        continue;
      }
      if (world.ticks > 0 && robot.core->wake() != INT64_MAX && robot.core->place().round <= limits_.rounds) {
        World next = *Step(world, r, kTick);
        --next.ticks;
        Visit(next);
      }
      if (world.full > 0 && !robot.disk.full) {
        World next = world;
        --next.full;
        auto full = std::make_shared<Robot>(robot);
        full->disk.full = true;
        full->Describe();
        next.robots[r] = std::move(full);
        Visit(next);
      }
      if (world.crashes == 0) continue;
      World next = world;
      --next.crashes;
      auto gone = std::make_shared<Robot>(robot);
      gone->core.reset();
      gone->Describe();
      next.robots[r] = std::move(gone);
      Visit(next);
    }
  }

  const Limits limits_;
  koord::node::Compiled program_;
  std::unique_ptr<koord::semantics::Team> judge_;
  std::vector<std::unique_ptr<koord::semantics::Team>> teams_;
  std::vector<std::unique_ptr<koord::node::Node>> nodes_;
  std::vector<Word> start_;
  World world_;
  std::vector<std::pair<uint32_t, Bytes>> datagrams_;
  std::map<std::pair<uint32_t, Bytes>, uint32_t> numbers_;
  std::map<std::tuple<uint32_t, uint64_t, uint32_t>, Reaction> reactions_;
  std::unordered_set<uint64_t> visited_;
  std::map<uint64_t, history::Image> images_;
  std::set<std::tuple<uint64_t, uint64_t, std::vector<Member>>> explained_;
  std::set<std::string> wrong_;
  uint64_t furthest_ = 0, epochs_ = 0;
  bool complete_ = true;
};

// How many worlds are looked at, at most; nightly runs set RONDO_STATES.
size_t MostStates() {
  const char* states = std::getenv("RONDO_STATES");
  return states == nullptr ? 60'000 : std::strtoull(states, nullptr, 10);
}

void Explore(Limits limits, uint64_t from, const char* what) {
  limits.states = MostStates();
  Exploration exploration(limits);
  exploration.Settle(from);
  exploration.Run();
  fmt::print("{}: {} worlds{}, up to round {} and epoch {}, {} rounds explained\n", what,
             exploration.states(), exploration.complete() ? "" : " (not all)", exploration.furthest(),
             exploration.epochs(), exploration.explained());
  EXPECT_TRUE(exploration.wrong().empty()) << *exploration.wrong().begin();
  EXPECT_GT(exploration.furthest(), from);
}

TEST(Exhaustive, TwoRounds) {
  Limits limits;
  limits.ticks = 1;
  Explore(limits, 1, "two rounds, a timer");
}

TEST(Exhaustive, TwoRoundsOverASequencer) {
  Limits limits;
  limits.ticks = 1;
  limits.exchange = Exchange::kSequencer;
  Explore(limits, 1, "two rounds over a sequencer, a timer");
}

TEST(Exhaustive, ACrashWithASequencer) {
  Limits limits;
  limits.ticks = 1;
  limits.crashes = 1;
  limits.exchange = Exchange::kSequencer;
  Explore(limits, 1, "a crash with a sequencer, without disks");
}

TEST(Exhaustive, TwoRoundsOverAServer) {
  Limits limits;
  limits.ticks = 2;
  limits.exchange = Exchange::kCentral;
  Explore(limits, 1, "two rounds over a server, two timers");
}

// Who waits for the end of a round begins with the first who does.
TEST(Exhaustive, TwoRoundsWithAPauseBetweenThem) {
  Limits limits;
  limits.ticks = 3;
  limits.delta = 50;
  Explore(limits, 1, "two rounds with a pause, three timers");
}

TEST(Exhaustive, TwoRoundsWithMoreTimers) {
  Limits limits;
  limits.ticks = 3;
  Explore(limits, 1, "two rounds, three timers");
}

TEST(Exhaustive, ACrashWithADisk) {
  Limits limits;
  limits.ticks = 1;
  limits.crashes = 1;
  limits.disks = true;
  Explore(limits, 1, "a crash, with disks");
}

TEST(Exhaustive, ACrashAfterItsDiskIsFull) {
  Limits limits;
  limits.ticks = 1;
  limits.crashes = 1;
  limits.disks = true;
  limits.full = 1;
  Explore(limits, 1, "a crash, with a full disk");
}

TEST(Exhaustive, ACrashWithoutADisk) {
  Limits limits;
  limits.ticks = 1;
  limits.crashes = 1;
  Explore(limits, 1, "a crash, without disks");
}

TEST(Exhaustive, TheFirstEpoch) {
  Limits limits;
  limits.ticks = 2;
  limits.rounds = 0;
  Explore(limits, 0, "the first epoch");
}

}  // namespace
}  // namespace rondo::runtime::rounds
