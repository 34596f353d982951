#include "runs/exploration.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include "koord/semantics/system.h"
#include "koord/semantics/timed_system.h"
#include "runs/exploration_reports.h"

namespace rondo::runs {
namespace {

using diag::Kind;
using explore::Ending;
using koord::semantics::System;
using koord::semantics::Team;

// Random walks: one state after the other, each successor as likely as any other.
void Walk(Team& team, System& system, const ExplorationOptions& options, Explored& explored,
          diag::Diagnostics& diagnostics) {
  std::mt19937_64 random(options.seed);
  explored.enabled.resize(team.events().size());
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
      for (size_t e = 0; e < explored.enabled.size() && !path.empty(); ++e)
        explored.enabled[e] += system.Marks()[e / 64] >> e % 64 & 1;
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

// A team for one thread of a search. The first one tells of what was found.
struct Member {
  std::unique_ptr<Team> team;
  std::unique_ptr<System> system;
  std::unique_ptr<koord::semantics::TimedSystem> timed;
};

template <typename S>
explore::SearchResult SearchWith(std::span<const Member> members, std::unique_ptr<S> Member::*which,
                                 const explore::SearchOptions& search) {
  std::vector<S*> systems;
  for (const Member& member : members) systems.push_back((member.*which).get());
  return explore::Search(std::span<S* const>(systems), search);
}

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
  if (team.responses().empty() || options.only) return SearchWith(members, &Member::system, search);
  auto result = SearchWith(members, &Member::timed, search);
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
  if (options.walks == 0)
    explored.enabled.assign(search.marked.begin(),
                            search.marked.begin() + static_cast<ptrdiff_t>(team->events().size()));
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
