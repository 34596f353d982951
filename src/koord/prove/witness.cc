#include "koord/prove/witness.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "expr/substitute.h"
#include "koord/prove/confirm.h"
#include "koord/prove/obligations/distances.h"
#include "koord/prove/text_table.h"

namespace rondo::koord {
namespace {

using solve::Value;

// Which variables does an expression mention?
void Mentioned(const Model& model, ExprId id, std::vector<bool>& seen) {
  const Ref ref = model.RefOf(id);
  if (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell || ref.kind == RefKind::kPortOf)
    seen[ref.index] = true;
  const lang::Expr& e = model.program->exprs[id];
  for (const ExprId arg : e.args) Mentioned(model, arg, seen);
  for (const lang::Binder& b : e.binders) {
    if (b.domain.valid()) Mentioned(model, b.domain, seen);
  }
}

/// Reads a model of a spelled-out problem and tells it as a story.
class Storyteller {
 public:
  Storyteller(const Model& model, Round& round, expr::Arena& arena, size_t invariant, WitnessOf of,
              std::vector<TermId> robots)
      : model_(model),
        round_(round),
        arena_(arena),
        invariant_(invariant),
        of_(of),
        robots_(std::move(robots)) {}

  std::vector<TermId> Wanted() {
    const bool initial = of_ == WitnessOf::kInitial;
    ForEachValue(initial, [&](size_t, bool, TermId, TermId term) { wanted_.push_back(term); });
    for (const TermId robot : robots_) wanted_.push_back(robot);
    if (!initial) {
      wanted_.push_back(round_.moved());
      for (const TermId robot : robots_) {
        wanted_.push_back(arena_.Select(round_.start().stopped, robot));
        wanted_.push_back(arena_.Select(round_.end().stopped, robot));
        for (size_t a = 0; a < round_.actions().size(); ++a) {
          wanted_.push_back(round_.Acts(robot, a));
          for (const ReadRecord& read : round_.EffectOf(a, robot).reads) {
            for (const TermId t : {read.index, read.value, read.reached}) {
              if (t.valid() && !arena_.IsOpen(t)) wanted_.push_back(t);
            }
          }
        }
      }
    }
    if (of_ == WitnessOf::kCutOff) {
      for (const TermId robot : robots_) {
        for (const TermId t : {round_.Waits(robot), round_.Changes(robot), round_.FallsBack(robot)})
          wanted_.push_back(t);
        ForEachPort([&](size_t v) { wanted_.push_back(arena_.Select(round_.then().value[v], robot)); });
      }
    }
    return wanted_;
  }

  WitnessState State(const solve::Sat& sat, int64_t robots) {
    const bool initial = of_ == WitnessOf::kInitial;
    WitnessState state;
    state.robots = robots;
    state.of = of_;
    state.moved = !initial && Moved(sat);
    const auto number = [&](TermId robot) -> int64_t {
      const std::string text = Show(sat, robot);
      return text.empty() || text.size() > 9 || !std::all_of(text.begin(), text.end(), ::isdigit)
                 ? -1
                 : std::stoll(text);
    };
    std::set<std::pair<size_t, int64_t>> seen;
    ForEachValue(initial, [&](size_t v, bool end, TermId robot, TermId term) {
      const auto it = sat.values.find(term);
      if (it == sat.values.end()) return;
      const int64_t r = robot.valid() ? number(robot) : -1;
      if (!end && seen.insert({v, r}).second) state.values.push_back({v, r, it->second, {}, {}});
      for (WitnessState::Value& value : state.values) {
        if (end && value.variable == v && value.robot == r) value.end = it->second;
      }
    });
    std::set<int64_t> told;
    for (const TermId robot : robots_) {
      const int64_t r = number(robot);
      if (initial || !told.insert(r).second) continue;
      if (IsTrue(sat, arena_.Select(round_.start().stopped, robot))) state.stopped.push_back(r);
      if (IsTrue(sat, arena_.Select(round_.end().stopped, robot))) state.stopped_after.push_back(r);
      for (size_t a = 0; a < round_.actions().size(); ++a) {
        if (IsTrue(sat, round_.Acts(robot, a))) state.actions.emplace_back(r, a);
      }
      if (of_ != WitnessOf::kCutOff) continue;
      state.actuators.push_back({r, IsTrue(sat, round_.Waits(robot)), IsTrue(sat, round_.Changes(robot)),
                                 IsTrue(sat, round_.FallsBack(robot))});
      ForEachPort([&](size_t v) {
        const auto then = sat.values.find(arena_.Select(round_.then().value[v], robot));
        for (WitnessState::Value& value : state.values) {
          if (value.variable == v && value.robot == r && then != sat.values.end()) value.then = then->second;
        }
      });
    }
    return state;
  }

  // The first in program order that some robot takes; 0: all skip.
  size_t FirstAction(const solve::Sat& sat) {
    for (size_t a = 1; a < round_.actions().size(); ++a) {
      for (const TermId robot : robots_) {
        if (IsTrue(sat, round_.Acts(robot, a))) return a;
      }
    }
    return 0;
  }

  bool Moved(const solve::Sat& sat) const { return IsTrue(sat, round_.moved()); }

  std::string Tell(const solve::Sat& sat) {
    const bool initial = of_ == WitnessOf::kInitial;
    TextTable table;
    if (!initial) {
      std::vector<std::string> told;
      for (const TermId robot : robots_) {
        const std::string number = Show(sat, robot);
        if (std::find(told.begin(), told.end(), number) != told.end()) continue;
        told.push_back(number);
        for (size_t a = 0; a < round_.actions().size(); ++a) {
          if (!IsTrue(sat, round_.Acts(robot, a))) continue;
          table.Add({fmt::format("robot {}", number), round_.actions()[a], Reads(sat, robot, a),
                     Writes(sat, robot)});
        }
        if (of_ == WitnessOf::kCutOff &&
            (IsTrue(sat, round_.Waits(robot)) || IsTrue(sat, round_.Changes(robot))))
          table.Add({fmt::format("robot {}", number), OfActuators(sat, robot), Actuators(sat, robot), ""});
      }
    }
    State(sat, initial, table);
    return table.Text();
  }

 private:
  static std::string Show(const Value& value) {
    if (const auto* fields = std::get_if<Value::Fields>(&value.data)) {
      std::string text;
      for (const Value& f : *fields) text += (text.empty() ? "" : ", ") + Show(f);
      return fmt::format("({})", text);
    }
    std::string text = expr::ToString(value);
    // Elements of opaque sorts have long names; only their identity matters.
    if (const size_t at = text.find("!val!"); at != std::string::npos) {
      text = "#" + text.substr(at + 5);
      while (!text.empty() && text.back() == '|') text.pop_back();
    }
    return text;
  }

  std::string Show(const solve::Sat& sat, TermId term) const {
    if (arena_.IsNumber(term)) return arena_.number(term).ToString();
    const auto it = sat.values.find(term);
    return it == sat.values.end() ? "?" : Show(it->second);
  }

  bool IsTrue(const solve::Sat& sat, TermId term) const {
    if (term == arena_.True()) return true;
    const auto it = sat.values.find(term);
    return it != sat.values.end() && it->second.IsBool() && it->second.AsBool();
  }

  std::string Reads(const solve::Sat& sat, TermId robot, size_t action) {
    std::vector<std::string> parts;
    for (const ReadRecord& read : round_.EffectOf(action, robot).reads) {
      if (!IsTrue(sat, read.reached) || arena_.IsOpen(read.value)) continue;
      if (!read.index.valid() &&
          model_.types.Is(model_.variables[read.variable].type, lang::TypeKind::kArray))
        continue;
      std::string name = model_.variables[read.variable].name;
      if (read.index.valid()) name += fmt::format("[{}]", Show(sat, read.index));
      std::string part = fmt::format("{} = {}", name, Show(sat, read.value));
      if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(std::move(part));
    }
    return parts.empty() ? "" : fmt::format("read {}", fmt::join(parts, ", "));
  }

  std::string Writes(const solve::Sat& sat, TermId robot) {
    std::vector<std::string> parts;
    for (size_t a = 1; a < round_.actions().size(); ++a) {
      if (!IsTrue(sat, round_.Acts(robot, a))) continue;
      for (size_t v = 0; v < model_.variables.size(); ++v) {
        const Variable& variable = model_.variables[v];
        if (variable.kind == VariableKind::kParam || variable.kind == VariableKind::kSensor ||
            variable.kind == VariableKind::kAllwrite || variable.function >= 0 ||
            (of_ == WitnessOf::kCutOff && model_.FallsBack(v)) ||
            model_.types.Is(variable.type, lang::TypeKind::kArray)) {
          continue;
        }
        const std::string before = Show(sat, arena_.Select(round_.start().value[v], robot));
        const std::string after = Show(sat, arena_.Select(round_.end().value[v], robot));
        if (before == after) continue;
        const std::string index =
            variable.kind == VariableKind::kAllread ? fmt::format("[{}]", Show(sat, robot)) : "";
        parts.push_back(fmt::format("{}{} = {}", variable.name, index, after));
      }
    }
    return parts.empty() ? "" : fmt::format("wrote {}", fmt::join(parts, ", "));
  }

  void ForEachPort(const std::function<void(size_t)>& visit) const {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      const bool port = variable.kind == VariableKind::kSensor || model_.FallsBack(v);
      if (port && variable.function < 0 && !model_.types.Is(variable.type, lang::TypeKind::kArray)) visit(v);
    }
  }

  std::string OfActuators(const solve::Sat& sat, TermId robot) {
    if (!IsTrue(sat, round_.Changes(robot))) return "is cut off";
    return IsTrue(sat, round_.FallsBack(robot)) ? "falls back" : "acts late";
  }

  // What actuators get, and where sensors are when they do.
  std::string Actuators(const solve::Sat& sat, TermId robot) {
    std::vector<std::string> parts;
    ForEachPort([&](size_t v) {
      const bool sensor = model_.variables[v].kind == VariableKind::kSensor;
      const bool changes = IsTrue(sat, round_.Changes(robot));
      if (sensor && !changes) return;
      const View& at = sensor ? round_.then() : round_.end();
      parts.push_back(fmt::format("{}{} = {}", sensor ? "at " : "", model_.variables[v].name,
                                  Show(sat, arena_.Select(at.value[v], robot))));
    });
    return fmt::format("{}", fmt::join(parts, ", "));
  }

  // Values at the start and at the end of what the invariant mentions or the round changed.
  void State(const solve::Sat& sat, bool initial, TextTable& table) {
    std::vector<bool> mentioned(model_.variables.size());
    Mentioned(model_, model_.invariants[invariant_]->body, mentioned);
    std::map<std::string, std::string> before;
    std::vector<std::tuple<std::string, size_t, std::string, std::string>> lines;
    ForEachValue(initial, [&](size_t v, bool end, TermId robot, TermId term) {
      const std::string name = NameOf(v, robot.valid() ? Show(sat, robot) : "");
      if (end && std::any_of(lines.begin(), lines.end(),
                             [&](const auto& line) { return std::get<0>(line) == name; }))
        return;
      if (!end) {
        if (before.contains(name)) return;
        before[name] = Show(sat, term);
        if (initial || model_.variables[v].kind == VariableKind::kParam)
          lines.emplace_back(name, v, before[name], before[name]);
      } else {
        lines.emplace_back(name, v, before[name], Show(sat, term));
      }
    });
    for (const auto& [name, v, old, now] : lines) {
      if (!mentioned[v]) continue;
      const bool same = old == now;
      const bool moved = model_.variables[v].kind == VariableKind::kSensor && !same;
      table.Add({same    ? "state"
                 : moved ? "moved"
                         : "changed",
                 name, same ? "= " + now : fmt::format("{} -> {}", old, now), ""});
    }
  }

  std::string NameOf(size_t v, const std::string& robot) const {
    const Variable& variable = model_.variables[v];
    if (robot.empty()) return variable.name;
    if (variable.module.empty()) return fmt::format("{}[{}]", variable.name, robot);
    return fmt::format("{}[{}]{}", variable.module, robot, variable.name.substr(variable.module.size()));
  }

  // (variable, at the end?, robot or none, value)
  void ForEachValue(bool initial, const std::function<void(size_t, bool, TermId, TermId)>& visit) {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      if (variable.function >= 0 || model_.types.Is(variable.type, lang::TypeKind::kArray)) continue;
      if (!variable.PerRobot()) {
        visit(v, false, {}, round_.start().value[v]);
        if (!initial && variable.kind != VariableKind::kParam) visit(v, true, {}, round_.end().value[v]);
        continue;
      }
      for (const TermId robot : robots_) {
        visit(v, false, robot, arena_.Select(round_.start().value[v], robot));
        if (!initial) visit(v, true, robot, arena_.Select(round_.end().value[v], robot));
      }
    }
  }

  const Model& model_;
  Round& round_;
  expr::Arena& arena_;
  size_t invariant_;
  WitnessOf of_;
  std::vector<TermId> robots_;
  std::vector<TermId> wanted_;
};

// What breaks an invariant with these limits does so without them.
constexpr CutOffLimits kMostLimits{true, true};

// A team of `n`, every quantifier over robots spelled out; or, for a large team, only those who matter.
std::optional<Witness> TryTeam(const Model& model, size_t invariant, WitnessOf of, int64_t n, bool expand,
                               const solve::Solver& solver, const solve::Budget& budget,
                               const base::StopToken& stop) {
  expr::Arena arena;
  diag::Diagnostics ignored;  // the symbolic run reported the same
  Problems problems(arena, model, {n, expand}, ignored);
  problems.limits.rounds = 5;
  const auto attempt = [&](const Problem& problem, bool reachable) -> std::optional<Witness> {
    Storyteller storyteller(model,
                            of == WitnessOf::kCutOff ? problems.cut_off(kMostLimits) : problems.round(),
                            arena, invariant, of, problem.participants);
    const bool complete = problem.complete || (!expand && OthersCanBeCopies(arena, problem, problems));
    const std::vector<TermId> wanted = storyteller.Wanted();
    std::vector<solve::Assertion> small = Small(arena, wanted);
    std::optional<Candidate> found;
    bool distances = !problems.uses_dist();
    if (!distances) {
      // Distances along axes are what they are in space; of others, only some properties are known.
      Problem aligned = problem;
      const solve::Assertion along{
          AlongAxes(problems.vocabulary(), solve::Formulas(problem.query.assertions)), ""};
      aligned.query.assertions.push_back(along);
      aligned.assertions.push_back(along);
      found = Confirm(aligned, wanted, small, complete, solver, budget, stop);
      distances =
          found && found->confirmed &&
          (complete || !HasDistanceOfAnyPoints(problems.vocabulary(), solve::Formulas(problem.assertions)));
    }
    if (!found || !distances) found = Confirm(problem, wanted, small, complete, solver, budget, stop);
    if (!found) return std::nullopt;
    const bool rounded =
        complete || !RoundsAnyNumber(problems.vocabulary(), solve::Formulas(problem.assertions));
    return Witness{
        of != WitnessOf::kRound ? std::nullopt : std::optional(storyteller.FirstAction(found->sat)),
        found->confirmed && distances && rounded && !problems.vocabulary().uses_texts(),
        reachable,
        of != WitnessOf::kInitial && storyteller.Moved(found->sat),
        n,
        storyteller.Tell(found->sat),
        storyteller.State(found->sat, n)};
  };
  if (of == WitnessOf::kInitial) return attempt(problems.Initially(invariant), true);
  // Any round: which of its cases could not be proved does not matter, where one breaks the invariant.
  const auto state = [&](bool reachable) {
    return of == WitnessOf::kCutOff ? problems.CutOff(invariant, std::nullopt, kMostLimits, reachable)
                                    : problems.Step(invariant, std::nullopt, reachable);
  };
  auto witness = attempt(state(false), false);
  if (witness && witness->confirmed && !problems.has_init()) {
    auto real = attempt(state(true), true);
    if (real && real->confirmed) return real;
  }
  return witness;
}

}  // namespace

std::optional<Witness> FindWitness(const Model& model, size_t invariant, WitnessOf of,
                                   std::optional<int64_t> robots, const solve::Solver& solver,
                                   const solve::Budget& budget, const base::StopToken& stop) {
  static constexpr int64_t kLargest = 8;
  const base::StopToken limited = stop.WithDeadline(base::StopToken::Clock::now() + budget.time);
  if (robots && *robots > kLargest)
    return TryTeam(model, invariant, of, *robots, false, solver, budget, limited);
  std::optional<Witness> best;
  int unconfirmed = 0;
  for (int64_t n = robots.value_or(1); n <= robots.value_or(4) && unconfirmed < 2 && !limited.StopRequested();
       ++n) {
    auto witness = TryTeam(model, invariant, of, n, true, solver, budget, limited);
    if (!witness) continue;
    if (witness->confirmed) return witness;
    // What could not be confirmed for two sizes will not be for a third: the functions are too much for the
    // solver.
    ++unconfirmed;
    if (!best) best = std::move(witness);
  }
  return best;
}

}  // namespace rondo::koord
