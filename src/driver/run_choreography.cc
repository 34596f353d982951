#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "driver/choreography_robots.h"
#include "driver/terminal.h"
#include "lang/suggest.h"

namespace rondo::driver {

using runtime::sessions::Outcome;
using verdict::ExitStatus;

namespace {

ExitStatus StatusOf(const deploy::PlayerReport& report) {
  const bool bad =
      report.outcome == Outcome::kFailed || report.outcome == Outcome::kLost || report.broken > 0;
  return bad ? ExitStatus::kRejected : ExitStatus::kEstablished;
}

std::string Tell(const deploy::PlayerReport& report) {
  std::string text =
      fmt::format("  {:.1f} s, {} taken, {}\n", report.time, base::Counted(report.messages, "message"),
                  base::Counted(report.motions, "motion"));
  if (report.missed > 0)
    text += fmt::format("  contracts kept up to {:.2g} (SI units): `{}` missed most\n", report.missed,
                        report.missed_by);
  if (report.late > kTellLate)
    text += fmt::format("  motions took up to {:.2f} s longer than they may\n", report.late);
  if (report.broken > 0)
    text += fmt::format("  {} missed theirs by more than `--tolerance`\n",
                        base::Counted(report.broken, "motion"));
  switch (report.outcome) {
    case Outcome::kOver:
      return text + "  the choreography is over\n";
    case Outcome::kLeft:
    case Outcome::kOpen:
      return text + (report.time_over ? "  its time is over: it stays where it is\n"
                                      : "  interrupted: it stays where it is\n");
    case Outcome::kFailed:
      return text + fmt::format("  it could not go on, and stays where it is: {}\n", report.why);
    case Outcome::kStopped:
      return text + fmt::format("  stopped, and stays where it is: {}\n", report.why);
    case Outcome::kLost:
      return text + fmt::format("  it gave up, and stays where it is: {}\n", report.why);
  }
  return text;
}

}  // namespace

ExitStatus RunChoreography(const RunChoreographyOptions& options) {
  workspace::Session session;
  const std::string& file = options.files.files.front();
  const auto fail = [&](const std::string& why) {
    return Refuse("run", file, options.json, session.sources, session.diagnostics, why);
  };
  const auto staged = runs::StageChoreography(options.files, session);
  if (!staged) return fail("");
  const choreo::Graph& graph = *staged->cast.graph;
  const auto robot = graph.Find(options.robot);
  if (!robot) {
    std::vector<std::string> names;
    for (const choreo::Name& r : graph.robots) names.push_back(r.text);
    const std::string near = lang::Suggest(options.robot, names);
    return fail(fmt::format("`{}` has no robot `{}`: {}", graph.source->name.text, options.robot,
                            near.empty() ? fmt::format("it has {}", fmt::join(names, ", "))
                                         : fmt::format("did you mean `{}`?", near)));
  }
  const auto network = runs::ChoreographyNetwork();
  if (!network.ok()) return fail(network.error().message);
  deploy::PlayerOptions run = options.run;
  run.robot = *robot;
  run.network = network.value();
  run.program = graph.source->name.text;
  run.record = runs::LogRecordOf(options.files, *staged, session);
  run.agreement = deploy::AgreementOf(run.record);
  if (!options.json) {
    run.tell = [&](const std::string& text) { PrintError(fmt::format("{}: {}\n", options.robot, text)); };
    run.tell(fmt::format("domain {}; DDS without security: whoever is in the network can disturb it",
                         run.network.domain));
  }
  base::Result<deploy::PlayerReport> ran = base::Error{};
  {
    const InterruptScope interrupt(run.stop);
    ran = deploy::RunPlayer(staged->cast, run);
  }
  if (!ran.ok()) return fail(ran.error().message);
  const deploy::PlayerReport& report = ran.value();
  const ExitStatus status = StatusOf(report);
  if (options.json) {
    PrintJson(
        {{"command", "run"},
         {"file", file},
         {"choreography", graph.source->name.text},
         {"robot", options.robot},
         {"ended", Name(report.outcome)},
         {"why", report.why},
         {"time", report.time},
         {"messages", report.messages},
         {"motions", report.motions},
         {"missed",
          {{"most", std::isfinite(report.missed) ? nlohmann::json(report.missed) : nlohmann::json(nullptr)},
           {"motion", report.missed_by},
           {"broken", report.broken},
           {"late", report.late}}},
         {"log", report.log},
         {"status", status},
         {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
    return status;
  }
  Print(fmt::format("{}: {}\n{}", graph.source->name.text, options.robot, Tell(report)));
  if (!report.log.empty()) Print(fmt::format("log: {}\n", report.log));
  PrintDiagnostics(session.sources, session.diagnostics);
  return status;
}

}  // namespace rondo::driver
