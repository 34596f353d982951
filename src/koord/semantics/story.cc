#include "koord/semantics/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "koord/semantics/machine/values.h"
#include "koord/semantics/responses.h"

namespace rondo::koord::semantics {

using nlohmann::json;

namespace {

// Which variable is at this address, and whose?
struct Owner {
  size_t variable = 0;
  size_t robot = 0;
  bool found = false;
};

Owner OwnerOf(const Team& team, uint32_t at) {
  const Layout& layout = team.layout();
  for (size_t v = 0; v < team.model().variables.size(); ++v) {
    const Layout::Place& place = layout[v];
    if (!place.exists || team.model().variables[v].kind == VariableKind::kParam) continue;
    const uint32_t words = place.words();
    for (size_t r = 0; r < (place.own ? team.robots() : 1); ++r) {
      const uint32_t from = layout.Address(v, r);
      if (from <= at && at < from + words) return {v, r, true};
    }
  }
  return {};
}

// `x[1] = 2` for everything that differs.
std::vector<std::string> Changes(const Team& team, std::span<const Word> before, std::span<const Word> after,
                                 bool arrow) {
  std::vector<std::string> changes;
  const Model& model = team.model();
  for (size_t v = 0; v < model.variables.size(); ++v) {
    const Layout::Place& place = team.layout()[v];
    if (!place.exists || model.variables[v].kind == VariableKind::kParam) continue;
    const uint32_t words = place.words();
    for (size_t r = 0; r < (place.own ? team.robots() : 1); ++r) {
      const uint32_t at = team.layout().Address(v, r);
      if (std::equal(before.begin() + at, before.begin() + at + words, after.begin() + at)) continue;
      const std::string old = arrow ? team.ShowVariable(before, v, r) + " -> " : "";
      changes.push_back(fmt::format("{} = {}{}", team.NameOf(v, r), old, team.ShowVariable(after, v, r)));
    }
  }
  const Layout& layout = team.layout();
  for (size_t r = 0; r < team.robots(); ++r) {
    const uint32_t at = layout.block(r) + layout.stopped();
    if (before[at] != after[at]) changes.push_back(fmt::format("robot {} stops", r));
  }
  return changes;
}

std::string Join(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, ", ")); }

}  // namespace

std::string Tell(const Team& team, const std::vector<Step>& run) {
  std::string text;
  size_t round = 0;
  const auto line = [&](const std::string& when, const std::string& what) {
    text += fmt::format("{:9} {}\n", when, what);
  };
  if (run.empty()) return text;
  const std::vector<Word> zero(team.layout().words());
  const auto start = Changes(team, zero, run[0].state, false);
  line("start", start.empty() ? "everything is zero, false or empty" : Join(start));
  for (size_t i = 1; i < run.size(); ++i) {
    const Step& step = run[i];
    const std::vector<Word>& before = run[i - 1].state;
    if (step.environment) {
      const auto moved = Changes(team, before, step.state, true);
      if (!moved.empty()) line("", "moved   " + Join(moved));
      continue;
    }
    ++round;
    std::string when = fmt::format("round {}", round);
    bool acted = false;
    for (const Action& a : step.actions) {
      if (a.event < 0) continue;
      acted = true;
      std::vector<Word> after = before;
      for (const Effect::Write& w : a.writes) after[w.at] = w.value;
      const auto wrote = Changes(team, before, after, false);
      line(when,
           fmt::format("robot {}  {}  {}", a.robot, team.events()[static_cast<size_t>(a.event)].def->name,
                       wrote.empty() ? "" : "wrote " + Join(wrote)));
      when.clear();
    }
    if (!acted) line(when, "all skip");
    for (const LastWriter& last : step.last_writers) {
      const Owner owner = OwnerOf(team, last.unit.at);
      if (owner.found)
        line("", fmt::format("robot {} is the last to write {}", last.robot,
                             team.model().variables[owner.variable].name));
    }
    if (!step.complete) line("", "(before the others)");
  }
  while (text.find(" \n") != std::string::npos) text.erase(text.find(" \n"), 1);
  if (text.ends_with("\n")) text.pop_back();
  return text;
}

json StateToJson(const Team& team, std::span<const Word> state) {
  const Model& model = team.model();
  json result = json::object();
  const auto one = [&](size_t v, size_t r) {
    const Layout::Place& place = team.layout()[v];
    const uint32_t at = team.layout().Address(v, r);
    return ToJson(model.types, team.heap(), place, state.subspan(at, place.words()));
  };
  for (size_t v = 0; v < model.variables.size(); ++v) {
    const Layout::Place& place = team.layout()[v];
    if (!place.exists || model.variables[v].kind == VariableKind::kParam) continue;
    if (!place.own) {
      result[model.variables[v].name] = one(v, 0);
      continue;
    }
    json list = json::array();
    for (size_t r = 0; r < team.robots(); ++r) list.push_back(one(v, r));
    result[model.variables[v].name] = std::move(list);
  }
  json stopped = json::array();
  for (size_t r = 0; r < team.robots(); ++r)
    stopped.push_back(state[team.layout().block(r) + team.layout().stopped()] != 0);
  if (team.robots_stop()) result["stopped"] = std::move(stopped);
  return result;
}

json RunToJson(const Team& team, const std::vector<Step>& run) {
  json steps = json::array();
  for (size_t i = 0; i < run.size(); ++i) {
    const Step& step = run[i];
    json one;
    one["kind"] = i == 0 ? "start" : step.environment ? "environment" : step.complete ? "program" : "prefix";
    if (i > 0 && !step.environment) {
      one["events"] = json::array();
      for (const Action& a : step.actions)
        one["events"].push_back(a.event < 0 ? json(nullptr)
                                            : json(team.events()[static_cast<size_t>(a.event)].def->name));
    }
    one["state"] = StateToJson(team, step.state);
    steps.push_back(std::move(one));
  }
  return steps;
}

namespace {

// Does the last state, or what can happen in it, break the property?
bool Breaks(Team& team, System& system, std::vector<Word> state, const std::string& property) {
  team.machine().SetMemory(state.data());
  for (const FormulaCode& invariant : team.invariants()) {
    if (property == "invariant " + invariant.name) return !team.Holds(invariant);
  }
  if (property == "deadlock") {
    bool moves = false;
    system.StepFrom(state, false, [&](const Step& step) {
      moves = moves || step.state != state;
      return moves;
    });
    return !moves;
  }
  if (property != "well-defined" && !property.starts_with("summary ")) return false;
  const explore::Broken broken = system.Try(state);
  if (broken.property < 0) return false;
  const Trouble trouble = system.TroubleOf(broken.property);
  return trouble == (property == "well-defined" ? Trouble::kFault : Trouble::kSummary);
}

}  // namespace

std::string Replay(Team& team, const json& run, const std::string& property) {
  if (!run.is_array() || run.empty()) return "the file has no steps";
  diag::Diagnostics ignored;
  System system(team, {true, false, {}}, ignored);
  std::vector<Word> here;
  std::vector<Word> prefix;
  Responses responses(team);
  std::vector<Word> waits(responses.words());
  int late = -1;
  for (size_t i = 0; i < run.size(); ++i) {
    const json& step = run[i];
    if (!step.is_object() || !step.contains("state") || !step.contains("kind"))
      return fmt::format("step {} is no step", i);
    if (step.contains("events") && !step["events"].is_array()) return fmt::format("step {} is no step", i);
    const bool known =
        i == 0 ? step["kind"] == "start"
               : step["kind"] == "program" || step["kind"] == "environment" || step["kind"] == "prefix";
    if (!known) return fmt::format("step {} has no kind that could be", i);
    bool found = false;
    const bool tells = step.contains("events");
    if (step["kind"] == "program" && !tells) return fmt::format("step {} does not say who did what", i);
    bool events_seen = i == 0 || !tells;
    std::vector<Word> next;
    const auto same = [&](std::span<const Word> state) { return StateToJson(team, state) == step["state"]; };
    if (step["kind"] == "prefix") {
      // A part of the robots: compare what they did, whatever the others do.
      found = events_seen = system.HasPrefix(here, [&](std::span<const Word> s) {
        if (!same(s)) return false;
        prefix.assign(s.begin(), s.end());
        return true;
      });
    } else if (i == 0) {
      system.Initial([&](explore::State packed) {
        next = system.Unpack(packed);
        found = same(next);
        return !found;
      });
    } else {
      system.StepFrom(here, step["kind"] == "environment", [&](const Step& candidate) {
        if (!same(candidate.state)) return false;
        found = true;
        if (step.contains("events")) {
          events_seen = true;
          for (const Action& a : candidate.actions) {
            const json event =
                a.event < 0 ? json(nullptr) : json(team.events()[static_cast<size_t>(a.event)].def->name);
            events_seen = events_seen && a.robot < step["events"].size() && step["events"][a.robot] == event;
          }
        }
        next = candidate.state;
        return events_seen;
      });
    }
    if (!found) return fmt::format("step {}: the program cannot reach this state", i);
    if (!events_seen) return fmt::format("step {}: other events lead to this state", i);
    if (step["kind"] != "prefix")
      here = next;
    else
      here = prefix;
    if (i == 0 || step["kind"] == "environment" || (step["kind"] == "program" && !team.has_sensors()))
      late = responses.Observe(here, waits);
  }
  if (property.starts_with("response ")) {
    const bool named =
        late >= 0 && "response " + team.responses()[static_cast<size_t>(late)].name == property;
    return named ? "" : fmt::format("the run is possible, but it does not break `{}`", property);
  }
  if (!Breaks(team, system, here, property))
    return fmt::format("the run is possible, but it does not break `{}`", property);
  return "";
}

}  // namespace rondo::koord::semantics
