#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "driver/command.h"
#include "driver/course_file.h"
#include "driver/exit_status.h"
#include "driver/interrupt.h"
#include "driver/koord_load.h"
#include "driver/run_file.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/semantics/story.h"
#include "sim/draw/history.h"
#include "sim/simulation.h"
#include "trace/reader.h"

namespace rondo::driver {
namespace {

struct Options {
  std::string file;
  bool json = false;
};

struct Verdict {
  bool same = false;
  std::string text;
};

int Tell(const Options& options, const Verdict& verdict, const Session& session) {
  const int status = verdict.same ? kEstablished : kRejected;
  if (options.json) {
    PrintJson({{"command", "replay"},
               {"file", options.file},
               {"same", verdict.same},
               {"text", verdict.text},
               {"status", status},
               {"diagnostics", DiagnosticsToJson(session.sources, session.diagnostics)}});
    return status;
  }
  if (session.diagnostics.has_errors()) PrintDiagnostics(session.sources, session.diagnostics);
  Print(fmt::format("{}: {}\n", options.file, verdict.text));
  return status;
}

// A run that breaks a property: every step must be one of the program's.
Verdict ReplaySteps(const RunFile& run, const koord::Model& model) {
  if (run.robots < 1 || run.robots > 64) return {false, "the run is not complete"};
  diag::Diagnostics problems;
  koord::semantics::TeamOptions team_options;
  team_options.robots = run.robots;
  AdoptParameters(run, model, team_options);
  const auto team = koord::semantics::Team::Make(model, team_options, problems);
  if (!team) {
    return {false,
            fmt::format("the program cannot be executed: {}",
                        problems.all().empty() ? std::string("no reason") : problems.all()[0].message)};
  }
  const std::string differs = koord::semantics::Replay(*team, run.steps, run.property);
  if (!differs.empty()) return {false, differs};
  return {true, fmt::format("replayed: {} steps of {} robots; it breaks {}", run.steps.size(), run.robots,
                            run.property)};
}

Verdict ReplayRun(const RunFile& run, Session& session) {
  const auto loaded = LoadKoord({run.program, run.spec, true}, session);
  if (!loaded) return {false, fmt::format("the program `{}` cannot be used", run.program)};
  return ReplaySteps(run, loaded->model);
}

std::string Name(const trace::Message& m) {
  return fmt::format("{} at t = {:.6f} s", m.topic, static_cast<double>(m.time) * 1e-9);
}

// Where do two traces differ first?
std::string FirstDifference(std::string_view a, std::string_view b) {
  struct Kept {
    std::string name;
    std::string bytes;
    uint64_t time;
  };
  std::vector<Kept> first;
  const auto keep = trace::ForEachMessage(a, [&](const trace::Message& m) {
    first.push_back({Name(m), std::string(m.topic) + std::string(m.bytes), m.time});
    return true;
  });
  if (!keep.ok()) return keep.error().message;
  size_t i = 0;
  std::string result;
  const auto compare = trace::ForEachMessage(b, [&](const trace::Message& m) {
    if (i >= first.size())
      result = fmt::format("the run goes on: {}", Name(m));
    else if (first[i].time != m.time || first[i].bytes != std::string(m.topic) + std::string(m.bytes))
      result = first[i].name == Name(m) ? first[i].name
                                        : fmt::format("{} in the trace, {} now", first[i].name, Name(m));
    ++i;
    return result.empty();
  });
  if (!compare.ok()) return compare.error().message;
  if (result.empty() && i < first.size())
    result = fmt::format("the run ends earlier: {} is missing", first[i].name);
  return result.empty() ? "the messages are the same; the files differ in their index" : result;
}

// A run of the explorer, kept as a trace.
Verdict ReplayExplored(const std::string& bytes, const nlohmann::json& record, Session& session) {
  RunFile run;
  run.property = sim::TextOf(record, "breaks");
  run.robots = record.contains("robots") && record["robots"].is_array() ? record["robots"].size() : 0;
  run.params = record.value("params", nlohmann::json::object());
  run.choices = record.value("choices", nlohmann::json::object());
  run.steps = nlohmann::json::array();
  const auto read = trace::ForEachMessage(bytes, [&](const trace::Message& m) {
    if (m.topic == "/rondo/step") run.steps.push_back(nlohmann::json::parse(m.bytes, nullptr, false));
    return true;
  });
  if (!read.ok()) return {false, read.error().message};
  const auto loaded =
      LoadKoordTexts("program", sim::TextOf(record, "program"), sim::TextOf(record, "spec"), session);
  if (!loaded) return {false, "the program that the trace keeps cannot be used"};
  return ReplaySteps(run, loaded->model);
}

// A simulation: again from the texts and the seed that it keeps.
Verdict ReplayTrace(const std::string& bytes, Session& session) {
  const auto history = sim::ReadHistory(bytes);
  if (!history.ok()) return {false, history.error().message};
  const nlohmann::json& run = history.value().run;
  if (sim::TextOf(run, "engine") == "explore") return ReplayExplored(bytes, run, session);
  sim::SimulationOptions options;
  options.program = sim::TextOf(run, "program");
  options.spec = sim::TextOf(run, "spec");
  options.fleet = sim::TextOf(run, "fleet");
  options.program_name = sim::TextOf(run, "program_name");
  if (!run.contains("seed") || !run["seed"].is_number_unsigned() || !run.contains("duration") ||
      !run["duration"].is_number())
    return {false, "the record of the run is damaged"};
  options.seed = run["seed"].get<uint64_t>();
  options.duration = run["duration"].get<double>();
  const auto loaded = LoadKoordTexts(options.program_name, options.program, options.spec, session);
  if (!loaded) return {false, "the program that the trace keeps cannot be used"};
  const diag::FileId file = session.sources.Add("fleet", options.fleet);
  const sim::Fleet fleet = sim::ReadFleet(session.sources, file, session.diagnostics);
  if (session.diagnostics.has_errors()) return {false, "the fleet that the trace keeps cannot be used"};
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("rondo-replay-{}.mcap", ::getpid());
  auto writer = trace::Writer::Open(path.string());
  if (!writer.ok())
    return {false, fmt::format("cannot write `{}`: {}", path.string(), writer.error().message)};
  sim::SimulationReport report;
  {
    ProgressLine line;
    const InterruptScope interrupt(options.stop);
    trace::Writer again = std::move(writer).value();
    options.progress = [&](double time, double end) {
      line.Show(fmt::format("[{:.0f} of {:.0f} s]", time, end));
    };
    diag::Diagnostics said;  // what the run violates was said when it was made
    report = sim::Simulate(loaded->model, fleet, options, &again, said);
    const auto done = again.Finish();
    if (!done.ok()) return {false, fmt::format("cannot write `{}`: {}", path.string(), done.error().message)};
  }
  auto fresh = trace::ReadTrace(path.string());
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  if (report.ended == "interrupted") return {false, "interrupted"};
  if (!fresh.ok()) return {false, fresh.error().message};
  if (fresh.value() == bytes)
    return {true, fmt::format("the same run, bit for bit: {:.6g} s, {} rounds, {} bytes", report.time,
                              report.rounds, bytes.size())};
  return {false, "differs: " + FirstDifference(bytes, fresh.value())};
}

int Run(const Options& options) {
  Session session;
  const auto bytes = trace::ReadTrace(options.file);
  if (!bytes.ok()) {
    PrintFailure(fmt::format("cannot read `{}`: {}", options.file, bytes.error().message));
    return kRejected;
  }
  if (bytes.value().starts_with("\x89MCAP"))
    return Tell(options, ReplayTrace(bytes.value(), session), session);
  if (IsCourse(bytes.value())) {
    const auto course = ReadCourse(bytes.value());
    if (!course.ok()) {
      PrintFailure(fmt::format("`{}`: {}", options.file, course.error().message));
      return kRejected;
    }
    const auto told = ReplayCourse(course.value(), session);
    return Tell(options, {told.ok(), told.ok() ? told.value() : told.error().message}, session);
  }
  const auto run = LoadRun(options.file);
  if (!run.ok()) {
    PrintFailure(fmt::format("`{}`: {}", options.file, run.error().message));
    return kRejected;
  }
  return Tell(options, ReplayRun(run.value(), session), session);
}

}  // namespace

void AddReplayVerb(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "replay", "run a trace or counterexample again, and compare");
  verb.Option("FILE", options->file,
              "a trace of `rondo simulate`, or a run that `rondo explore` or `rondo reach` saved")
      .Required();
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n  rondo replay mapping.mcap\n  rondo replay run.json\n\n"
      "A trace keeps the texts of its program, specification and fleet: it replays without them.\n"
      "exit status: 0 the same run, 1 it differs (and where)");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
