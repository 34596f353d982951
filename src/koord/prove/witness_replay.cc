#include "koord/prove/witness_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfenv>
#include <charconv>

#include "koord/semantics/environment.h"
#include "koord/semantics/program_transition.h"

namespace rondo::koord {
using lang::TypeKind;
using semantics::Word;

bool ToWords(const lang::TypeTable& types, TypeId id, const expr::Value& value, std::vector<Word>& words) {
  const lang::Type& type = types[id];
  switch (type.kind) {
    case TypeKind::kBool:
      if (!value.IsBool()) return false;
      words.push_back(value.AsBool());
      return true;
    case TypeKind::kInt: {
      if (!value.IsNumber() || !value.AsNumber().IsInteger()) return false;
      const std::string digits = value.AsNumber().ToString();
      int64_t number = 0;
      const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
      if (problem != std::errc() || end != digits.data() + digits.size()) return false;
      words.push_back(semantics::FromInt(number));
      return true;
    }
    case TypeKind::kFloat: {
      if (!value.IsNumber()) return false;
      const double number = value.AsNumber().ToDouble();
      if (!(expr::Rational::FromDouble(number) == value.AsNumber())) return false;
      words.push_back(semantics::FromFloat(number + 0.0));
      return true;
    }
    case TypeKind::kEnum: {
      const auto* name = std::get_if<std::string>(&value.data);
      for (size_t i = 0; name != nullptr && i < type.fields.size(); ++i) {
        if (*name != type.fields[i]) continue;
        words.push_back(i);
        return true;
      }
      return false;
    }
    case TypeKind::kRecord:
    case TypeKind::kTuple: {
      const auto* fields = std::get_if<expr::Value::Fields>(&value.data);
      if (fields == nullptr || fields->size() != type.parts.size()) return false;
      for (size_t i = 0; i < fields->size(); ++i) {
        if (!ToWords(types, type.parts[i], (*fields)[i], words)) return false;
      }
      return true;
    }
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kString:
    case TypeKind::kStream:
    case TypeKind::kArray:
    case TypeKind::kList:
    case TypeKind::kOpaque:
      break;
  }
  return false;
}

namespace {

class Replay {
 public:
  Replay(const Model& model, size_t invariant, const WitnessState& witness)
      : model_(model), invariant_(invariant), witness_(witness) {}

  WitnessReplay Run() {
    std::feclearexcept(FE_ALL_EXCEPT);
    if (!Read()) return {ReplayOutcome::kNotPossible, why_};
    WitnessReplay result = Compare();
    if (result.outcome != ReplayOutcome::kDiffers) return result;
    // A difference that rounding or an arbitrary value explains is none.
    if (std::fetestexcept(FE_INEXACT) != 0 || team_->rounds_literals())
      return {ReplayOutcome::kNotPossible, "doubles are rounded in it"};
    if (undefined_) return {ReplayOutcome::kNotPossible, "an operation in a formula has no value"};
    return result;
  }

 private:
  WitnessReplay Compare() {
    if (witness_.initial) {
      if (Holds(start_, invariant_)) return Differs("the invariant holds");
      return {ReplayOutcome::kReplayed, ""};
    }
    for (size_t i = 0; i < team_->invariants().size(); ++i) {
      if (!Holds(start_, i))
        return Differs(fmt::format("its start violates `{}`", team_->invariants()[i].name));
    }
    if (Holds(end_, invariant_)) return Differs("the invariant holds at its end");
    return Round();
  }

  static WitnessReplay Differs(std::string why) { return {ReplayOutcome::kDiffers, std::move(why)}; }

  bool Refuse(std::string why) {
    why_ = std::move(why);
    return false;
  }

  bool Read() {
    semantics::TeamOptions options;
    options.robots = static_cast<size_t>(witness_.robots);
    for (const WitnessState::Value& value : witness_.values) {
      const Variable& variable = model_.variables[value.variable];
      if (variable.kind != VariableKind::kParam) continue;
      std::vector<Word> words;
      if (!ToWords(model_.types, variable.type, value.start, words))
        return Refuse(fmt::format("`{}` has a value that no run can have", variable.name));
      options.params[value.variable] = words;
    }
    diag::Diagnostics ignored;
    team_ = semantics::Team::Make(model_, options, ignored);
    if (team_ == nullptr) return Refuse("the program uses functions without a body");
    if (!team_->unchecked().empty())
      return Refuse(fmt::format("`{}` cannot be evaluated", team_->unchecked()[0].name));
    start_.assign(team_->layout().words(), 0);
    end_ = start_;
    std::vector<bool> known(start_.size());
    for (const WitnessState::Value& value : witness_.values) {
      const Variable& variable = model_.variables[value.variable];
      if (variable.kind == VariableKind::kParam) continue;
      if (variable.PerRobot() && (value.robot < 0 || value.robot >= witness_.robots))
        return Refuse("a robot has no number");
      const uint32_t at =
          team_->layout().Address(value.variable, static_cast<size_t>(std::max<int64_t>(0, value.robot)));
      std::vector<Word> words;
      std::vector<Word> after;
      if (!ToWords(model_.types, variable.type, value.start, words) ||
          (value.end && !ToWords(model_.types, variable.type, *value.end, after)))
        return Refuse(fmt::format("`{}` has a value that no run can have", variable.name));
      if (!value.end) after = words;
      std::copy(words.begin(), words.end(), start_.begin() + at);
      std::copy(after.begin(), after.end(), end_.begin() + at);
      std::fill_n(known.begin() + at, words.size(), true);
    }
    for (const int64_t r : witness_.stopped) {
      if (r < 0 || r >= witness_.robots) return Refuse("a robot has no number");
      start_[team_->layout().block(static_cast<size_t>(r)) + team_->layout().stopped()] = 1;
    }
    for (size_t r = 0; r < team_->robots(); ++r)
      known[team_->layout().block(r) + team_->layout().stopped()] = true;
    if (!std::all_of(known.begin(), known.end(), [](bool k) { return k; }))
      return Refuse("the counterexample does not give every value");
    return true;
  }

  bool Holds(std::vector<Word>& state, size_t invariant) {
    team_->machine().SetMemory(state.data());
    bool defined = true;
    const bool holds = team_->Holds(team_->invariants()[invariant], nullptr, &defined);
    undefined_ = undefined_ || !defined;
    return holds;
  }

  // Is the end one of the states in which this round, or a part of its robots, can leave the team?
  WitnessReplay Round() {
    semantics::ProgramTransition transition(*team_);
    transition.Prepare(start_);
    const semantics::Layout& layout = team_->layout();
    std::vector<bool> sensor(start_.size());
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].kind != VariableKind::kSensor || !layout[v].exists) continue;
      for (size_t r = 0; r < team_->robots(); ++r)
        std::fill_n(sensor.begin() + layout.Address(v, r), layout[v].width, true);
    }
    for (size_t r = 0; r < team_->robots(); ++r) sensor[layout.block(r) + layout.stopped()] = true;
    std::vector<Word> settled;
    transition.Enumerate([&](std::span<const Word> state, bool complete) {
      if (witness_.moved && !complete) return true;
      for (size_t i = 0; i < state.size(); ++i) {
        if (!sensor[i] && state[i] != end_[i]) return true;
      }
      settled.assign(state.begin(), state.end());
      return false;
    });
    if (settled.empty()) return Differs("no choice of events and last writers leads to its end");
    for (size_t r = 0; r < team_->robots(); ++r) {
      const uint32_t stopped = layout.block(r) + layout.stopped();
      end_[stopped] = settled[stopped];
    }
    if (!witness_.moved) {
      return settled == end_ ? WitnessReplay{ReplayOutcome::kReplayed, ""}
                             : Differs("sensors differ although the environment did not move");
    }
    semantics::Machine& machine = team_->machine();
    for (size_t r = 0; r < team_->robots(); ++r) {
      machine.SetMemory(end_.data(), settled.data());
      for (const semantics::FormulaCode& fact : team_->port_facts()) {
        if (!machine.RunFormula(fact.entry, r)) return Differs(fmt::format("`{}` is violated", fact.name));
      }
      for (const semantics::PromiseCode& promise : team_->promises()) {
        machine.SetMemory(settled.data(), settled.data());
        if (promise.when != 0 && !machine.RunFormula(promise.when, r)) continue;
        machine.SetMemory(end_.data(), settled.data());
        if (!machine.RunFormula(promise.always, r))
          return Differs(fmt::format("`{}` is violated", promise.name));
      }
    }
    return {ReplayOutcome::kReplayed, ""};
  }

  const Model& model_;
  size_t invariant_;
  const WitnessState& witness_;
  std::unique_ptr<semantics::Team> team_;
  std::vector<Word> start_;
  std::vector<Word> end_;
  std::string why_;
  bool undefined_ = false;
};

}  // namespace

WitnessReplay ReplayWitness(const Model& model, size_t invariant, const WitnessState& witness) {
  if (witness.robots < 1 || witness.robots > 64)
    return {ReplayOutcome::kNotPossible, "the team is too large"};
  return Replay(model, invariant, witness).Run();
}

}  // namespace rondo::koord
