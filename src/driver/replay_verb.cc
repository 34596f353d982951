#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "driver/choreography_robots.h"
#include "driver/command.h"
#include "driver/logs_text.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/replay.h"
#include "runs/robot_files.h"
#include "sim/draw/history.h"
#include "trace/reader.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  bool json = false;
};

ExitStatus Tell(const Options& options, const runs::Replayed& replayed, const workspace::Session& session) {
  const ExitStatus status = replayed.same          ? ExitStatus::kEstablished
                            : replayed.interrupted ? ExitStatus::kUndecided
                                                   : ExitStatus::kRejected;
  if (options.json) {
    PrintJson({{"command", "replay"},
               {"file", options.files[0]},
               {"same", replayed.same},
               {"text", replayed.text},
               {"status", status},
               {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
    return status;
  }
  if (session.diagnostics.has_errors()) PrintDiagnostics(session.sources, session.diagnostics);
  if (!replayed.text.empty()) Print(fmt::format("{}: {}\n", options.files[0], replayed.text));
  return status;
}

// Logs of robots are judged together; they cannot be run again.
ExitStatus Judge(const Options& options, const std::vector<deploy::RobotLog>& logs) {
  workspace::Session session;
  const auto fail = [&](const std::string& why) {
    if (options.json) {
      PrintJson({{"command", "replay"},
                 {"files", options.files},
                 {"status", ExitStatus::kRejected},
                 {"error", why},
                 {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
      return ExitStatus::kRejected;
    }
    PrintDiagnostics(session.sources, session.diagnostics);
    PrintFailure(why);
    return ExitStatus::kRejected;
  };
  const auto program = runs::LoadRobotProgram(logs[0].run, session);
  if (!program) return fail("the program that the log keeps cannot be used");
  base::Result<deploy::LogsReport> judged = base::Error{};
  {
    const base::StopToken stop;
    const InterruptScope interrupt(stop);
    judged = deploy::JudgeLogs(logs, program->loaded->model, program->fleet, stop, session.diagnostics);
  }
  if (!judged.ok()) return fail(judged.error().message);
  const ExitStatus status = LogsStatus(judged.value());
  if (options.json) {
    nlohmann::json out = LogsJson(judged.value());
    out["command"] = "replay";
    out["files"] = options.files;
    out["status"] = status;
    out["diagnostics"] = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson(out);
    return status;
  }
  Print(fmt::format("{} of {}\n{}", base::Counted(logs.size(), "log"),
                    sim::TextOf(logs[0].run, "program_name"), LogsText(judged.value())));
  PrintDiagnostics(session.sources, session.diagnostics);
  return status;
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  std::vector<deploy::RobotLog> logs;
  std::vector<deploy::SessionLog> parts;
  for (const std::string& file : options.files) {
    if (auto part = deploy::ReadSessionLog(file); part.ok()) {
      parts.push_back(std::move(part).value());
      continue;
    }
    auto log = deploy::ReadRobotLog(file);
    if (log.ok()) logs.push_back(std::move(log).value());
    if (!log.ok() && options.files.size() > 1) {
      session.diagnostics
          .Report(diag::Kind::kFileUnreadable, {},
                  fmt::format("cannot read `{}`: {}", file, log.error().message))
          .Help("several files are logs of robots (`rondo run --log`, `rondo launch --logs`)");
      return Tell(options, {}, session);
    }
  }
  if (!logs.empty() && !parts.empty()) {
    session.diagnostics.Report(diag::Kind::kFileUnreadable, {},
                               "some of these are logs of a Koord program, others of a choreography");
    return Tell(options, {}, session);
  }
  if (!parts.empty()) return JudgeChoreography(parts, options.files[0], options.json);
  if (!logs.empty()) return Judge(options, logs);
  const auto bytes = trace::ReadTrace(options.files[0]);
  if (!bytes.ok()) {
    session.diagnostics.Report(diag::Kind::kFileUnreadable, {},
                               fmt::format("cannot read `{}`: {}", options.files[0], bytes.error().message));
    return Tell(options, {}, session);
  }
  runs::Replayed replayed;
  {
    ProgressLine line;
    runs::ReplayOptions replay;
    const InterruptScope interrupt(replay.stop);
    replay.progress = [&](double time, double end) {
      line.Show(fmt::format("[{:.0f} of {:.0f} s]", time, end));
    };
    replayed = runs::Replay(bytes.value(), session, replay);
  }
  return Tell(options, replayed, session);
}

}  // namespace

void AddReplayVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "replay", "run a trace or counterexample again, and compare");
  verb.Option(
          "FILE", options->files,
          "a trace of `rondo simulate`, or a run that `rondo explore` or `rondo reach` saved; or the logs of all robots of a fleet")
      .Required();
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo replay mapping.mcap\n"
      "  rondo replay run.json\n"
      "  rondo replay logs/*.mcap\n"
      "\n"
      "A trace keeps the texts of its program, specification and fleet: it replays without them. What robots logged cannot be\n"
      "run again; it is judged: each round by the program, each final state by its invariants.\n"
      "exit status: 0 the same run, or nothing is wrong in the logs; 1 it differs (and where), or something is wrong;\n"
      "3 interrupted, or not everything could be judged");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
