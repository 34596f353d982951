#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "koord/semantics/machine/values.h"
#include "sim/parameters.h"
#include "sim/run.h"

namespace rondo::sim {

using diag::Kind;
using koord::semantics::FromFloat;
using koord::semantics::RoundExecution;
using koord::semantics::Team;
using nlohmann::json;

std::optional<std::vector<Word>> Run::ValueOf(const std::string& name, const FleetValue& given,
                                              size_t variable) {
  auto words =
      koord::semantics::FromJson(model_.types, team_->heap(), model_.variables[variable].type, given.value);
  if (!words) {
    auto& report = diagnostics_.Report(
        Kind::kFleetValue, given.span,
        fmt::format("`{}` must be a `{}`", name, model_.types.Name(model_.variables[variable].type)));
    if (model_.variables[variable].PerRobot())
      report.Help(fmt::format(
          "or a value for each of the {} robots: a list in their order, or a table of their names",
          fleet_.robots.size()));
  }
  return words;
}

// Is this no value of the variable, but one for each robot: a list of them in order, or a table of their names?
bool Run::IsForEach(const FleetValue& given, size_t variable) const {
  koord::semantics::Heap scratch;
  if (koord::semantics::FromJson(model_.types, scratch, model_.variables[variable].type, given.value))
    return false;
  if (given.value.is_array()) return given.value.size() == fleet_.robots.size();
  const auto named = [&](const std::string& name) {
    return std::ranges::any_of(fleet_.robots, [&](const FleetRobot& robot) { return robot.name == name; });
  };
  bool all = given.value.is_object() && !given.value.empty();
  if (all) {
    for (const auto& [key, _] : given.value.items()) all = all && named(key);
  }
  return all;
}

void Run::ForEach(const std::string& name, const FleetValue& given, size_t variable) {
  for (size_t r = 0; r < fleet_.robots.size(); ++r) {
    const std::string& robot = fleet_.robots[r].name;
    if (given.value.is_object() && !given.value.contains(robot)) {
      diagnostics_.Report(Kind::kFleetValue, given.span,
                          fmt::format("`{}` has no value for `{}`", name, robot));
      return;
    }
    FleetValue one = given;
    one.value = given.value.is_object() ? given.value[robot] : given.value[r];
    const auto words = ValueOf(fmt::format("{} of {}", name, robot), one, variable);
    if (!words) return;
    std::copy(words->begin(), words->end(), state_.begin() + team_->layout().Address(variable, r));
  }
}

int Run::Find(const std::string& name) const {
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (model_.variables[v].name == name) return static_cast<int>(v);
  }
  return -1;
}

std::unique_ptr<Team> Run::NewTeam(Functions& functions) {
  koord::semantics::TeamOptions options;
  Heap heap;  // of the parameters
  options.robots = fleet_.robots.size();
  options.hosted = [&](size_t f) { return functions.Knows(f); };
  const size_t before = diagnostics_.errors();
  ReadParameters(model_, fleet_, options, heap, diagnostics_);
  std::unique_ptr<Team> team = Team::Make(model_, options, diagnostics_, std::move(heap));
  if (team == nullptr || diagnostics_.errors() != before) return nullptr;
  team->machine().CheckSummaries(true);
  team->machine().SetHost(&functions);
  return team;
}

bool Run::MakeTeam() {
  team_ = NewTeam(functions_);
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
  std::vector<double> radii;
  for (size_t r = 0; r < fleet_.robots.size(); ++r) {
    const FleetRobot& robot = fleet_.robots[r];
    auto body = robot.make();
    body->Seed(options_.seed * 0x9e3779b97f4a7c15U + 0x51ed2701U * (r + 1));
    body->Place(robot.position, robot.yaw);
    radii.push_back(body->radius());
    bodies_.push_back(std::move(body));
    noise_.emplace_back(options_.seed * 0x9e3779b97f4a7c15U + r + 1);
    scans_.emplace_back();
    seen_.emplace_back();
  }
  functions_.Attach(*team_, bodies_);
  contacts_ = std::make_unique<Contacts>(fleet_.world, radii);
  return true;
}

// The state before `init`: what sensors read, what is declared, what the fleet says, what follows from
// `assume initially`.
bool Run::BeforeInit() {
  const size_t before = diagnostics_.errors();
  state_ = team_->blank();
  Sense();
  koord::semantics::Machine& machine = team_->machine();
  machine.SetMemory(state_.data());
  machine.SetChooser([this](uint64_t possibilities) { return random_() % possibilities; });
  // A robot holds its position until it is told something else.
  for (size_t r = 0; r < bodies_.size(); ++r) {
    const Point p = bodies_[r]->position();
    for (const Port& port : ports_) {
      if (port.own[r] && IsActuator(port)) Sense(port, r, team_->heap(), &state_[At(port, r)]);
      if (port.role == PortRole::kPath) state_[At(port, r)] = EncodePath(team_->heap(), {p});
      if (port.role == PortRole::kTarget) {
        for (size_t i = 0; i < 3; ++i) state_[At(port, r) + i] = FromFloat(p[i] + 0.0);
      }
    }
  }
  const auto run = [&](const std::vector<koord::semantics::InitialCode>& code, bool derived) {
    for (const auto& i : code) {
      // What the fleet says comes first; the monitor tells if an assumption says otherwise.
      if (derived && fleet_.initial.contains(model_.variables[i.variable].name)) continue;
      const bool own = model_.variables[i.variable].PerRobot();
      for (size_t r = 0; r < (own ? bodies_.size() : 1); ++r) {
        if (machine.Run(i.entry, r, false)) continue;
        diagnostics_.Report(Kind::kKoordFault, machine.fault_span(), std::string(Describe(machine.fault())))
            .Under("in an initial value");
        return false;
      }
    }
    return true;
  };
  if (!run(team_->declared(), false)) return false;
  for (const auto& [name, given] : fleet_.initial) {
    const int found = Find(name);
    const auto v = static_cast<size_t>(found);
    const bool good = found >= 0 && model_.variables[v].kind != koord::VariableKind::kSensor &&
                      model_.variables[v].kind != koord::VariableKind::kParam && team_->layout()[v].exists &&
                      team_->layout()[v].length == 0;
    if (!good) {
      diagnostics_.Report(Kind::kFleetValue, given.span,
                          fmt::format("the program has no variable `{}` that can start with a value", name));
      continue;
    }
    if (model_.variables[v].initial.valid()) {
      diagnostics_.Report(Kind::kFleetValue, given.span, fmt::format("`{}` has a value already", name))
          .At(model_.variables[v].span, "declared here")
          .Help("proofs are about this value: leave it out here, or declare the variable without one");
      continue;
    }
    if (model_.variables[v].PerRobot() && IsForEach(given, v)) {
      ForEach(name, given, v);
      continue;
    }
    const auto words = ValueOf(name, given, v);
    for (size_t r = 0; words && r < (model_.variables[v].PerRobot() ? bodies_.size() : 1); ++r)
      std::copy(words->begin(), words->end(), state_.begin() + team_->layout().Address(v, r));
  }
  if (diagnostics_.errors() != before) return false;
  machine.SetMemory(state_.data());
  return run(team_->derived(), true);
}

bool Run::Start() {
  if (!BeforeInit()) return false;
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
  Observe(0);
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
