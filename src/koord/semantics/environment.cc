#include "koord/semantics/environment.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::koord::semantics {

using lang::TypeKind;

Environment::Environment(Team& team, diag::Diagnostics& diagnostics) : team_(team) {
  const Model& model = team.model();
  memory_.resize(team.layout().words());
  for (size_t v = 0; v < model.variables.size(); ++v) {
    const Variable& variable = model.variables[v];
    if (variable.kind == VariableKind::kParam || !team.layout()[v].exists) continue;
    const bool sensor = variable.kind == VariableKind::kSensor;
    if (sensor) {
      const bool finite =
          model.types.Is(variable.type, TypeKind::kBool) || model.types.Is(variable.type, TypeKind::kEnum);
      if (!finite && !team.choices().contains(v) && !team.given_choices().contains(v)) {
        diagnostics
            .Report(diag::Kind::kKoordNotExecutable, variable.span,
                    fmt::format("nothing says which values `{}` can take", variable.name))
            .Help(fmt::format("declare them: `explore:` and, in the block below, `{} in [...]`",
                              variable.name));
      }
      sensors_.push_back({v, team.layout()[v].at, team.layout()[v].width});
      tuple_ += team.layout()[v].width;
    }
    if (variable.initial.valid() ||
        (!sensor && !team.choices().contains(v) && !team.given_choices().contains(v)))
      continue;
    for (size_t r = 0; r < (variable.PerRobot() ? team.robots() : 1); ++r) starts_.push_back({v, r});
  }
  sets_.resize(team.robots());
  allowed_.resize(team.robots());
}

// The declared values of a variable, one after the other.
bool Environment::Values(size_t v, size_t robot, std::vector<Word>& values) {
  const Model& model = team_.model();
  const auto choice = team_.choices().find(v);
  values.clear();
  if (const auto given = team_.given_choices().find(v); given != team_.given_choices().end()) {
    values = given->second;
    return true;
  }
  if (choice == team_.choices().end()) {
    const lang::Type& type = model.types[model.variables[v].type];
    const size_t count = type.kind == TypeKind::kEnum ? type.fields.size() : 2;
    for (size_t i = 0; i < count; ++i) values.push_back(i);
    return true;
  }
  Machine& machine = team_.machine();
  if (!machine.Run(choice->second, robot, false)) {
    fault_ = machine.fault();
    fault_span_ = machine.fault_span();
    return false;
  }
  const auto items = team_.heap()[machine.result()[0]];
  values.assign(items.begin(), items.end());
  if (!values.empty()) return true;
  fault_ = Fault::kNoValue;
  fault_span_ = model.program->exprs[model.exploration.choices.at(v)].span;
  return false;
}

bool Environment::Allowed(size_t robot, const Word* old, bool over) {
  Machine& machine = team_.machine();
  machine.SetMemory(memory_.data(), old);
  for (const FormulaCode& fact : team_.port_facts()) {
    if (!machine.RunFormula(fact.entry, robot)) return false;
  }
  for (const PromiseCode& promise : team_.promises()) {
    if (promise.at_end && !over) continue;
    if (promise.when != 0) {
      machine.SetMemory(const_cast<Word*>(old), old);  // NOLINT: formulas do not write
      const bool applies = machine.RunFormula(promise.when, robot);
      machine.SetMemory(memory_.data(), old);
      if (!applies) continue;
    }
    if (!machine.RunFormula(promise.always, robot)) return false;
  }
  return true;
}

bool Environment::Move(std::span<const Word> settled, bool over, const Visit& visit) {
  stuck_ = -1;
  old_.assign(settled.begin(), settled.end());
  memory_ = old_;
  team_.machine().SetMemory(memory_.data());
  for (size_t r = 0; r < team_.robots(); ++r) {
    // A robot's assumptions speak of its own ports alone, so robots are independent.
    if (sets_[r].empty()) {
      sets_[r].resize(sensors_.size());
      for (size_t k = 0; k < sensors_.size(); ++k) {
        if (!Values(sensors_[k].variable, r, sets_[r][k])) return true;
      }
    }
    allowed_[r].clear();
    const uint32_t block = team_.layout().block(r);
    const std::function<void(size_t)> choose = [&](size_t k) {
      if (k == sensors_.size()) {
        if (!Allowed(r, old_.data(), over)) return;
        for (const Choice& s : sensors_)
          allowed_[r].insert(allowed_[r].end(), memory_.begin() + block + s.at,
                             memory_.begin() + block + s.at + s.width);
        return;
      }
      const Choice& s = sensors_[k];
      for (size_t i = 0; i + s.width <= sets_[r][k].size(); i += s.width) {
        std::copy_n(sets_[r][k].begin() + static_cast<ptrdiff_t>(i), s.width, memory_.begin() + block + s.at);
        choose(k + 1);
      }
    };
    choose(0);
    std::copy_n(old_.begin() + block, team_.layout().block_words(), memory_.begin() + block);
    if (allowed_[r].empty()) {
      stuck_ = static_cast<int>(r);
      return true;
    }
  }
  return Product(0, visit);
}

bool Environment::Product(size_t robot, const Visit& visit) {
  if (robot == team_.robots()) return visit(memory_);
  const uint32_t block = team_.layout().block(robot);
  for (size_t i = 0; i < allowed_[robot].size(); i += tuple_) {
    size_t at = i;
    for (const Choice& s : sensors_) {
      std::copy_n(allowed_[robot].begin() + static_cast<ptrdiff_t>(at), s.width,
                  memory_.begin() + block + s.at);
      at += s.width;
    }
    if (!Product(robot + 1, visit)) return false;
  }
  return true;
}

bool Environment::Assign(const std::vector<InitialCode>& code) {
  Machine& machine = team_.machine();
  const Model& model = team_.model();
  for (const InitialCode& i : code) {
    for (size_t r = 0; r < (model.variables[i.variable].PerRobot() ? team_.robots() : 1); ++r) {
      if (machine.Run(i.entry, r, false)) continue;
      fault_ = machine.fault();
      fault_span_ = machine.fault_span();
      return false;
    }
  }
  return true;
}

bool Environment::Declared(const Visit& visit) {
  memory_ = team_.blank();
  team_.machine().SetMemory(memory_.data());
  if (!Assign(team_.declared())) return true;
  return Initialise(0, 0, visit);
}

bool Environment::Initialise(size_t index, size_t robot, const Visit& visit) {
  if (index == starts_.size()) {
    const std::vector<Word> before = memory_;
    team_.machine().SetMemory(memory_.data());
    const bool good = Assign(team_.derived());
    const bool more = !good || visit(memory_);
    memory_ = before;
    return more && good;
  }
  const Start& start = starts_[index];
  const Layout::Place& place = team_.layout()[start.variable];
  const uint32_t at = team_.layout().Address(start.variable, start.robot);
  std::vector<Word> values;
  team_.machine().SetMemory(memory_.data());
  if (!Values(start.variable, start.robot, values)) return false;
  for (size_t i = 0; i + place.width <= values.size(); i += place.width) {
    std::copy_n(values.begin() + static_cast<ptrdiff_t>(i), place.width, memory_.begin() + at);
    if (!Initialise(index + 1, robot, visit)) return false;
  }
  std::copy_n(team_.blank().begin() + at, place.width, memory_.begin() + at);
  return true;
}

bool Environment::MayBegin(std::span<const Word> state) {
  std::vector<Word> copy(state.begin(), state.end());
  team_.machine().SetMemory(copy.data());
  const auto holds = [&](const FormulaCode& f) { return team_.Holds(f); };
  return std::all_of(team_.initially().begin(), team_.initially().end(), holds) &&
         std::all_of(team_.port_facts().begin(), team_.port_facts().end(), holds);
}

}  // namespace rondo::koord::semantics
