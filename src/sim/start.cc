#include "sim/start.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "koord/semantics/machine/values.h"
#include "sim/parameters.h"

namespace rondo::sim {

using diag::Kind;
using koord::VariableKind;
using koord::semantics::Team;

std::unique_ptr<Team> TeamOf(const koord::Model& model, const Fleet& fleet, Functions& functions,
                             diag::Diagnostics& diagnostics) {
  koord::semantics::TeamOptions options;
  Heap heap;  // of the parameters
  options.robots = fleet.robots.size();
  options.hosted = [&](size_t f) { return functions.Knows(f); };
  const size_t before = diagnostics.errors();
  ReadParameters(model, fleet, options, heap, diagnostics);
  std::unique_ptr<Team> team = Team::Make(model, options, diagnostics, std::move(heap));
  if (team == nullptr || diagnostics.errors() != before) return nullptr;
  team->machine().CheckSummaries(true);
  team->machine().SetHost(&functions);
  return team;
}

namespace {

class Starter {
 public:
  Starter(const Beginning& from, diag::Diagnostics& diagnostics)
      : model_(from.model),
        fleet_(from.fleet),
        team_(from.team),
        ports_(from.ports),
        bodies_(from.bodies),
        diagnostics_(diagnostics),
        state_(team_.blank()) {}

  std::optional<std::vector<Word>> State(std::mt19937_64& random) {
    const size_t before = diagnostics_.errors();
    koord::semantics::Machine& machine = team_.machine();
    machine.SetMemory(state_.data());
    machine.SetChooser([&random](uint64_t possibilities) { return random() % possibilities; });
    for (const Port& port : ports_) {
      for (size_t r = 0; r < bodies_.size(); ++r)
        ReadAtRest(model_, port, r, *bodies_[r], team_.heap(), &state_[At(port.variable, r)]);
    }
    if (!Run(team_.declared(), false)) return std::nullopt;
    for (const auto& [name, given] : fleet_.initial) Give(name, given);
    if (diagnostics_.errors() != before) return std::nullopt;
    machine.SetMemory(state_.data());
    if (!Run(team_.derived(), true)) return std::nullopt;
    return std::move(state_);
  }

 private:
  uint32_t At(size_t variable, size_t robot) const { return team_.layout().Address(variable, robot); }

  bool Run(const std::vector<koord::semantics::InitialCode>& code, bool derived) {
    for (const auto& i : code) {
      // What the fleet says comes first; the monitor tells if an assumption says otherwise.
      if (derived && fleet_.initial.contains(model_.variables[i.variable].name)) continue;
      const bool own = model_.variables[i.variable].PerRobot();
      for (size_t r = 0; r < (own ? bodies_.size() : 1); ++r) {
        koord::semantics::Machine& machine = team_.machine();
        if (machine.Run(i.entry, r, false)) continue;
        diagnostics_.Report(Kind::kKoordFault, machine.fault_span(), std::string(Describe(machine.fault())))
            .Under("in an initial value");
        return false;
      }
    }
    return true;
  }

  void Give(const std::string& name, const FleetValue& given) {
    const auto found = std::ranges::find(model_.variables, name, &koord::Variable::name);
    const auto v = static_cast<size_t>(found - model_.variables.begin());
    const bool good = found != model_.variables.end() && found->kind != VariableKind::kSensor &&
                      found->kind != VariableKind::kParam && team_.layout()[v].exists &&
                      team_.layout()[v].length == 0;
    if (!good) {
      diagnostics_.Report(Kind::kFleetValue, given.span,
                          fmt::format("the program has no variable `{}` that can start with a value", name));
      return;
    }
    if (found->initial.valid()) {
      diagnostics_.Report(Kind::kFleetValue, given.span, fmt::format("`{}` has a value already", name))
          .At(found->span, "declared here")
          .Help("proofs are about this value: leave it out here, or declare the variable without one");
      return;
    }
    if (found->PerRobot() && IsForEach(given, v)) return ForEach(name, given, v);
    const auto words = ValueOf(name, given, v);
    for (size_t r = 0; words && r < (found->PerRobot() ? bodies_.size() : 1); ++r)
      std::copy(words->begin(), words->end(), state_.begin() + At(v, r));
  }

  std::optional<std::vector<Word>> ValueOf(const std::string& name, const FleetValue& given,
                                           size_t variable) {
    const koord::Variable& v = model_.variables[variable];
    auto words = koord::semantics::FromJson(model_.types, team_.heap(), v.type, given.value);
    if (!words) {
      auto& report =
          diagnostics_.Report(Kind::kFleetValue, given.span,
                              fmt::format("`{}` must be {}", name, model_.types.WithArticle(v.type)));
      if (v.PerRobot()) {
        report.Help(fmt::format(
            "or a value for each of the {} robots: a list in their order, or a table of their names",
            fleet_.robots.size()));
      }
    }
    return words;
  }

  // Is this no value of the variable, but one for each robot: a list of them in order, or a table of their names?
  bool IsForEach(const FleetValue& given, size_t variable) const {
    Heap scratch;
    if (koord::semantics::FromJson(model_.types, scratch, model_.variables[variable].type, given.value))
      return false;
    if (given.value.is_array()) return given.value.size() == fleet_.robots.size();
    bool all = given.value.is_object() && !given.value.empty();
    if (all) {
      for (const auto& [key, _] : given.value.items())
        all = all && std::ranges::find(fleet_.robots, key, &FleetRobot::name) != fleet_.robots.end();
    }
    return all;
  }

  void ForEach(const std::string& name, const FleetValue& given, size_t variable) {
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
      std::copy(words->begin(), words->end(), state_.begin() + At(variable, r));
    }
  }

  const koord::Model& model_;
  const Fleet& fleet_;
  Team& team_;
  const std::vector<Port>& ports_;
  const std::vector<std::unique_ptr<Body>>& bodies_;
  diag::Diagnostics& diagnostics_;
  std::vector<Word> state_;
};

}  // namespace

std::optional<std::vector<Word>> StateBeforeInit(const Beginning& from, std::mt19937_64& random,
                                                 diag::Diagnostics& diagnostics) {
  return Starter(from, diagnostics).State(random);
}

}  // namespace rondo::sim
