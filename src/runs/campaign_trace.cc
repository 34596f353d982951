#include "runs/campaign_trace.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/hex.h"
#include "koord/semantics/story.h"
#include "runs/campaign_teams.h"
#include "runs/trace_copy.h"
#include "sim/campaign/scenario_file.h"
#include "sim/draw/history.h"
#include "trace/writer.h"
#include "workspace/koord_files.h"

namespace rondo::runs {
namespace {

using history::Entry;
using history::Kind;
using nlohmann::json;
namespace campaign = sim::campaign;

json LineOf(const history::Record& record, const Entry& e, koord::semantics::Team& team) {
  json line{{"robot", e.robot}, {"life", e.incarnation}, {"did", history::Name(e.kind)},
            {"epoch", e.epoch}, {"round", e.round},      {"stamp", static_cast<double>(e.stamp) * 1e-9}};
  const auto state = [&] { return StateToJson(team, history::StateOf(team, record.images[e.what])); };
  switch (e.kind) {
    case Kind::kStored:
      line["state"] = state();
      break;
    case Kind::kFellBack:
      if (e.what != history::kNothing) line["state"] = state();
      break;
    case Kind::kContributed:
      line["frame"] = base::Hex(record.texts[e.what]);
      for (const uint32_t event : e.waits) line["waits"].push_back(team.events()[event].def->name);
      break;
    case Kind::kActed:
      line["until"] = static_cast<double>(e.until) * 1e-9;
      break;
    case Kind::kAdopted:
      for (const history::Life& life : record.members[e.what])
        line["members"].push_back({{"robot", life.robot}, {"life", life.incarnation}});
      break;
    case Kind::kStarted:
    case Kind::kCrashed:
    case Kind::kCommitted:
      break;
  }
  return line;
}

}  // namespace

base::Result<bool> WriteCampaignTrace(const std::string& path, const CampaignTexts& texts,
                                      const campaign::Trial& trial, koord::semantics::Team& team) {
  auto opened = trace::Writer::Open(path);
  if (!opened.ok()) return opened.error();
  trace::Writer writer = std::move(opened).value();
  json robots = json::array(), findings = json::array();
  for (size_t r = 0; r < trial.scenario.robots; ++r)
    robots.push_back({{"name", fmt::format("robot{}", r)}, {"radius", 0.2}});
  for (const auto& f : trial.findings)
    findings.push_back({{"wrong", history::Name(f.wrong)}, {"text", f.text}, {"line", f.entry}});
  json record{{"format", "rondo-trace/1"},
              {"engine", "campaign"},
              {"program_name", texts.program_name},
              {"program", texts.program},
              {"spec", texts.spec},
              {"fleet", texts.fleet},
              {"scenario", campaign::WriteScenario(trial.scenario, "")},
              {"wrong", trial.What()},
              {"findings", findings},
              {"robots", robots}};
  if (!texts.files.empty()) record["files"] = ToJson(texts.files);
  writer.Message(writer.Channel("/rondo/run", trace::kRecord, "json"), 0, record.dump());
  const uint16_t log = writer.Channel("/rondo/log", trace::kRecord, "json");
  const history::Record& lines = trial.outcome.record;
  for (const Entry& e : lines.entries)
    writer.Message(log, static_cast<uint64_t>(e.time), LineOf(lines, e, team).dump());
  return writer.Finish();
}

Replayed ReplayCampaign(const std::string& bytes, const json& record, workspace::Session& session) {
  const auto kept = FilesFromJson(record.value("files", json::object()));
  if (!kept) return {false, "the files that the trace keeps are damaged"};
  const CampaignTexts texts{sim::TextOf(record, "program_name"), sim::TextOf(record, "program"),
                            sim::TextOf(record, "spec"), sim::TextOf(record, "fleet"), *kept};
  const auto loaded = workspace::LoadKoordTexts(texts.program_name, texts.program, texts.spec, session);
  if (!loaded) return {false, "the program that the trace keeps cannot be used"};
  sim::Fleet fleet;
  if (!texts.fleet.empty())
    fleet = FleetFiles(*kept, session).Read(session.sources.Add("fleet", texts.fleet));
  const diag::FileId file = session.sources.Add("scenario", sim::TextOf(record, "scenario"));
  const auto scenarios = campaign::ReadScenarios(session.sources, file, session.diagnostics);
  if (session.diagnostics.has_errors() || scenarios.size() != 1)
    return {false, "the scenario that the trace keeps cannot be used"};
  CampaignTeams teams(loaded->model, fleet);
  const auto judge = teams.Make(scenarios[0].robots, session.diagnostics);
  if (judge == nullptr) return {false, "the program that the trace keeps cannot be executed"};
  campaign::Fleet robots(teams.Maker());
  const campaign::Trial trial = campaign::Try(robots, *judge, scenarios[0]);
  const auto again =
      CopyOf([&](const std::string& path) { return WriteCampaignTrace(path, texts, trial, *judge); });
  if (!again.ok()) return {false, again.error().message};
  if (again.value() != bytes) return {false, "differs: " + FirstDifference(bytes, again.value())};
  return {true, fmt::format("the same run, bit for bit: {} of {}; {}",
                            base::Counted(trial.outcome.record.entries.size(), "line"),
                            base::Counted(scenarios[0].robots, "robot"),
                            trial.failed() ? trial.What() : "nothing is wrong")};
}

}  // namespace rondo::runs
