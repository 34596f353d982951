#include "sim/campaign/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/mixed.h"
#include "koord/node/slow_calls.h"
#include "sim/campaign/any_functions.h"
#include "sim/campaign/noise.h"
#include "sim/cores/cores.h"

namespace rondo::sim::campaign {

namespace rounds = runtime::rounds;
using history::Kind;
using koord::semantics::Word;
using rounds::OnLoss;
using rounds::Phase;

namespace {

class World : cores::Robots {
 public:
  World(const Scenario& scenario, std::vector<std::unique_ptr<koord::semantics::Team>>& teams,
        std::vector<std::unique_ptr<koord::node::Node>>& nodes, const history::Image& start)
      : s_(scenario),
        teams_(teams),
        nodes_(nodes),
        start_(start),
        cores_(SetupOf(scenario), *this),
        committed_(scenario.robots) {
    out_.record.robots = s_.robots;
    out_.record.lease = s_.lease;
    out_.record.stop_time = s_.stop_time;
    for (size_t r = 0; r < s_.robots; ++r) {
      noises_.push_back(std::make_unique<Noise>(*teams_[r], s_.seed, cores_.now()));
      any_.push_back(std::make_unique<AnyFunctions>(*teams_[r]));
      functions_.push_back(
          std::make_unique<koord::node::SlowCalls>(*any_[r], *teams_[r], *nodes_[r], cores_.now()));
      teams_[r]->machine().SetHost(functions_[r].get());
    }
  }

  ~World() {
    for (const auto& team : teams_) team->machine().SetHost(nullptr);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Outcome Run() {
    cores_.Start();
    while (!Over() && cores_.Next(cores::kNever)) {
    }
    out_.time = cores_.now();
    out_.datagrams = cores_.datagrams();
    out_.bytes = cores_.bytes();
    Mix(cores_.digest());
    out_.visited.assign(cores_.visited().begin(), cores_.visited().end());
    return std::move(out_);
  }

 private:
  static cores::Setup SetupOf(const Scenario& s) {
    cores::Setup setup;
    setup.settings.robots = static_cast<uint32_t>(s.robots);
    setup.settings.agreement = setup.settings.session = s.seed;
    setup.settings.on_loss = s.on_loss;
    setup.settings.parts = rounds::PartsOf(s.exchange);
    setup.settings.delta = s.delta;
    setup.settings.lease = s.lease;
    setup.settings.stop_time = s.stop_time;
    setup.settings.patience = s.patience;
    setup.disks = s.disks;
    setup.seed = s.seed;
    setup.faults = s.faults;
    return setup;
  }

  void Mix(uint64_t x) { out_.digest = base::Mixed(out_.digest ^ x); }

  history::Entry& Log(uint32_t r, Kind kind, rounds::Place place = {}) {
    const Time now = cores_.now();
    Mix(static_cast<uint64_t>(now) * 64 + static_cast<uint64_t>(kind));
    Mix(place.epoch * 1'000'003 + place.round * 257 + r);
    out_.record.entries.push_back(
        {kind, now, 0, r, cores_.incarnation(r), place.epoch, place.round, 0, cores_.Wall(r)});
    return out_.record.entries.back();
  }

  // -- what happens to robots

  rounds::Program& Begin(uint32_t r) override {
    nodes_[r]->Reset(history::StateOf(*teams_[r], start_), s_.seed);
    nodes_[r]->SetSensors(noises_[r].get());
    functions_[r]->Reset();
    Log(r, Kind::kStarted);
    if (cores_.incarnation(r) > 1) FallBack(r);  // what its actuators do after a crash, nobody knows
    return *nodes_[r];
  }
  void Crashed(uint32_t r) override { Log(r, Kind::kCrashed); }
  void Slows(uint32_t r, Time delay) override { functions_[r]->SetDelay(delay); }
  void On(uint32_t r, const rounds::Output& output) override {
    std::visit([&](const auto& o) { Do(r, o); }, output);
  }

  // -- what cores want

  void Do(uint32_t, const rounds::Send&) {}
  void Do(uint32_t r, const rounds::Act& act) {
    nodes_[r]->Act();
    Log(r, Kind::kActed, act.at).until = cores_.When(r, act.until);
  }
  void Do(uint32_t r, const rounds::FallBack&) { FallBack(r); }
  void FallBack(uint32_t r) {
    const size_t image = out_.record.images.size();
    const bool sets = !nodes_[r]->FallBack(cores_.now()).empty();
    if (sets) out_.record.images.push_back(history::ImageOf(*teams_[r], nodes_[r]->real()));
    Log(r, Kind::kFellBack).what = sets ? image : history::kNothing;
  }
  void Do(uint32_t r, const rounds::Contributed& c) {
    history::Entry& entry = Log(r, Kind::kContributed, c.at);
    entry.what = out_.record.texts.size();
    entry.waits = nodes_[r]->waits();
    out_.record.texts.push_back(c.payload);
  }
  void Do(uint32_t r, const rounds::Stored& stored) {
    const auto [it, fresh] = images_.emplace(stored.digest, out_.record.images.size());
    if (fresh) out_.record.images.push_back(history::ImageOf(*teams_[r], nodes_[r]->state()));
    Log(r, Kind::kStored, stored.at).what = it->second;
  }
  void Do(uint32_t r, const rounds::Committed& c) {
    Log(r, Kind::kCommitted, c.at);
    committed_[r] = std::max(committed_[r], c.at.round);
    out_.rounds = std::max(out_.rounds, c.at.round);
  }
  void Do(uint32_t r, const rounds::Adopted& a) {
    Log(r, Kind::kAdopted, {a.decision.epoch, a.decision.base.round}).what = out_.record.members.size();
    auto& members = out_.record.members.emplace_back();
    for (const auto& m : a.decision.members) members.push_back({m.robot, m.incarnation});
  }
  void Do(uint32_t r, const rounds::Broken& b) { out_.broken = fmt::format("robot {}: {}", r, b.what); }

  // -- the end

  // When everything has to have gone on for three rounds again after the last fault: the leases of those who were
  // given up last have to end before.
  Time Deadline() const { return cores_.quiet() + s_.lease + s_.stop_time + 3 * s_.delta; }

  bool Over() {
    if (!out_.broken.empty() || cores_.forgotten()) return true;
    const Time now = cores_.now();
    if (now <= cores_.quiet()) {
      base_ = out_.rounds;
      return false;
    }
    if (s_.on_loss == OnLoss::kHalt) return OverWithHalt();
    const uint64_t goal = std::max(base_ + 3, s_.rounds);
    uint64_t least = UINT64_MAX;
    for (const uint64_t round : committed_) least = std::min(least, round);
    if (least >= base_ + 3 && out_.recovery == 0) out_.recovery = now - cores_.quiet();
    if (least >= goal) return true;
    if (least >= base_ + 3 || now <= Deadline()) return false;
    size_t voters = 0;
    for (uint32_t r = 0; r < s_.robots; ++r) voters += cores_.core(r)->votes() ? 1 : 0;
    if (2 * voters > s_.robots)
      out_.stuck =
          fmt::format("round {} is not reached by {:.3f} s, {:.3f} s after the last fault", base_ + 3,
                      static_cast<double>(now) * 1e-9, static_cast<double>(now - cores_.quiet()) * 1e-9);
    return true;
  }

  // With `halt`, all go on or all fall back.
  bool OverWithHalt() {
    size_t halted = 0, active = 0;
    for (uint32_t r = 0; r < s_.robots; ++r) {
      halted += cores_.core(r)->phase() == Phase::kHalted ? 1 : 0;
      active += cores_.core(r)->active() ? 1 : 0;
    }
    if (out_.rounds >= std::max(base_ + 3, s_.rounds)) return true;
    if (cores_.now() <= Deadline()) return halted == s_.robots;
    if (active > 0 && (halted > 0 || out_.rounds < base_ + 3))
      out_.stuck = "some robots act and others do not";
    return out_.rounds < base_ + 3 || active == 0;
  }

  const Scenario& s_;
  std::vector<std::unique_ptr<koord::semantics::Team>>& teams_;
  std::vector<std::unique_ptr<koord::node::Node>>& nodes_;
  const history::Image& start_;  // before `init`
  std::vector<std::unique_ptr<Noise>> noises_;
  std::vector<std::unique_ptr<AnyFunctions>> any_;
  std::vector<std::unique_ptr<koord::node::SlowCalls>> functions_;
  cores::Cores cores_;
  std::vector<uint64_t> committed_;  // by robot
  uint64_t base_ = 0;
  std::map<uint64_t, size_t> images_;  // by digest
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
