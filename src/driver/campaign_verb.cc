#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/counted.h"
#include "base/file.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/native/native_program.h"
#include "runs/campaign_teams.h"
#include "runs/campaign_trace.h"
#include "runs/simulation_files.h"
#include "sim/campaign/campaign.h"
#include "sim/campaign/scenario_file.h"
#include "sim/cores/cores.h"
#include "workspace/koord_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

namespace campaign = sim::campaign;

struct Options {
  std::string file;
  std::string spec;
  std::string fleet;
  uint64_t runs = 1000;
  uint64_t rounds = 30;
  uint64_t seed = 1;
  std::vector<size_t> robots;
  std::string core;
  std::string scenarios;
  std::string save;
  std::string logs;
  bool json = false;
};

nlohmann::json ToJson(const campaign::CampaignReport& report, double seconds) {
  nlohmann::json steps = nlohmann::json::array();
  for (const uint64_t pair : report.visited) {
    steps.push_back(
        fmt::format("{} -> {}", Name(static_cast<runtime::rounds::Phase>(pair / sim::cores::Cores::kPhases)),
                    Name(static_cast<runtime::rounds::Phase>(pair % sim::cores::Cores::kPhases))));
  }
  nlohmann::json json{{"runs", report.runs},
                      {"rounds", report.rounds},
                      {"datagrams", report.datagrams},
                      {"virtual_seconds", report.seconds},
                      {"seconds", seconds},
                      {"judging_seconds", report.judging},
                      {"longest_recovery", static_cast<double>(report.recovery) * 1e-9},
                      {"steps_of_cores", steps},
                      {"failure", nullptr}};
  if (!report.failure) return json;
  nlohmann::json findings = nlohmann::json::array();
  for (const auto& f : report.failure->findings)
    findings.push_back({{"wrong", history::Name(f.wrong)}, {"text", f.text}, {"entry", f.entry}});
  json["failure"] = {{"what", report.failure->What()},
                     {"seed", report.failure->scenario.seed},
                     {"robots", report.failure->scenario.robots},
                     {"findings", findings},
                     {"scenario", campaign::WriteScenario(report.failure->scenario, "")}};
  return json;
}

// What is to be searched, as the command line and the files say.
campaign::CampaignOptions ReadOptions(const Options& options, workspace::Session& session) {
  campaign::CampaignOptions search;
  search.runs = options.runs;
  search.rounds = options.rounds;
  search.seed = options.seed;
  if (!options.robots.empty()) {
    search.least = *std::ranges::min_element(options.robots);
    search.most = *std::ranges::max_element(options.robots);
  }
  if (options.scenarios.empty()) return search;
  if (const auto file = workspace::ReadSource(options.scenarios, workspace::Wanted::kToml, session))
    search.scenarios = campaign::ReadScenarios(session.sources, *file, session.diagnostics);
  return search;
}

// With a library, it runs the events of the robots; the judge has the machine.
campaign::CampaignReport Search(runs::CampaignTeams& teams, const std::optional<koord::native::Library>& core,
                                const diag::SourceSet& sources, campaign::CampaignOptions& search,
                                double& seconds) {
  const campaign::Fleet::MakeTeam make = teams.Maker();
  campaign::Fleet robots(core ? teams.NativeMaker(*core, sources) : make);
  ProgressLine line;
  const InterruptScope interrupt(search.stop);
  const auto begin = std::chrono::steady_clock::now();
  const auto since = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  double last = 0;
  search.progress = [&](uint64_t done) {
    const double now = since();
    if (now < last + 0.2) return;
    last = now;
    line.Show(
        fmt::format("[{} of {} runs] {:.0f} runs/s", done, search.runs, static_cast<double>(done) / now));
  };
  campaign::CampaignReport report = campaign::Search(robots, make, search);
  seconds = since();
  return report;
}

// Of what was read so far.
runs::CampaignTexts TextsOf(const runs::SimulationFiles& files, const workspace::Session& session,
                            const runs::FileContents& of_fleet) {
  sim::SimulationOptions texts;
  runs::KeepTexts(files, session, of_fleet, texts);
  return {texts.program_name, texts.program, texts.spec, texts.fleet, of_fleet};
}

// Where a failing run is kept; empty: nowhere.
struct Saved {
  std::string scenario, trace;
};

Saved Save(const campaign::Trial& failure, const Options& options, const runs::CampaignTexts& texts,
           koord::semantics::Team& team) {
  Saved saved;
  saved.scenario = options.save.empty()
                       ? std::filesystem::path(texts.program_name).stem().string() + ".scenario.toml"
                       : options.save;
  saved.trace = std::filesystem::path(saved.scenario).replace_extension(".mcap").string();
  const auto fails = [](std::string& path, const auto& written) {
    if (written.ok()) return;
    PrintFailure(fmt::format("cannot write `{}`: {}", path, written.error().message));
    path.clear();
  };
  fails(saved.scenario,
        base::WriteFileAtomically(saved.scenario,
                                  campaign::WriteScenario(failure.scenario, campaign::Story(failure))));
  fails(saved.trace, runs::WriteCampaignTrace(saved.trace, texts, failure, team));
  return saved;
}

// Keeps each run in a folder, by its seed; scenarios, which may have the same, by their number.
std::function<void(const campaign::Trial&, koord::semantics::Team&)> LogsTo(
    const Options& options, const runs::CampaignTexts& texts) {
  return [&options, &texts, done = uint64_t{0}, failed = false](const campaign::Trial& trial,
                                                                koord::semantics::Team& team) mutable {
    ++done;
    const uint64_t number = options.scenarios.empty() ? trial.scenario.seed : done;
    const std::string path = (std::filesystem::path(options.logs) / fmt::format("{}.mcap", number)).string();
    const auto written = runs::WriteCampaignTrace(path, texts, trial, team);
    if (!written.ok() && !std::exchange(failed, true))
      PrintFailure(fmt::format("cannot write `{}`: {}", path, written.error().message));
  };
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  const runs::SimulationFiles files = runs::FindSimulationFiles(options.file, options.spec, options.fleet);
  const auto loaded = workspace::LoadKoord({files.program, files.spec, true}, session);
  sim::Fleet fleet;
  runs::FleetFiles surroundings(files.fleet, session);
  std::error_code ignored;
  if (loaded && (!options.fleet.empty() || std::filesystem::exists(files.fleet, ignored))) {
    if (const auto file = workspace::ReadSource(files.fleet, workspace::Wanted::kToml, session))
      fleet = surroundings.Read(*file);
  }
  const runs::CampaignTexts texts = TextsOf(files, session, surroundings.contents());
  campaign::CampaignOptions search = ReadOptions(options, session);
  const auto refuse = [&](const std::string& why) {
    return Refuse("campaign", options.file, options.json, session.sources, session.diagnostics, why);
  };
  campaign::CampaignReport report;
  double seconds = 0;
  Saved saved;
  ExitStatus status = ExitStatus::kRejected;
  if (loaded && !session.diagnostics.has_errors()) {
    runs::CampaignTeams teams(loaded->model, fleet);
    std::optional<koord::native::Library> core;
    if (!options.core.empty()) {
      auto library = koord::native::Library::Load(options.core);
      if (!library.ok()) return refuse(library.error().message);
      core = library.value();
      if (options.robots.empty()) search.least = search.most = core->robots();
      const auto team = teams.Make(search.least, session.diagnostics);
      const auto attached = team == nullptr ? base::Result<bool>(true) : core->Attach(*team, session.sources);
      if (!attached.ok()) return refuse(attached.error().message);
      if (search.least != search.most ||
          std::ranges::any_of(search.scenarios, [&](const auto& s) { return s.robots != core->robots(); }))
        return refuse(fmt::format("`{}` was made for {}: no other team can be tried", options.core,
                                  base::Counted(core->robots(), "robot")));
    }
    const size_t first = search.scenarios.empty() ? search.least : search.scenarios[0].robots;
    if (teams.Make(first, session.diagnostics) != nullptr && !session.diagnostics.has_errors()) {
      if (const std::string why = Folder(options.logs); !why.empty()) return refuse(why);
      if (!options.logs.empty()) search.each = LogsTo(options, texts);
      report = Search(teams, core, session.sources, search, seconds);
      status = report.failure   ? ExitStatus::kRejected
               : report.stopped ? ExitStatus::kUndecided
                                : ExitStatus::kEstablished;
    }
    if (report.failure) {
      diag::Diagnostics again;
      const auto team = teams.Make(report.failure->scenario.robots, again);
      saved = Save(*report.failure, options, texts, *team);
    }
  }
  if (options.json) {
    nlohmann::json out = ToJson(report, seconds);
    out["command"] = "campaign";
    out["file"] = files.program;
    out["seed"] = options.seed;
    out["status"] = status;
    out["diagnostics"] = diag::RenderJson(session.sources, session.diagnostics);
    if (!saved.scenario.empty()) out["saved"] = saved.scenario;
    if (!saved.trace.empty()) out["trace"] = saved.trace;
    PrintJson(out);
    return status;
  }
  PrintDiagnostics(session.sources, session.diagnostics);
  if (report.runs == 0) return status;
  Print(fmt::format("{}: {}, {}, {:.0f} s of virtual time in {:.1f} s\n", files.program,
                    base::Counted(report.runs, "run"), base::Counted(report.rounds, "round"), report.seconds,
                    seconds));
  if (report.failure) Print("\n" + campaign::Story(*report.failure));
  if (!saved.scenario.empty())
    Print(fmt::format("\nthe scenario is in {0}: `rondo campaign {1} --scenarios {0}`\n", saved.scenario,
                      files.program));
  if (!saved.trace.empty())
    Print(fmt::format("what the robots logged is in {0}: `rondo replay {0}`\n", saved.trace));
  if (report.stopped) Print(fmt::format("interrupted: go on with `--seed {}`\n", options.seed + report.runs));
  if (status == ExitStatus::kEstablished) Print("nothing is wrong in any of them\n");
  return status;
}

}  // namespace

void AddCampaignVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "campaign", "look for faults of the network and of robots that break a Koord fleet");
  verb.Option(
          "FILE", options->file,
          "a Koord program, with or without `.koord`; parameters come from `NAME.toml` beside it, if there is one")
      .Required();
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option("--fleet", options->fleet, "the fleet, if it is not beside the program");
  verb.Option("--runs", options->runs, "how many runs; default: 1000")
      .Between(uint64_t{1}, uint64_t{1'000'000'000});
  verb.Option("--rounds", options->rounds, "how long each is; default: 30")
      .Between(uint64_t{1}, uint64_t{1'000'000});
  verb.Option("--seed", options->seed, "of the first run; the others count up; default: 1")
      .Between(uint64_t{0}, uint64_t{9'000'000'000'000'000});
  verb.Option("--robots", options->robots, "team sizes, from the least to the greatest; default: 2 to 7")
      .Between(size_t{1}, size_t{64});
  verb.Option("--scenarios", options->scenarios, "run these scenarios (TOML) instead of random ones");
  verb.Option(
      "--save", options->save,
      "where to write the scenario that fails, and, with `.mcap`, what its robots logged; default: NAME.scenario.toml");
  verb.Option("--logs", options->logs, "a folder for what the robots log in each run (MCAP), good or not");
  verb.Option(
      "--core", options->core,
      "a library that `rondo build` made of the program runs the events of the robots, instead of the machine");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo campaign examples/koord/mutex\n"
      "  rondo campaign examples/koord/delivery --robots 3 5 --runs 10000\n"
      "  rondo campaign examples/koord/mutex --scenarios mutex.scenario.toml\n"
      "\n"
      "Sensors and external functions give anything here: it is the protocol that is tried (docs/runtime.md), not the program.\n"
      "exit status: 0 nothing is wrong, 1 something is, 3 interrupted");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
