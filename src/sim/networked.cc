#include "sim/networked.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "sim/choice.h"

namespace rondo::sim {

namespace rounds = runtime::rounds;
using cores::Nanoseconds;
using koord::semantics::Effect;

cores::Setup Networked::SetupOf(const Fleet& fleet, const SimulationOptions& options) {
  cores::Setup setup;
  setup.settings = SettingsOf(fleet);
  setup.settings.agreement = setup.settings.session = options.seed;
  setup.disks = fleet.rounds.disks;
  setup.seed = options.seed;
  setup.conditions = options.network->conditions;
  setup.faults = options.network->faults;
  return setup;
}

Networked::Networked(const koord::Model& model, const Fleet& fleet, const SimulationOptions& options,
                     const std::vector<std::unique_ptr<Body>>& bodies, const MakeTeam& make,
                     diag::Diagnostics& diagnostics, Stage& stage)
    : fleet_(fleet),
      options_(options),
      stage_(stage),
      machines_(fleet.robots.size()),
      cores_(SetupOf(fleet, options), *this) {
  for (uint32_t r = 0; r < machines_.size(); ++r) {
    Machine& m = machines_[r];
    m.functions = std::make_unique<Functions>(model, fleet, options.seed);
    m.team = make(*m.functions);
    CHECK(m.team != nullptr) << "a program that was compiled once is not compiled again";
    m.functions->Attach(*m.team, bodies);
    m.senses = std::make_unique<Senses>(stage_, m.team->heap());
    m.node = std::make_unique<koord::node::Node>(*m.team, r, m.senses.get(), options.seed);
    m.node->SetChoose([this](uint64_t round, size_t robot, std::span<const Effect> effects) {
      return Choose(fleet_, options_.seed, round, robot, effects);
    });
    m.calls = std::make_unique<koord::node::SlowCalls>(*m.functions, *m.team, *m.node, cores_.now());
    m.team->machine().SetHost(m.calls.get());
    m.monitor = std::make_unique<Monitor>(*m.team, diagnostics, [](const Violation&, bool) {});
  }
}

void Networked::Start(runtime::codec::Bytes store) {
  store_ = std::move(store);
  cores_.Start();
}

void Networked::Until(double time) {
  const cores::Time until = Nanoseconds(time);
  while (broken_.empty() && cores_.Next(until)) {
  }
}

uint64_t Networked::plans() const {
  uint64_t plans = 0;
  for (const Machine& m : machines_) plans += m.functions->plans();
  return plans;
}

std::vector<Violation> Networked::violations() const {
  std::vector<Violation> all;
  for (const Machine& m : machines_)
    all.insert(all.end(), m.monitor->violations().begin(), m.monitor->violations().end());
  return all;
}

NetworkReport Networked::Report() {
  report_.datagrams = cores_.datagrams();
  report_.bytes = cores_.bytes();
  std::ranges::sort(report_.waits);
  return std::move(report_);
}

rounds::Program& Networked::Begin(uint32_t r) {
  Machine& m = machines_[r];
  m.node->Reset(m.team->blank(), options_.seed);
  m.node->Load(store_);
  m.calls->Reset();
  m.contributed = {};
  m.acted = 0;
  if (cores_.incarnation(r) > 1) {
    Happens(static_cast<int>(r), "starts again");
    FallBack(r);  // what its actuators do after a crash, nobody knows
  }
  return *m.node;
}

void Networked::Slows(uint32_t r, cores::Time delay) { machines_[r].calls->SetDelay(delay); }

void Networked::Crashed(uint32_t r) { Happens(static_cast<int>(r), "crashes"); }

void Networked::Happens(int robot, const std::string& what) {
  report_.happenings.push_back({now(), robot, what});
  stage_.Happens(robot, what);
}

void Networked::On(uint32_t r, const rounds::Output& output) {
  std::visit([&](const auto& o) { Do(r, o); }, output);
}

void Networked::Do(uint32_t, const rounds::Send&) {}
void Networked::Do(uint32_t, const rounds::Stored&) {}

void Networked::Do(uint32_t r, const rounds::Contributed& c) {
  Machine& m = machines_[r];
  m.contributed = c.at;
  m.contributed_at = cores_.now();
  m.functions->TakeLog();  // what is said counts when the round is final (`Applied::said`)
  m.monitor->Summary(now());
  if (m.node->failed()) stage_.Fails(r, *m.node->failed());
  stage_.Contributed(r);
}

void Networked::Do(uint32_t r, const rounds::Committed& c) {
  Machine& m = machines_[r];
  if (m.contributed.epoch == c.at.epoch && m.contributed.round + 1 == c.at.round)
    report_.waits.push_back(cores::Seconds(cores_.now() - m.contributed_at));
  if (c.at.round <= committed_) return;
  committed_ = c.at.round;
  stage_.Committed(committed_, *m.node);
}

void Networked::Do(uint32_t r, const rounds::Act& act) {
  Machine& m = machines_[r];
  if (act.at.round <= m.acted) return;
  m.acted = act.at.round;
  stage_.Acts(r, m.team->heap(), *m.node, m.node->Act());
}

void Networked::Do(uint32_t r, const rounds::FallBack&) {
  ++report_.fallbacks;
  Happens(static_cast<int>(r), "falls back");
  FallBack(r);
}

void Networked::FallBack(uint32_t r) {
  Machine& m = machines_[r];
  stage_.FallsBack(r, *m.node, m.node->FallBack(m.acted));
}

void Networked::Do(uint32_t, const rounds::Adopted& adopted) {
  if (adopted.decision.epoch <= epoch_) return;
  epoch_ = adopted.decision.epoch;
  report_.epochs = epoch_;
  std::vector<std::string> names;
  for (const auto& member : adopted.decision.members) names.push_back(fleet_.robots[member.robot].name);
  if (epoch_ > 1 || names.size() < fleet_.robots.size())
    Happens(-1, fmt::format("the team is {}", fmt::join(names, ", ")));
}

void Networked::Do(uint32_t r, const rounds::Broken& broken) {
  broken_ = broken.what;
  Happens(static_cast<int>(r), broken_);
}

}  // namespace rondo::sim
