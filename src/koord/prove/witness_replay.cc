#include "koord/prove/witness_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfenv>
#include <charconv>

#include "koord/semantics/environment.h"
#include "koord/semantics/fallback.h"
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

  std::vector<bool> AtStart() {
    std::vector<bool> holds;
    lenient_ = true;
    if (!Read()) return holds;
    for (size_t i = 0; i < team_->invariants().size(); ++i) holds.push_back(Holds(start_, i));
    return holds;
  }

 private:
  WitnessReplay Compare() {
    if (witness_.of == WitnessOf::kInitial) {
      if (Holds(start_, invariant_)) return Differs("the invariant holds");
      return {ReplayOutcome::kReplayed, ""};
    }
    for (size_t i = 0; i < team_->invariants().size(); ++i) {
      if (!Holds(start_, i))
        return Differs(fmt::format("its start violates `{}`", team_->invariants()[i].name));
    }
    if (Holds(end_, invariant_)) return Differs("the invariant holds at its end");
    return witness_.of == WitnessOf::kCutOff ? CutOff() : Round();
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
    end_ = then_ = start_;
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
      std::vector<Word> then;
      if (lenient_ && !ToWords(model_.types, variable.type, value.start, words)) continue;
      words.clear();
      if (!ToWords(model_.types, variable.type, value.start, words) ||
          (value.end && !ToWords(model_.types, variable.type, *value.end, after)) ||
          (value.then && !ToWords(model_.types, variable.type, *value.then, then)))
        return Refuse(fmt::format("`{}` has a value that no run can have", variable.name));
      if (!value.end) after = words;
      if (!value.then) then = after;
      std::copy(words.begin(), words.end(), start_.begin() + at);
      std::copy(after.begin(), after.end(), end_.begin() + at);
      std::copy(then.begin(), then.end(), then_.begin() + at);
      std::fill_n(known.begin() + at, words.size(), true);
    }
    for (const int64_t r : witness_.stopped) {
      if (r < 0 || r >= witness_.robots) return Refuse("a robot has no number");
      start_[Mark(r)] = 1;
    }
    for (const int64_t r : witness_.stopped_after) {
      if (r < 0 || r >= witness_.robots) return Refuse("a robot has no number");
      end_[Mark(r)] = 1;
    }
    // Nobody goes on who has stopped; where no robot can stop, nothing is said of it.
    for (const int64_t r : witness_.stopped) end_[Mark(r)] = 1;
    for (size_t r = 0; r < team_->robots(); ++r)
      known[team_->layout().block(r) + team_->layout().stopped()] = true;
    if (!lenient_ && !std::all_of(known.begin(), known.end(), [](bool k) { return k; }))
      return Refuse("the counterexample does not give every value");
    return true;
  }

  uint32_t Mark(int64_t robot) const {
    return team_->layout().block(static_cast<size_t>(robot)) + team_->layout().stopped();
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
        if (promise.at_end && !team_->invariants()[invariant_].at_rounds) continue;
        machine.SetMemory(settled.data(), settled.data());
        if (promise.when != 0 && !machine.RunFormula(promise.when, r)) continue;
        machine.SetMemory(end_.data(), settled.data());
        if (!machine.RunFormula(promise.always, r))
          return Differs(fmt::format("`{}` is violated", promise.name));
      }
    }
    return {ReplayOutcome::kReplayed, ""};
  }

  // -- robots that are cut off

  // Which words of a state are ports of this kind?
  std::vector<bool> Ports(VariableKind kind) const {
    std::vector<bool> ports(start_.size());
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].kind != kind || !team_->layout()[v].exists) continue;
      for (size_t r = 0; r < team_->robots(); ++r)
        std::fill_n(ports.begin() + team_->layout().Address(v, r), team_->layout()[v].words(), true);
    }
    return ports;
  }

  // Does some choice of events lead to what the team agrees on, and each robot's actuators go their way from there?
  WitnessReplay CutOff() {
    sensors_ = Ports(VariableKind::kSensor);
    actuators_ = Ports(VariableKind::kActuator);
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].kind != VariableKind::kActuator || model_.FallsBack(v)) continue;
      // Without a fallback it gets what events write at once.
      for (size_t r = 0; r < team_->robots(); ++r)
        std::fill_n(actuators_.begin() + team_->layout().Address(v, r), team_->layout()[v].words(), false);
    }
    semantics::ProgramTransition transition(*team_);
    transition.Prepare(start_);
    std::vector<Word> agreed;
    std::string why = "no choice of events and last writers leads to its end";
    transition.Enumerate([&](std::span<const Word> state, bool) {
      for (size_t i = 0; i < state.size(); ++i) {
        if (!sensors_[i] && !actuators_[i] && state[i] != end_[i]) return true;
      }
      agreed.assign(state.begin(), state.end());
      why.clear();
      for (size_t r = 0; r < team_->robots() && why.empty(); ++r) why = Goes(r, agreed);
      return !why.empty();
    });
    return why.empty() ? WitnessReplay{ReplayOutcome::kReplayed, ""} : Differs(why);
  }

  // Why the actuators or sensors of a robot cannot do this; empty if they can.
  std::string Goes(size_t r, const std::vector<Word>& agreed) {
    WitnessState::Actuators how{static_cast<int64_t>(r), false, false, false};
    for (const auto& a : witness_.actuators) {
      if (a.robot == how.robot) how = a;
    }
    std::vector<Word> first = how.wait ? start_ : agreed;  // until they change
    std::vector<Word> last = how.change ? agreed : first;  // from then on
    std::vector<Word> fallen = then_;
    if (how.change && how.fall_back) {
      last = first;
      if (!semantics::FallBack(*team_, fallen, r)) return "a fallback has no value";
      for (const FallbackDef* def : model_.fallbacks) TakeOver(r, *def, fallen, last);
    }
    if (!Same(r, actuators_, last, end_)) return "an actuator has another value at the end";
    if (how.change && !Same(r, actuators_, first, then_))
      return "an actuator has another value before it changes";
    if (!witness_.moved)
      return Same(r, sensors_, start_, end_) ? "" : "sensors differ although the environment did not move";
    if (!how.change) return Leg(r, With(agreed, r, start_, first), With(end_, r, end_, last), false);
    const std::string before = Leg(r, With(agreed, r, start_, first), With(agreed, r, then_, first), true);
    return !before.empty() ? before : Leg(r, With(end_, r, then_, last), With(end_, r, end_, last), true);
  }

  void TakeOver(size_t r, const FallbackDef& def, const std::vector<Word>& from,
                std::vector<Word>& to) const {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].kind != VariableKind::kActuator || model_.variables[v].module != def.module)
        continue;
      const uint32_t at = team_->layout().Address(v, r);
      std::copy_n(from.begin() + at, team_->layout()[v].words(), to.begin() + at);
    }
  }

  bool Same(size_t r, const std::vector<bool>& which, const std::vector<Word>& a,
            const std::vector<Word>& b) const {
    const uint32_t first = team_->layout().block(r);
    for (uint32_t at = first; at < first + team_->layout().block_words(); ++at) {
      if (which[at] && a[at] != b[at]) return false;
    }
    return true;
  }

  // A state with the sensors and the actuators of a robot as they are in others.
  std::vector<Word> With(std::vector<Word> state, size_t r, const std::vector<Word>& sensors,
                         const std::vector<Word>& actuators) const {
    const uint32_t first = team_->layout().block(r);
    for (uint32_t at = first; at < first + team_->layout().block_words(); ++at) {
      if (sensors_[at]) state[at] = sensors[at];
      if (actuators_[at]) state[at] = actuators[at];
    }
    return state;
  }

  // @param may_rest  nothing is promised if the sensors stay.
  std::string Leg(size_t r, std::vector<Word> from, std::vector<Word> to, bool may_rest) {
    semantics::Machine& machine = team_->machine();
    machine.SetMemory(to.data(), from.data());
    for (const semantics::FormulaCode& fact : team_->port_facts()) {
      if (!machine.RunFormula(fact.entry, r)) return fmt::format("`{}` is violated", fact.name);
    }
    if (may_rest && Same(r, sensors_, from, to)) return "";
    for (const semantics::PromiseCode& promise : team_->promises()) {
      if (promise.at_end) continue;  // its actuators changed on the way
      machine.SetMemory(from.data());
      if (promise.when != 0 && !machine.RunFormula(promise.when, r)) continue;
      machine.SetMemory(to.data(), from.data());
      if (!machine.RunFormula(promise.always, r)) return fmt::format("`{}` is violated", promise.name);
    }
    return "";
  }

  const Model& model_;
  size_t invariant_;
  const WitnessState& witness_;
  std::vector<bool> sensors_, actuators_;  // by word of a state
  std::unique_ptr<semantics::Team> team_;
  std::vector<Word> start_;
  std::vector<Word> end_;
  std::vector<Word> then_;  // each robot's part: when its actuators change
  std::string why_;
  bool undefined_ = false;
  bool lenient_ = false;  // values that no run can have are zero
};

}  // namespace

WitnessReplay ReplayWitness(const Model& model, size_t invariant, const WitnessState& witness) {
  if (witness.robots < 1 || witness.robots > 64)
    return {ReplayOutcome::kNotPossible, "the team is too large"};
  return Replay(model, invariant, witness).Run();
}

std::vector<bool> InvariantsAtStart(const Model& model, const WitnessState& witness) {
  return Replay(model, 0, witness).AtStart();
}

}  // namespace rondo::koord
