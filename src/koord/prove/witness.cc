#include "koord/prove/witness.h"

#include <algorithm>
#include <functional>
#include <map>

#include <fmt/format.h>

#include "koord/prove/text_table.h"

namespace rondo::koord {
namespace {

using solve::Value;

// Which variables does an expression mention?
void Mentioned(const Model& model, ExprId id, std::vector<bool>& seen) {
  const Ref ref = model.RefOf(id);
  if (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell || ref.kind == RefKind::kPortOf) seen[ref.index] = true;
  const lang::Expr& e = model.program->exprs[id];
  for (const ExprId arg : e.args) Mentioned(model, arg, seen);
  for (const lang::Binder& b : e.binders) {
    if (b.domain.valid()) Mentioned(model, b.domain, seen);
  }
}

/// Reads a model of a spelled-out problem and tells it as a story.
class Storyteller {
 public:
  Storyteller(const Model& model, Problems& problems, expr::Arena& arena, size_t invariant, int64_t robots)
      : model_(model), problems_(problems), arena_(arena), invariant_(invariant), robots_(robots) {}

  std::vector<TermId> Wanted(bool initial) {
    ForEachValue(initial, [&](const std::string&, size_t, int64_t, TermId term) { wanted_.push_back(term); });
    Round& round = problems_.round();
    if (!initial) {
      wanted_.push_back(round.moved());
      for (int64_t r = 0; r < robots_; ++r) {
        const TermId robot = arena_.IntNumber(r);
        for (size_t a = 0; a < round.actions().size(); ++a) {
          wanted_.push_back(round.Acts(robot, a));
          for (const ReadRecord& read : round.EffectOf(a, robot).reads) {
            for (const TermId t : {read.index, read.value, read.reached}) {
              if (t.valid() && !arena_.IsOpen(t)) wanted_.push_back(t);
            }
          }
        }
      }
    }
    return wanted_;
  }

  bool Moved(const solve::Sat& sat) const { return IsTrue(sat, problems_.round().moved()); }

  std::string Tell(const solve::Sat& sat, bool initial) {
    TextTable table;
    Round& round = problems_.round();
    if (!initial) {
      for (int64_t r = 0; r < robots_; ++r) {
        const TermId robot = arena_.IntNumber(r);
        for (size_t a = 0; a < round.actions().size(); ++a) {
          if (!IsTrue(sat, round.Acts(robot, a))) continue;
          table.Add({fmt::format("robot {}", r), round.actions()[a], Reads(sat, robot, a), Writes(sat, r)});
        }
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
    std::string text = solve::ToString(value);
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
    for (const ReadRecord& read : problems_.round().EffectOf(action, robot).reads) {
      if (!IsTrue(sat, read.reached) || arena_.IsOpen(read.value)) continue;
      std::string name = model_.variables[read.variable].name;
      if (read.index.valid()) name += fmt::format("[{}]", Show(sat, read.index));
      std::string part = fmt::format("{} = {}", name, Show(sat, read.value));
      if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(std::move(part));
    }
    return parts.empty() ? "" : fmt::format("read {}", fmt::join(parts, ", "));
  }

  std::string Writes(const solve::Sat& sat, int64_t r) {
    std::vector<std::string> parts;
    Round& round = problems_.round();
    const TermId robot = arena_.IntNumber(r);
    for (size_t a = 1; a < round.actions().size(); ++a) {
      if (!IsTrue(sat, round.Acts(robot, a))) continue;
      for (size_t v = 0; v < model_.variables.size(); ++v) {
        const Variable& variable = model_.variables[v];
        if (variable.kind == VariableKind::kParam || variable.kind == VariableKind::kSensor ||
            variable.kind == VariableKind::kAllwrite || variable.function >= 0) {
          continue;
        }
        const std::string before = Show(sat, arena_.Select(round.start().value[v], robot));
        const std::string after = Show(sat, arena_.Select(round.end().value[v], robot));
        if (before == after) continue;
        const std::string index = variable.kind == VariableKind::kAllread ? fmt::format("[{}]", r) : "";
        parts.push_back(fmt::format("{}{} = {}", variable.name, index, after));
      }
    }
    return parts.empty() ? "" : fmt::format("wrote {}", fmt::join(parts, ", "));
  }

  // Values at the start and at the end of what the invariant mentions or the round changed.
  void State(const solve::Sat& sat, bool initial, TextTable& table) {
    std::vector<bool> mentioned(model_.variables.size());
    Mentioned(model_, model_.invariants[invariant_]->body, mentioned);
    std::map<std::string, std::string> before;
    std::vector<std::tuple<std::string, size_t, std::string, std::string>> lines;
    ForEachValue(initial, [&](const std::string& name, size_t v, int64_t when, TermId term) {
      if (when == 0) {
        before[name] = Show(sat, term);
        if (initial || model_.variables[v].kind == VariableKind::kParam) lines.emplace_back(name, v, before[name], before[name]);
      } else {
        lines.emplace_back(name, v, before[name], Show(sat, term));
      }
    });
    for (const auto& [name, v, old, now] : lines) {
      if (!mentioned[v]) continue;
      const bool same = old == now;
      const bool moved = model_.variables[v].kind == VariableKind::kSensor && !same;
      table.Add({same ? "state" : moved ? "moved" : "changed", name, same ? "= " + now : fmt::format("{} -> {}", old, now), ""});
    }
  }

  // when: 0 at the start, 1 at the end.
  void ForEachValue(bool initial, const std::function<void(const std::string&, size_t, int64_t, TermId)>& visit) {
    Round& round = problems_.round();
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      if (variable.function >= 0) continue;
      const bool array = model_.types.Is(variable.type, lang::TypeKind::kArray);
      if (!variable.PerRobot()) {
        if (array) continue;
        visit(variable.name, v, 0, round.start().value[v]);
        if (!initial && variable.kind != VariableKind::kParam) visit(variable.name, v, 1, round.end().value[v]);
        continue;
      }
      for (int64_t r = 0; r < robots_; ++r) {
        const std::string name = variable.module.empty() ? fmt::format("{}[{}]", variable.name, r)
                                                         : fmt::format("{}[{}]{}", variable.module, r, variable.name.substr(variable.module.size()));
        visit(name, v, 0, arena_.Select(round.start().value[v], arena_.IntNumber(r)));
        if (!initial) visit(name, v, 1, arena_.Select(round.end().value[v], arena_.IntNumber(r)));
      }
    }
  }

  const Model& model_;
  Problems& problems_;
  expr::Arena& arena_;
  size_t invariant_;
  int64_t robots_;
  std::vector<TermId> wanted_;
};

// Satisfiable with everything taken into account, or nothing.
std::optional<solve::Sat> Confirm(const Problem& problem, std::vector<TermId> wanted, const solve::Solver& solver,
                                  solve::Budget budget, const base::StopToken& stop) {
  budget.core = false;
  solve::Query query = problem.query;
  query.wanted = std::move(wanted);
  solve::Answer answer = solver.Check(query, budget, stop);
  if (!std::holds_alternative<solve::Sat>(answer)) return std::nullopt;
  if (!problem.complete) {
    // Some quantifiers were only instantiated: ask again with all of them.
    query.assertions.insert(query.assertions.end(), problem.assertions.begin(), problem.assertions.end());
    answer = solver.Check(query, budget, stop);
    if (!std::holds_alternative<solve::Sat>(answer)) return std::nullopt;
  }
  return std::get<solve::Sat>(std::move(answer));
}

}  // namespace

std::optional<Witness> FindWitness(const Model& model, size_t invariant, std::optional<size_t> action,
                                   std::optional<int64_t> robots, const solve::Solver& solver,
                                   const solve::Budget& budget, const base::StopToken& stop) {
  static constexpr int64_t kLargest = 8;
  if (robots && *robots > kLargest) return std::nullopt;
  const int64_t first = robots.value_or(1);
  const int64_t last = robots.value_or(4);
  for (int64_t n = first; n <= last && !stop.StopRequested(); ++n) {
    expr::Arena arena;
    diag::Diagnostics ignored;  // the symbolic run reported the same
    Problems problems(arena, model, {n, true}, ignored);
    Storyteller storyteller(model, problems, arena, invariant, n);
    const std::vector<TermId> wanted = storyteller.Wanted(!action.has_value());
    const auto attempt = [&](const Problem& problem, bool reachable) -> std::optional<Witness> {
      const auto sat = Confirm(problem, wanted, solver, budget, stop);
      if (!sat) return std::nullopt;
      const bool initial = !action.has_value();
      return Witness{reachable, !initial && storyteller.Moved(*sat), n, storyteller.Tell(*sat, initial)};
    };
    if (!action) {
      if (auto witness = attempt(problems.Initially(invariant), true)) return witness;
      continue;
    }
    const Problem from_anywhere = problems.Step(invariant, *action, false);
    auto witness = attempt(from_anywhere, false);
    if (!witness) continue;
    if (!problems.has_init()) {
      if (auto real = attempt(problems.Step(invariant, *action, true), true)) return real;
    }
    return witness;
  }
  return std::nullopt;
}

}  // namespace rondo::koord
