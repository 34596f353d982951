#include "runs/exploration_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfenv>

#include "base/counted.h"
#include "koord/check/spec_labels.h"
#include "koord/semantics/responses.h"
#include "koord/semantics/story.h"

namespace rondo::runs {

using diag::Kind;
using koord::semantics::System;
using koord::semantics::Team;
using koord::semantics::Trouble;

namespace {

size_t RoundsOf(const std::vector<koord::semantics::Step>& run) {
  return static_cast<size_t>(std::count_if(run.begin() + (run.empty() ? 0 : 1), run.end(),
                                           [](const auto& step) { return !step.environment; }));
}

}  // namespace

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

}  // namespace rondo::runs
