#include "runs/choreography_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runs/trace_copy.h"
#include "sim/draw/history.h"
#include "sim/draw/stage_history.h"

namespace rondo::runs {

using nlohmann::json;

namespace {

choreo::Graph* Find(workspace::LoadedModule& module, const std::string& name, workspace::Session& session) {
  std::vector<std::string> names;
  for (choreo::Graph& graph : module.graphs) {
    names.push_back(fmt::format("`{}`", graph.source->name.text));
    if (name.empty() ? module.graphs.size() == 1 : graph.source->name.text == name) return &graph;
  }
  if (names.empty()) {
    session.diagnostics.Report(diag::Kind::kChoreoMissing, {}, "there is no choreography to simulate");
  } else if (name.empty()) {
    session.diagnostics
        .Report(diag::Kind::kChoreoMissing, {}, "nothing says which choreography is to be simulated")
        .Help(fmt::format("`--choreography`: one of {}", fmt::join(names, ", ")));
  } else {
    session.diagnostics
        .Report(diag::Kind::kChoreoMissing, {}, fmt::format("there is no choreography `{}`", name))
        .Help(fmt::format("there is {}", fmt::join(names, ", ")));
  }
  return nullptr;
}

}  // namespace

std::optional<StagedChoreography> StageChoreography(const ChoreographyFiles& files,
                                                    workspace::Session& session) {
  StagedChoreography staged{workspace::LoadModule(files.files, files.admitted, session), {}};
  const auto conditions = workspace::CheckStructure(*staged.module, session);
  if (!conditions || session.diagnostics.has_errors()) return std::nullopt;
  choreo::Graph* graph = Find(*staged.module, files.choreography, session);
  if (graph == nullptr) return std::nullopt;
  staged.cast =
      choreo::MakeCast(staged.module->module, *graph, *staged.module->declarations, files.projections);
  return staged;
}

json RecordOf(const ChoreographyFiles& files, const StagedChoreography& staged,
              const sim::motions::ChoreographyOptions& options, const workspace::Session& session) {
  json robots = json::array(), texts = json::object();
  for (const choreo::Name& robot : staged.cast.graph->robots)
    robots.push_back({{"name", robot.text}, {"radius", 0.0}});
  for (size_t f = 0; f < session.sources.size(); ++f)
    texts[std::string(session.sources.path(diag::FileId(f)))] =
        std::string(session.sources.text(diag::FileId(f)));
  return {{"format", "rondo-trace/1"},
          {"engine", "choreography"},
          {"program_name", std::filesystem::path(files.files.front()).filename().string()},
          {"choreography", staged.cast.graph->source->name.text},
          {"files", files.files},
          {"admitted", files.admitted},
          {"projections", files.projections},
          {"texts", texts},
          {"robots", robots},
          {"seed", options.seed},
          {"duration", options.duration}};
}

base::Result<sim::motions::ChoreographyReport> RecordChoreography(
    const StagedChoreography& staged, const sim::motions::ChoreographyOptions& options, const json& record,
    const std::string& path) {
  std::error_code ignored;
  const json texts = record.value("texts", json::object());
  for (const auto& [source, text] : texts.items()) {
    if (std::filesystem::equivalent(source, path, ignored))
      return base::Error{fmt::format("`{}` is what is simulated: the trace would take its place", path)};
  }
  auto opened = trace::Writer::Open(path);
  if (!opened.ok()) return base::Error{fmt::format("cannot write `{}`: {}", path, opened.error().message)};
  trace::Writer writer = std::move(opened).value();
  sim::motions::StageRecorder recorder(writer, *staged.cast.graph, staged.module->arena, record);
  const auto report = sim::motions::RunChoreography(staged.cast, options, &recorder);
  const auto done = writer.Finish();
  if (!done.ok()) return base::Error{fmt::format("cannot write `{}`: {}", path, done.error().message)};
  return report;
}

std::optional<StagedChoreography> StageRecorded(const json& record, workspace::Session& session) {
  ChoreographyFiles files;
  std::map<std::string, std::string> texts;
  try {
    record.at("files").get_to(files.files);
    record.at("admitted").get_to(files.admitted);
    record.at("choreography").get_to(files.choreography);
    record.at("projections").get_to(files.projections);
    record.at("texts").get_to(texts);
  } catch (const json::exception&) {
    return std::nullopt;
  }
  if (files.files.empty()) return std::nullopt;
  session.read = [texts](const std::string& path) -> base::Result<std::string> {
    const auto it = texts.find(path);
    if (it == texts.end()) return base::Error{"the trace does not keep it"};
    return it->second;
  };
  return StageChoreography(files, session);
}

Replayed ReplayChoreography(const std::string& bytes, const json& record, workspace::Session& session,
                            const ReplayOptions& replay) {
  if (record.contains("live"))
    return {false,
            "robots made this run, not the simulator: their logs can be judged (`rondo replay LOG...`)"};
  const auto staged = StageRecorded(record, session);
  if (!staged) return {false, "the choreography that the trace keeps cannot be used"};
  if (!record.contains("seed") || !record["seed"].is_number_unsigned() || !record.contains("duration") ||
      !record["duration"].is_number())
    return {false, "the record of the run is damaged"};
  sim::motions::ChoreographyOptions options;
  options.seed = record["seed"].get<uint64_t>();
  options.duration = record["duration"].get<double>();
  options.stop = replay.stop;
  options.progress = replay.progress;
  const auto history = sim::ReadStageHistory(bytes);
  if (!history.ok()) return {false, history.error().message};
  if (history.value().why == Name(sim::motions::Curtain::kInterrupted))
    options.interrupt_at = history.value().end - 0.5e-9;  // nanoseconds, as seconds
  base::Result<sim::motions::ChoreographyReport> report = base::Error{};
  const auto fresh = CopyOf([&](const std::string& path) -> base::Result<bool> {
    report = RecordChoreography(*staged, options, record, path);
    return report.ok() ? base::Result<bool>(true) : report.error();
  });
  if (!fresh.ok()) return {false, fresh.error().message};
  if (replay.stop.StopRequested()) return {false, "interrupted", true};
  if (fresh.value() == bytes)
    return {true,
            fmt::format("the same run, bit for bit: {:.6g} s, {} messages, {} motions, {} bytes",
                        report.value().time, report.value().messages, report.value().motions, bytes.size())};
  return {false, "differs: " + FirstDifference(bytes, fresh.value())};
}

}  // namespace rondo::runs
