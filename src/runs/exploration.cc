#include "runs/exploration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfenv>
#include <memory>
#include <random>
#include <span>
#include <thread>
#include <type_traits>
#include <utility>

#include "base/counted.h"
#include "koord/check/spec_labels.h"
#include "koord/semantics/story.h"
#include "koord/semantics/system.h"
#include "koord/semantics/timed_system.h"

namespace rondo::runs {
namespace {

using diag::Kind;
using explore::Ending;
using koord::semantics::System;
using koord::semantics::Team;
using koord::semantics::Trouble;

size_t RoundsOf(const std::vector<koord::semantics::Step>& run) {
  return static_cast<size_t>(std::count_if(run.begin() + (run.empty() ? 0 : 1), run.end(),
                                           [](const auto& step) { return !step.environment; }));
}

// Somebody waits longer than the specification allows.
void ReportLate(Team& team, System& system, const std::vector<explore::KeptState>& path, size_t number,
                Explored& explored, diag::Diagnostics& diagnostics) {
  const auto& response = team.responses()[number];
  const auto run = system.Explain(path, {});
  koord::semantics::Responses responses(team);
  std::vector<koord::semantics::Word> waits(responses.words());
  size_t robot = 0;
  for (size_t i = 0; i < run.size(); ++i) {
    if (i == 0 || run[i].environment || !team.has_sensors()) responses.Observe(run[i].state, waits, &robot);
  }
  explored.broken = true;
  explored.property = "response " + response.name;
  explored.run = koord::semantics::RunToJson(team, run);
  auto& report = diagnostics.Report(
      Kind::kKoordViolated, response.span,
      fmt::format("after {}, the team violates `{}`", base::Counted(RoundsOf(run), "round"), response.name));
  report.Under(
      fmt::format("robot {} waits for more than {}", robot, base::Counted(response.rounds, "round")));
  report.Note(
      fmt::format("with {}:\n{}", base::Counted(team.robots(), "robot"), koord::semantics::Tell(team, run)));
}

void ReportBroken(Team& team, System& system, const std::vector<explore::KeptState>& path,
                  const explore::Broken& broken, Explored& explored, diag::Diagnostics& diagnostics) {
  const koord::Model& model = team.model();
  const auto detail = system.detail();
  std::feclearexcept(FE_ALL_EXCEPT);
  const auto run = system.Explain(path, broken);
  explored.rounded = std::fetestexcept(FE_INEXACT) != 0 || team.rounds_literals();
  const std::string table = koord::semantics::Tell(team, run);
  const size_t rounds = RoundsOf(run);
  explored.broken = true;
  switch (system.TroubleOf(broken.property)) {
    case Trouble::kInvariant: {
      const auto& invariant = team.invariants()[static_cast<size_t>(broken.property)];
      explored.property = "invariant " + invariant.name;
      const std::string when =
          rounds == 0 ? "an initial state violates"
                      : fmt::format("after {}, the team violates", base::Counted(rounds, "round"));
      auto& report = diagnostics.Report(Kind::kKoordViolated, invariant.span,
                                        fmt::format("{} `{}`", when, invariant.name));
      if (!run.empty()) {
        size_t robot = 0;
        std::vector<koord::semantics::Word> last = run.back().state;
        team.machine().SetMemory(last.data());
        if (!team.Holds(invariant, &robot) && invariant.per_robot)
          report.Under(fmt::format("of robot {}", robot));
      }
      if (explored.rounded)
        report.Note("doubles are rounded in this run: with exact numbers it may not exist");
      report.Note(fmt::format("with {}:\n{}", base::Counted(team.robots(), "robot"), table));
      break;
    }
    case Trouble::kFault: {
      // A limit of ours says nothing about the program.
      if (detail.fault == koord::semantics::Fault::kTooMany) {
        explored.broken = false;
        explored.search.ending = explore::Ending::kStates;
        diagnostics.Report(Kind::kKoordNotChecked, detail.span, std::string(Describe(detail.fault)))
            .Help("choose from fewer values");
        return;
      }
      explored.property = "well-defined";
      const bool start = detail.event < 0;
      auto& report =
          diagnostics.Report(Kind::kKoordFault, detail.span,
                             start ? fmt::format("an initial value has no result: {}", Describe(detail.fault))
                                   : fmt::format("robot {} fails after {}: {}", detail.robot,
                                                 base::Counted(rounds, "round"), Describe(detail.fault)));
      if (!start) {
        report.Under(
            fmt::format("in event `{}`", team.events()[static_cast<size_t>(detail.event)].def->name));
        report.Note(fmt::format("with {}:\n{}", base::Counted(team.robots(), "robot"), table));
      }
      break;
    }
    case Trouble::kSummary: {
      const koord::SummaryDef& summary = *model.summaries[static_cast<size_t>(detail.summary)];
      explored.property = "summary " + summary.function;
      diagnostics
          .Report(Kind::kKoordSummaryBroken, summary.span,
                  fmt::format("a call of `{}` returns what its summary excludes", summary.function))
          .Note(fmt::format("with {} robots, in the round after:\n{}", team.robots(), table));
      break;
    }
  }
  explored.run = koord::semantics::RunToJson(team, run);
}

// Random walks: one state after the other, each successor as likely as any other.
void Walk(Team& team, System& system, const ExplorationOptions& options, Explored& explored,
          diag::Diagnostics& diagnostics) {
  std::mt19937_64 random(options.seed);
  for (uint64_t walk = 0; walk < options.walks && !explored.broken && !options.stop.StopRequested(); ++walk) {
    std::vector<explore::KeptState> path;
    for (uint64_t i = 0; i <= options.steps && !options.stop.StopRequested(); ++i) {
      std::vector<explore::KeptState> next;
      int violated = -1;
      const explore::Visit visit = [&](explore::State state) {
        next.emplace_back(state.begin(), state.end());
        violated = system.Check(state);
        return violated < 0;
      };
      explore::Broken broken = path.empty() ? system.Initial(visit) : system.Successors(path.back(), visit);
      if (violated >= 0) broken = {violated, true};
      if (broken.property >= 0) {
        if (broken.at_visited) path.push_back(next.back());
        return ReportBroken(team, system, path, broken, explored, diagnostics);
      }
      if (next.empty()) break;
      path.push_back(next[random() % next.size()]);
      ++explored.search.transitions;
    }
    ++explored.walked;
  }
}

}  // namespace

std::vector<size_t> DeclaredSizes(const koord::Model& model, diag::Diagnostics& diagnostics) {
  std::vector<size_t> sizes;
  if (!model.exploration.robots.valid()) return sizes;
  const lang::ExprPool& exprs = model.program->exprs;
  const lang::Expr& e = exprs[model.exploration.robots];
  std::vector<koord::ExprId> items{model.exploration.robots};
  if (e.kind == lang::ExprKind::kList) items = e.args;
  for (const koord::ExprId item : items) {
    const lang::Expr& number = exprs[item];
    const bool good = number.kind == lang::ExprKind::kInt && number.text.size() <= 2 && number.text != "0";
    if (good && std::stoul(number.text) <= 64) {
      sizes.push_back(std::stoul(number.text));
    } else {
      diagnostics.Report(Kind::kKoordNotExecutable, number.span,
                         "a team that is explored has 1 to 64 robots");
    }
  }
  if (items.empty())
    diagnostics.Report(Kind::kKoordNotExecutable, e.span, "a team that is explored has 1 to 64 robots");
  return sizes;
}

namespace {

// Parts of the specification that runs are not checked against.
void ReportUnchecked(const Team& team, Explored& explored, diag::Diagnostics& diagnostics) {
  const koord::Model& model = team.model();
  for (const auto& part : team.unchecked()) {
    diagnostics
        .Report(Kind::kKoordNotChecked, part.span,
                fmt::format("runs are not checked against `{}`", part.name))
        .Under(part.reason);
    for (size_t i = 0; i < model.invariants.size(); ++i) {
      if (koord::InvariantName(model, i) == part.name) explored.unchecked.push_back(part.name);
    }
    for (const koord::ResponseDef* def : model.responses) {
      if (def->name == part.name) explored.unchecked.push_back(part.name);
    }
  }
  for (const size_t v : team.zeroed()) explored.zeroed.push_back(model.variables[v].name);
}

// Parameters must be what the specification assumes of them.
bool ParametersFit(Team& team, diag::Diagnostics& diagnostics) {
  std::vector<koord::semantics::Word> nothing(team.layout().words());
  team.machine().SetMemory(nothing.data());
  bool fit = true;
  for (const auto& fact : team.facts()) {
    if (team.Holds(fact)) continue;
    diagnostics.Report(Kind::kKoordNoInitialState, fact.span,
                       fmt::format("the values of the parameters contradict `{}`", fact.name));
    fit = false;
  }
  return fit;
}

void ReportDeadlock(Team& team, System& system, Explored& explored, diag::Diagnostics& diagnostics) {
  const auto run = system.Explain(explored.search.path, {});
  explored.broken = true;
  explored.property = "deadlock";
  explored.run = koord::semantics::RunToJson(team, run);
  diagnostics
      .Report(Kind::kKoordDeadlock, team.model().events[0]->span,
              fmt::format("after {}, no robot can do anything", base::Counted(RoundsOf(run), "round")))
      .Note(fmt::format("with {}:\n{}", base::Counted(team.robots(), "robot"),
                        koord::semantics::Tell(team, run)))
      .Help("a robot that has finished should `stop`");
}

void ReportNoInitialState(const Team& team, Explored& explored, diag::Diagnostics& diagnostics) {
  diagnostics
      .Report(Kind::kKoordNoInitialState,
              team.initially().empty() ? team.model().events[0]->span : team.initially()[0].span,
              fmt::format("no declared state of {} satisfies the assumptions about the initial state",
                          base::Counted(team.robots(), "robot")))
      .Note(explored.zeroed.empty()
                ? std::string("every declared state is refused")
                : fmt::format("zero, false or empty at the start: {}", fmt::join(explored.zeroed, ", ")))
      .Help("give other initial values: `explore:` and, in the block below, `NAME in [...]`");
  explored.broken = true;
}

// Invariants that have no value somewhere, and sensors that have none.
void ReportGaps(const Team& team, const System& system, const std::vector<bool>& undefined_responses,
                Explored& explored, diag::Diagnostics& diagnostics) {
  for (size_t i = 0; i < undefined_responses.size(); ++i) {
    if (!undefined_responses[i]) continue;
    explored.unchecked.push_back(team.responses()[i].name);
    diagnostics
        .Report(Kind::kKoordNotChecked, team.responses()[i].span,
                fmt::format("`{}` is not checked in every state", team.responses()[i].name))
        .Under("in some state an operation in it has no value");
  }
  for (size_t i = 0; i < system.undefined().size(); ++i) {
    if (!system.undefined()[i]) continue;
    const auto& invariant = team.invariants()[i];
    explored.unchecked.push_back(invariant.name);
    diagnostics
        .Report(Kind::kKoordNotChecked, invariant.span,
                fmt::format("`{}` is not checked in every state", invariant.name))
        .Under("in some state an operation in it has no value")
        .Help("say when it is meant: `... implies ...`");
  }
  if (system.stuck()) {
    explored.stuck = true;
    const diag::Span span = team.promises().empty() ? team.model().events[0]->span : team.promises()[0].span;
    diagnostics
        .Report(Kind::kKoordStuck, span,
                "in some state, none of the declared values of the sensors is allowed by the assumptions")
        .Under(fmt::format("for robot {} of {}", *system.stuck(), team.robots()))
        .Help("declare more values for the sensors in `explore`");
  }
}

// A team for one thread of a search. The first one tells of what was found.
struct Member {
  std::unique_ptr<Team> team;
  std::unique_ptr<System> system;
  std::unique_ptr<koord::semantics::TimedSystem> timed;
};

explore::SearchResult SearchAll(std::span<const Member> members, const ExplorationOptions& options,
                                const koord::semantics::SharedValues& shared) {
  const Team& team = *members[0].team;
  explore::SearchOptions search;
  if (options.rounds) search.depth = *options.rounds * members[0].system->phases();
  search.states = options.states;
  search.memory = options.memory;
  // Lists and texts, which lie in blocks of powers of two.
  search.beside = [&] {
    size_t words = shared.words();
    for (const Member& member : members) words += 2 * member.team->heap().words_in_use();
    return words * sizeof(koord::semantics::Word);
  };
  search.compact = options.compact;
  search.deadlocks = options.deadlocks;
  search.progress = options.progress;
  search.stop = options.stop;
  const auto run = [&](auto of) {
    std::vector<std::remove_reference_t<decltype(*of(members[0]))>*> systems;
    for (const Member& member : members) systems.push_back(&*of(member));
    return explore::Search(std::span(std::as_const(systems)), search);
  };
  if (team.responses().empty() || options.only)
    return run([](const Member& m) -> const std::unique_ptr<System>& { return m.system; });
  auto result =
      run([](const Member& m) -> const std::unique_ptr<koord::semantics::TimedSystem>& { return m.timed; });
  result.path = members[0].timed->OfSystem(result.path);
  return result;
}

}  // namespace

Explored Explore(const koord::Model& model, size_t robots, const ExplorationOptions& options,
                 diag::Diagnostics& diagnostics) {
  Explored explored;
  explored.robots = robots;
  explored.unusable = true;
  const unsigned cores = options.jobs > 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
  const size_t count = options.walks > 0 ? 1 : cores;
  koord::semantics::SharedValues shared;
  std::vector<Member> members(count);
  const size_t before = diagnostics.errors();
  for (Member& member : members) {
    diag::Diagnostics again;  // what the first one has said
    diag::Diagnostics& said = &member == members.data() ? diagnostics : again;
    member.team = Team::Make(model, {robots, options.params, options.choices, {}}, said);
    if (member.team == nullptr) return explored;
    // Who waits for how long is told by robots' numbers.
    const bool symmetry = options.symmetry && member.team->responses().empty();
    member.system = std::make_unique<System>(
        *member.team, koord::semantics::SystemOptions{options.reduce, symmetry, options.only}, said,
        count > 1 ? &shared : nullptr);
    member.timed = std::make_unique<koord::semantics::TimedSystem>(*member.system, *member.team);
    if (&member != members.data()) continue;
    explored.symmetric = member.system->symmetric();
    ReportUnchecked(*member.team, explored, diagnostics);
    if (diagnostics.errors() != before || !ParametersFit(*member.team, diagnostics)) return explored;
  }
  Team* const team = members[0].team.get();
  System& system = *members[0].system;
  koord::semantics::TimedSystem& timed = *members[0].timed;
  explored.unusable = false;
  if (options.walks > 0) {
    Walk(*team, system, options, explored, diagnostics);
    for (const auto& response : team->responses()) {
      explored.unchecked.push_back(response.name);
      diagnostics
          .Report(Kind::kKoordNotChecked, response.span,
                  fmt::format("runs are not checked against `{}`", response.name))
          .Under("walks do not count rounds");
    }
  } else {
    explored.search = SearchAll(members, options, shared);
    explored.rounds = explored.search.depth / system.phases();
  }
  std::vector<bool> undefined_responses = timed.responses().undefined();
  explored.branches = team->machine().marks();
  for (size_t m = 1; m < count; ++m) {
    system.TakeIn(*members[m].system);
    const auto& more = members[m].timed->responses().undefined();
    for (size_t i = 0; i < more.size(); ++i) undefined_responses[i] = undefined_responses[i] || more[i];
    const auto& marks = members[m].team->machine().marks();
    for (size_t i = 0; i < marks.size(); ++i) explored.branches[i] = explored.branches[i] || marks[i];
  }
  const explore::SearchResult& search = explored.search;
  const auto late = timed.ResponseOf(search.broken.property);
  if (search.ending == Ending::kBroken && late)
    ReportLate(*team, system, search.path, *late, explored, diagnostics);
  else if (search.ending == Ending::kBroken && search.broken.property >= 0)
    ReportBroken(*team, system, search.path, search.broken, explored, diagnostics);
  if (search.ending == Ending::kDeadlock) ReportDeadlock(*team, system, explored, diagnostics);
  if (options.walks == 0 && search.initial == 0 && search.ending == Ending::kComplete)
    ReportNoInitialState(*team, explored, diagnostics);
  ReportGaps(*team, system, undefined_responses, explored, diagnostics);
  explored.enabled = system.enabled();
  for (const auto& [stmt, otherwise] : team->branches())
    explored.branch_spans.push_back(otherwise && !stmt->has_else ? diag::Span{} : stmt->span);
  return explored;
}

std::vector<Explored> ExploreSizes(
    const koord::Model& model, const std::vector<size_t>& sizes, const ExplorationOptions& options,
    const std::function<void(size_t, const explore::SearchOptions::Progress&)>& progress,
    diag::Diagnostics& diagnostics) {
  constexpr uint64_t kFirstTurn = 200'000;  // states
  constexpr uint64_t kMore = 8;  // times as many in the next one: what is done again is a seventh of the work
  std::map<size_t, Explored> found;
  std::map<size_t, diag::Diagnostics> reports;
  std::vector<size_t> open = sizes;
  bool over = false;
  for (uint64_t turn = options.walks > 0 ? options.states : kFirstTurn; !open.empty() && !over;
       turn *= kMore) {
    const bool last = turn >= options.states || open.size() == 1;  // nobody waits
    std::vector<size_t> unfinished;
    for (const size_t n : open) {
      ExplorationOptions now = options;
      now.states = last ? options.states : turn;
      if (progress) now.progress = [&](const explore::SearchOptions::Progress& p) { progress(n, p); };
      reports[n] = {};
      Explored& e = found[n] = Explore(model, n, now, reports[n]);
      // What cannot be run with one size cannot with another.
      over = e.broken || e.unusable || options.stop.cancelled();
      if (over) break;
      if (e.search.ending == Ending::kStates && !last) unfinished.push_back(n);
    }
    for (const size_t n : open) {
      const auto e = found.find(n);
      if (!over || last || e == found.end() || e->second.search.ending != Ending::kStates) continue;
      if (options.stop.cancelled()) e->second.search.ending = Ending::kStopped;
      e->second.left = !options.stop.cancelled();
    }
    open = std::move(unfinished);
  }
  std::vector<Explored> all;
  for (auto& [n, e] : found) {
    for (const diag::Diagnostic& d : reports[n].all()) diagnostics.Report(d.kind, d.span, d.message) = d;
    all.push_back(std::move(e));
  }
  return all;
}

}  // namespace rondo::runs
