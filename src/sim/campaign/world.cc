#include "sim/campaign/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "base/mixed.h"
#include "sim/campaign/noise.h"
#include "transport/simulated/clock.h"

namespace rondo::sim::campaign {

namespace rounds = runtime::rounds;
using history::Kind;
using koord::semantics::Word;
using rounds::OnLoss;
using rounds::Phase;
using runtime::codec::Bytes;

namespace {

class MemoryDisk : public rounds::Disk {
 public:
  bool Keep(runtime::codec::View bytes) override {
    if (full) return false;
    record = Bytes(bytes.begin(), bytes.end());
    fresh = true;
    return true;
  }
  std::optional<Bytes> record;
  bool full = false;
  bool fresh = false;  // something was kept since this was last looked at
};

struct Robot {
  transport::simulated::Clock clock;
  std::unique_ptr<rounds::Core> core;
  MemoryDisk disk;
  uint64_t incarnation = 0;
  bool alive = false;
  Time paused_until = 0;
  uint64_t wake = 0;  // which of the wakes that are under way counts
  int crashes = 0;    // faults that keep it away
  uint64_t kept = 0;  // the epoch of which its disk knows
  uint64_t committed = 0;
  Phase phase = Phase::kOutside;
};

class World {
 public:
  World(const Scenario& scenario, std::vector<std::unique_ptr<koord::semantics::Team>>& teams,
        std::vector<std::unique_ptr<koord::node::Node>>& nodes, const history::Image& start)
      : s_(scenario),
        teams_(teams),
        nodes_(nodes),
        start_(start),
        network_(scenario.robots, scenario.seed),
        robots_(scenario.robots) {
    out_.record.robots = s_.robots;
    out_.record.lease = s_.lease;
    out_.record.stop_time = s_.stop_time;
    for (size_t r = 0; r < s_.robots; ++r) {
      const uint64_t x = base::Mixed(s_.seed ^ (r + 1));
      robots_[r].clock = {static_cast<int64_t>(x % 1'000'000'000'000),
                          static_cast<int32_t>((x >> 40) % 200) - 100};
      noises_.push_back(std::make_unique<Noise>(*teams_[r], s_.seed, now_));
    }
    settings_.robots = static_cast<uint32_t>(s_.robots);
    settings_.agreement = settings_.session = s_.seed;
    settings_.on_loss = s_.on_loss;
    settings_.delta = s_.delta;
    settings_.lease = s_.lease;
    settings_.stop_time = s_.stop_time;
    settings_.patience = s_.patience;
  }

  Outcome Run() {
    for (uint32_t r = 0; r < s_.robots; ++r) Start(r);
    for (size_t i = 0; i < s_.faults.size(); ++i) {
      Push(s_.faults[i].at, What::kFaultBegins, static_cast<uint32_t>(i));
      Push(s_.faults[i].at + s_.faults[i].length, What::kFaultEnds, static_cast<uint32_t>(i));
      quiet_ = std::max(quiet_, s_.faults[i].at + s_.faults[i].length);
    }
    while (!events_.empty() && !Over()) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.at;
      Handle(event);
    }
    out_.time = now_;
    out_.datagrams = network_.sent();
    out_.bytes = network_.bytes();
    out_.visited.assign(visited_.begin(), visited_.end());
    return std::move(out_);
  }

 private:
  enum class What : uint8_t { kArrives, kWakes, kFaultBegins, kFaultEnds };
  struct Event {
    Time at;
    uint64_t order;
    What what;
    uint32_t robot;
    uint64_t serial;
    std::shared_ptr<Bytes> bytes;
    bool operator<(const Event& other) const { return std::tie(at, order) > std::tie(other.at, other.order); }
  };

  void Push(Time at, What what, uint32_t robot, uint64_t serial = 0, std::shared_ptr<Bytes> bytes = nullptr) {
    events_.push({at, order_++, what, robot, serial, std::move(bytes)});
  }
  void Mix(uint64_t x) { out_.digest = base::Mixed(out_.digest ^ x); }

  history::Entry& Log(uint32_t r, Kind kind, rounds::Place place = {}) {
    Mix(static_cast<uint64_t>(now_) * 64 + static_cast<uint64_t>(kind));
    Mix(place.epoch * 1'000'003 + place.round * 257 + r);
    out_.record.entries.push_back({kind, now_, 0, r, robots_[r].incarnation, place.epoch, place.round, 0});
    return out_.record.entries.back();
  }

  // -- lives

  void Start(uint32_t r) {
    Robot& robot = robots_[r];
    robot.alive = true;
    ++robot.incarnation;
    nodes_[r]->Reset(history::StateOf(*teams_[r], start_), s_.seed);
    nodes_[r]->SetSensors(noises_[r].get());
    settings_.self = r;
    settings_.incarnation = robot.incarnation;
    std::optional<runtime::codec::View> record;
    if (s_.disks && robot.disk.record) record = *robot.disk.record;
    robot.core =
        std::make_unique<rounds::Core>(settings_, *nodes_[r], s_.disks ? &robot.disk : nullptr, record);
    Log(r, Kind::kStarted);
    Step(r, {});
  }

  void Crash(uint32_t r) {
    Robot& robot = robots_[r];
    if (robot.crashes++ > 0) return;
    robot.alive = false;
    robot.core.reset();
    ++robot.wake;
    Log(r, Kind::kCrashed);
  }

  // When nobody knows any more that there was a session, it is over; what begins then is another one.
  bool Forgotten() const {
    if (out_.rounds == 0 && out_.record.members.empty()) return false;
    return std::ranges::none_of(robots_, [&](const Robot& robot) {
      return (robot.alive && robot.core->place().epoch > 0) || robot.kept > 0;
    });
  }

  void Handle(const Event& event) {
    if (event.what == What::kFaultBegins) return Let(s_.faults[event.robot], true);
    if (event.what == What::kFaultEnds) return Let(s_.faults[event.robot], false);
    Robot& robot = robots_[event.robot];
    if (!robot.alive) return;
    if (now_ < robot.paused_until)
      return Push(robot.paused_until, event.what, event.robot, event.serial, event.bytes);
    if (event.what == What::kWakes && event.serial != robot.wake) return;
    Step(event.robot, event.bytes == nullptr ? runtime::codec::View() : runtime::codec::View(*event.bytes));
  }

  void Step(uint32_t r, runtime::codec::View datagram) {
    Robot& robot = robots_[r];
    outputs_.clear();
    robot.core->Step(robot.clock.At(now_), datagram, outputs_);
    if (std::exchange(robot.disk.fresh, false)) robot.kept = robot.core->place().epoch;
    for (const rounds::Output& output : outputs_) std::visit([&](const auto& o) { Do(r, o); }, output);
    visited_.insert(static_cast<uint64_t>(robot.phase) * kPhases +
                    static_cast<uint64_t>(robot.core->phase()));
    robot.phase = robot.core->phase();
    if (robot.core->wake() == INT64_MAX) return;
    Push(std::max(now_ + 1, robot.clock.When(robot.core->wake())), What::kWakes, r, ++robot.wake);
  }

  // -- what cores want

  void Do(uint32_t r, const rounds::Send& send) {
    for (uint32_t to = 0; to < s_.robots; ++to) {
      if (to == r || (send.to != rounds::kAll && send.to != to)) continue;
      deliveries_.clear();
      network_.Send(now_, r, to, send.bytes, deliveries_);
      for (auto& d : deliveries_)
        Push(d.at, What::kArrives, to, 0, std::make_shared<Bytes>(std::move(d.bytes)));
    }
    Mix(runtime::codec::Sum(send.bytes));
  }
  void Do(uint32_t r, const rounds::Act& act) {
    Log(r, Kind::kActed, act.at).until = robots_[r].clock.When(act.until);
  }
  void Do(uint32_t r, const rounds::FallBack&) { Log(r, Kind::kFellBack); }
  void Do(uint32_t r, const rounds::Contributed& c) {
    Log(r, Kind::kContributed, c.at).what = out_.record.texts.size();
    out_.record.texts.push_back(c.payload);
  }
  void Do(uint32_t r, const rounds::Stored& stored) {
    const auto [it, fresh] = images_.emplace(stored.digest, out_.record.images.size());
    if (fresh) out_.record.images.push_back(history::ImageOf(*teams_[r], nodes_[r]->state()));
    Log(r, Kind::kStored, stored.at).what = it->second;
  }
  void Do(uint32_t r, const rounds::Committed& c) {
    Log(r, Kind::kCommitted, c.at);
    robots_[r].committed = std::max(robots_[r].committed, c.at.round);
    out_.rounds = std::max(out_.rounds, c.at.round);
  }
  void Do(uint32_t r, const rounds::Adopted& a) {
    Log(r, Kind::kAdopted, {a.decision.epoch, a.decision.base.round}).what = out_.record.members.size();
    auto& members = out_.record.members.emplace_back();
    for (const auto& m : a.decision.members) members.push_back({m.robot, m.incarnation});
  }
  void Do(uint32_t r, const rounds::Broken& b) { out_.broken = fmt::format("robot {}: {}", r, b.what); }

  // -- faults

  // Cuts the way from one robot to another, or mends it.
  void Way(uint32_t from, uint32_t to, bool cut) { cut ? network_.Cut(from, to) : network_.Mend(from, to); }

  // Begins a fault, or ends it.
  void Let(const Fault& f, bool begins) {
    auto& c = network_.conditions;
    const double share = begins ? f.amount : 0;
    Robot& robot = robots_[f.robot];
    switch (f.kind) {
      case FaultKind::kLoss:
        c.loss = share;
        break;
      case FaultKind::kDelay: {
        const transport::simulated::Conditions usual;
        c.most = begins ? static_cast<Time>(f.amount * 1e9) : usual.most;
        c.least = begins ? std::min(c.least, c.most) : usual.least;
        break;
      }
      case FaultKind::kDuplicate:
        c.duplicate = share;
        break;
      case FaultKind::kCorrupt:
        c.corrupt = share;
        break;
      case FaultKind::kOneWay:
        Way(f.robot, f.other, begins);
        break;
      case FaultKind::kCut:
        Way(f.robot, f.other, begins);
        Way(f.other, f.robot, begins);
        break;
      case FaultKind::kAlone:
        for (uint32_t r = 0; r < s_.robots; ++r) {
          Way(f.robot, r, begins);
          Way(r, f.robot, begins);
        }
        break;
      case FaultKind::kCrash:
      case FaultKind::kForget:
        if (!begins) {
          if (--robot.crashes == 0) Start(f.robot);
          break;
        }
        if (f.kind == FaultKind::kForget) {
          robot.disk.record.reset();
          robot.kept = 0;
        }
        Crash(f.robot);
        forgotten_ = forgotten_ || Forgotten();
        break;
      case FaultKind::kPause:
        if (begins) robot.paused_until = std::max(robot.paused_until, f.at + f.length);
        break;
      case FaultKind::kDiskFull:
        robot.disk.full = begins;
        break;
    }
  }

  // -- the end

  // When everything has to have gone on for three rounds again after the last fault: the leases of those who were
  // given up last have to end before.
  Time Deadline() const { return quiet_ + s_.lease + s_.stop_time + 3 * s_.delta; }

  bool Over() {
    if (!out_.broken.empty() || forgotten_) return true;
    if (now_ <= quiet_) {
      base_ = out_.rounds;
      return false;
    }
    if (s_.on_loss == OnLoss::kHalt) return OverWithHalt();
    const uint64_t goal = std::max(base_ + 3, s_.rounds);
    uint64_t least = UINT64_MAX;
    for (const Robot& robot : robots_) least = std::min(least, robot.committed);
    if (least >= base_ + 3 && out_.recovery == 0) out_.recovery = now_ - quiet_;
    if (least >= goal) return true;
    if (least >= base_ + 3 || now_ <= Deadline()) return false;
    size_t voters = 0;
    for (const Robot& robot : robots_) voters += robot.core->votes() ? 1 : 0;
    if (2 * voters > s_.robots)
      out_.stuck =
          fmt::format("round {} is not reached by {:.3f} s, {:.3f} s after the last fault", base_ + 3,
                      static_cast<double>(now_) * 1e-9, static_cast<double>(now_ - quiet_) * 1e-9);
    return true;
  }

  // With `halt`, all go on or all fall back.
  bool OverWithHalt() {
    size_t halted = 0, active = 0;
    for (const Robot& robot : robots_) {
      halted += robot.core->phase() == Phase::kHalted ? 1 : 0;
      active += robot.core->active() ? 1 : 0;
    }
    if (out_.rounds >= std::max(base_ + 3, s_.rounds)) return true;
    if (now_ <= Deadline()) return halted == s_.robots;
    if (active > 0 && (halted > 0 || out_.rounds < base_ + 3))
      out_.stuck = "some robots act and others do not";
    return out_.rounds < base_ + 3 || active == 0;
  }

  const Scenario& s_;
  std::vector<std::unique_ptr<koord::semantics::Team>>& teams_;
  std::vector<std::unique_ptr<koord::node::Node>>& nodes_;
  const history::Image& start_;  // before `init`
  transport::simulated::Network network_;
  std::vector<Robot> robots_;
  std::vector<std::unique_ptr<Noise>> noises_;
  rounds::Settings settings_;
  std::priority_queue<Event> events_;
  uint64_t order_ = 0;
  Time now_ = 0;
  Time quiet_ = 0;
  uint64_t base_ = 0;
  bool forgotten_ = false;
  std::vector<rounds::Output> outputs_;
  std::vector<transport::simulated::Delivery> deliveries_;
  std::map<uint64_t, size_t> images_;  // by digest
  std::set<uint64_t> visited_;
  Outcome out_;
};

// The state before `init`: what is declared, what follows from `assume initially`, zero for all else.
std::vector<Word> BeforeInit(koord::semantics::Team& team) {
  std::vector<Word> state = team.blank();
  team.machine().SetMemory(state.data());
  for (const auto* code : {&team.declared(), &team.derived()}) {
    for (const koord::semantics::InitialCode& i : *code) {
      const bool each = team.model().variables[i.variable].PerRobot();
      for (size_t r = 0; r < (each ? team.robots() : 1); ++r) team.machine().Run(i.entry, r, true);
    }
  }
  return state;
}

}  // namespace

Fleet::Size& Fleet::Of(size_t robots) {
  if (sizes_.size() <= robots) sizes_.resize(robots + 1);
  Size& size = sizes_[robots];
  if (!size.teams.empty()) return size;
  for (uint32_t r = 0; r < robots; ++r) {
    size.teams.push_back(make_(robots));
    size.nodes.push_back(std::make_unique<koord::node::Node>(*size.teams.back(), r, nullptr, 0));
  }
  size.start = history::ImageOf(*size.teams[0], BeforeInit(*size.teams[0]));
  return size;
}

Outcome Fleet::Run(const Scenario& scenario) {
  Size& size = Of(scenario.robots);
  return World(scenario, size.teams, size.nodes, size.start).Run();
}

}  // namespace rondo::sim::campaign
