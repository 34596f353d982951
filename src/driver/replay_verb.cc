#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/replay.h"
#include "trace/reader.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string file;
  bool json = false;
};

ExitStatus Tell(const Options& options, const runs::Replayed& replayed, const workspace::Session& session) {
  const ExitStatus status = replayed.same          ? ExitStatus::kEstablished
                            : replayed.interrupted ? ExitStatus::kUndecided
                                                   : ExitStatus::kRejected;
  if (options.json) {
    PrintJson({{"command", "replay"},
               {"file", options.file},
               {"same", replayed.same},
               {"text", replayed.text},
               {"status", status},
               {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
    return status;
  }
  if (session.diagnostics.has_errors()) PrintDiagnostics(session.sources, session.diagnostics);
  if (!replayed.text.empty()) Print(fmt::format("{}: {}\n", options.file, replayed.text));
  return status;
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  const auto bytes = trace::ReadTrace(options.file);
  if (!bytes.ok()) {
    session.diagnostics.Report(diag::Kind::kFileUnreadable, {},
                               fmt::format("cannot read `{}`: {}", options.file, bytes.error().message));
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
  verb.Option("FILE", options->file,
              "a trace of `rondo simulate`, or a run that `rondo explore` or `rondo reach` saved")
      .Required();
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo replay mapping.mcap\n"
      "  rondo replay run.json\n"
      "\n"
      "A trace keeps the texts of its program, specification and fleet: it replays without them.\n"
      "exit status: 0 the same run, 1 it differs (and where), 3 interrupted");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
