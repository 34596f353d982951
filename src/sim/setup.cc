#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim/run.h"
#include "sim/start.h"

namespace rondo::sim {

using diag::Kind;
using koord::semantics::RoundExecution;
using nlohmann::json;

bool Run::MakeTeam() {
  team_ = TeamOf(model_, fleet_, functions_, diagnostics_);
  if (team_ == nullptr) return false;
  const auto leave_out = [&](const std::string& name, diag::Span span, const std::string& reason) {
    report_.unchecked.push_back(name);
    diagnostics_.Report(Kind::kKoordNotChecked, span, fmt::format("runs are not checked against `{}`", name))
        .Under(reason);
  };
  for (const auto& part : team_->unchecked()) leave_out(part.name, part.span, part.reason);
  if (options_.network == nullptr) return true;
  const std::string last = "over a network, rounds last as long as they take";
  for (const auto& response : team_->responses()) leave_out(response.name, response.span, last);
  for (const auto& promise : team_->promises()) {
    if (promise.at_end) leave_out(promise.name, promise.span, last);
  }
  return true;
}

bool Run::MakeRobots() {
  for (size_t r = 0; r < fleet_.robots.size(); ++r) {
    const FleetRobot& robot = fleet_.robots[r];
    auto body = robot.make();
    body->Seed(options_.seed * 0x9e3779b97f4a7c15U + 0x51ed2701U * (r + 1));
    body->Place(robot.position, robot.yaw);
    bodies_.push_back(std::move(body));
    noise_.emplace_back(options_.seed * 0x9e3779b97f4a7c15U + r + 1);
    scans_.emplace_back();
    seen_.emplace_back();
  }
  functions_.Attach(*team_, bodies_);
  touches_ = std::make_unique<Touches>(
      fleet_, bodies_, [this](double t, const std::string& a, const std::string& b) {
        recorder_.Event(t, {{"event", "collision"}, {"robot", a}, {"with", b}});
      });
  return true;
}

bool Run::Start() {
  auto before = StateBeforeInit({model_, fleet_, *team_, ports_, bodies_}, random_, diagnostics_);
  if (!before) return false;
  state_ = std::move(*before);
  if (options_.network != nullptr) {
    store_ = std::make_unique<koord::node::Node>(*team_, 0, nullptr, 0);
    store_->Reset(state_, 0);
  }
  // Over a network, `init` is a round that is yet to come; what it leads to is looked at here, too.
  if (!Initialise()) return false;
  monitor_ = std::make_unique<Monitor>(*team_, diagnostics_, [this](const Violation& v, bool first) {
    if (first) recorder_.Event(v.first, {{"event", "violation"}, {"what", v.what}, {"robot", v.robot}});
  });
  Record();
  monitor_->Initially(state_);
  monitor_->Between(0, state_);
  touches_->Observe(0);
  return true;
}

// The blocks of `init`: every robot runs them once, from the declared values.
bool Run::Initialise() {
  if (team_->inits().empty()) return true;
  koord::semantics::Machine& machine = team_->machine();
  std::vector<Word> memory = state_;
  std::vector<RoundExecution::Write> writes;
  for (size_t r = 0; r < bodies_.size(); ++r) {
    std::vector<koord::semantics::Machine::Write> undo;
    for (const uint32_t entry : team_->inits()) {
      machine.SetMemory(memory.data());
      if (!machine.Run(entry, r, false)) {
        diagnostics_.Report(Kind::kKoordFault, machine.fault_span(), std::string(Describe(machine.fault())))
            .Under("in `init`");
        return false;
      }
      undo.insert(undo.end(), machine.writes().begin(), machine.writes().end());
      if (machine.stopped()) writes.push_back({team_->layout().block(r) + team_->layout().stopped(), 1});
    }
    for (const auto& w : undo) writes.push_back({w.at, memory[w.at]});
    for (auto it = undo.rbegin(); it != undo.rend(); ++it) memory[it->at] = it->before;
  }
  for (const auto& w : writes) state_[w.at] = w.value;
  if (options_.network == nullptr) Command(writes, 0);
  return true;
}

void Run::Record() {
  if (!recorder_.on()) return;
  json robots = json::array();
  for (size_t r = 0; r < bodies_.size(); ++r) {
    robots.push_back({{"name", fleet_.robots[r].name},
                      {"model", fleet_.robots[r].model},
                      {"radius", bodies_[r]->radius()}});
  }
  json run{{"format", "rondo-trace/1"},
           {"engine", "simulate"},
           {"program_name", options_.program_name},
           {"program", options_.program},
           {"spec", options_.spec},
           {"fleet", options_.fleet},
           {"seed", options_.seed},
           {"duration", options_.duration},
           {"delta", fleet_.delta},
           {"robots", robots}};
  if (!options_.files.is_null()) run["files"] = options_.files;
  if (options_.network != nullptr) run["network"] = options_.network_text;
  recorder_.Run(run);
  recorder_.World(fleet_);
  for (size_t r = 0; r < bodies_.size(); ++r) recorder_.Pose(0, r, *bodies_[r]);
}

}  // namespace rondo::sim
