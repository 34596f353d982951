#include "runs/replay.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "koord/semantics/story.h"
#include "runs/campaign_trace.h"
#include "runs/choreography_runs.h"
#include "runs/execution_file.h"
#include "runs/fleet_files.h"
#include "runs/run_file.h"
#include "runs/trace_copy.h"
#include "sim/draw/history.h"
#include "sim/network.h"
#include "sim/simulation.h"
#include "trace/reader.h"
#include "workspace/koord_files.h"

namespace rondo::runs {
namespace {

// A run that breaks a property: every step must be one of the program's.
Replayed ReplaySteps(const RunFile& run, const koord::Model& model) {
  if (run.robots < 1 || run.robots > 64) return {false, "the run is not complete"};
  diag::Diagnostics problems;
  koord::semantics::TeamOptions team_options;
  team_options.robots = run.robots;
  koord::semantics::Heap heap;
  AdoptParameters(run, model, team_options, heap);
  const auto team = koord::semantics::Team::Make(model, team_options, problems, std::move(heap));
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

Replayed ReplayRun(const RunFile& run, workspace::Session& session) {
  const auto loaded = workspace::LoadKoord({run.program, run.spec, true}, session);
  if (!loaded) return {false, fmt::format("the program `{}` cannot be used", run.program)};
  return ReplaySteps(run, loaded->model);
}

// A run of the explorer, kept as a trace.
Replayed ReplayExplored(const std::string& bytes, const nlohmann::json& record, workspace::Session& session) {
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
  const auto loaded = workspace::LoadKoordTexts("program", sim::TextOf(record, "program"),
                                                sim::TextOf(record, "spec"), session);
  if (!loaded) return {false, "the program that the trace keeps cannot be used"};
  return ReplaySteps(run, loaded->model);
}

// A simulation: again from the texts and the seed that it keeps.
Replayed ReplayTrace(const std::string& bytes, workspace::Session& session, const ReplayOptions& replay) {
  const auto history = sim::ReadHistory(bytes);
  if (!history.ok()) return {false, history.error().message};
  const nlohmann::json& run = history.value().run;
  if (sim::TextOf(run, "engine") == "campaign") return ReplayCampaign(bytes, run, session);
  if (sim::TextOf(run, "engine") == "explore") return ReplayExplored(bytes, run, session);
  if (sim::TextOf(run, "engine") == "choreography") return ReplayChoreography(bytes, run, session, replay);
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
  const auto loaded = workspace::LoadKoordTexts(options.program_name, options.program, options.spec, session);
  if (!loaded) return {false, "the program that the trace keeps cannot be used"};
  const diag::FileId file = session.sources.Add("fleet", options.fleet);
  const auto kept = FilesFromJson(run.value("files", nlohmann::json::object()));
  if (!kept) return {false, "the files that the trace keeps are damaged"};
  if (!kept->empty()) options.files = ToJson(*kept);
  const sim::Fleet fleet = FleetFiles(*kept, session).Read(file);
  if (session.diagnostics.has_errors()) return {false, "the fleet that the trace keeps cannot be used"};
  sim::NetworkFaults network;
  if (run.contains("network")) {
    options.network_text = sim::TextOf(run, "network");
    const diag::FileId text = session.sources.Add("network", options.network_text);
    network = sim::ReadNetwork(session.sources, text, fleet, session.diagnostics);
    if (session.diagnostics.has_errors()) return {false, "the network that the trace keeps cannot be used"};
    options.network = &network;
  }
  sim::SimulationReport report;
  options.stop = replay.stop;
  options.progress = replay.progress;
  const auto fresh = CopyOf([&](const std::string& path) -> base::Result<bool> {
    auto writer = trace::Writer::Open(path);
    if (!writer.ok()) return writer.error();
    trace::Writer again = std::move(writer).value();
    diag::Diagnostics said;  // what the run violates was said when it was made
    report = sim::Simulate(loaded->model, fleet, options, &again, said);
    return again.Finish();
  });
  if (report.ended == sim::Ending::kInterrupted) return {false, "interrupted", true};
  if (!fresh.ok()) return {false, fresh.error().message};
  if (fresh.value() == bytes)
    return {true, fmt::format("the same run, bit for bit: {:.6g} s, {} rounds, {} bytes", report.time,
                              report.rounds, bytes.size())};
  return {false, "differs: " + FirstDifference(bytes, fresh.value())};
}

}  // namespace

Replayed Replay(const std::string& bytes, workspace::Session& session, const ReplayOptions& options) {
  if (bytes.starts_with("\x89MCAP")) return ReplayTrace(bytes, session, options);
  if (IsExecution(bytes)) {
    const auto execution = ReadExecution(bytes);
    if (!execution.ok()) return {false, execution.error().message};
    const auto told = ReplayExecution(execution.value(), session);
    return {told.ok(), told.ok() ? told.value() : told.error().message};
  }
  const auto run = ReadRun(bytes);
  if (!run.ok()) return {false, run.error().message};
  return ReplayRun(run.value(), session);
}

}  // namespace rondo::runs
