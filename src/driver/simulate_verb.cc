#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "driver/command.h"
#include "driver/logs_text.h"
#include "driver/page.h"
#include "driver/simulate_choreography.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/simulation_files.h"
#include "sim/network.h"
#include "sim/simulation.h"
#include "workspace/koord_files.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::string choreography;
  std::vector<std::string> admitted;
  bool projections = false;
  uint64_t runs = 1;
  std::string fleet;
  std::string spec;
  std::string network;
  std::string trace;
  std::optional<uint64_t> seed;
  double duration = 0;
  unsigned jobs = 0;
  bool fail_on_collision = false;
  bool open = false;
  bool json = false;
};

nlohmann::json Finite(double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr); }

std::string Summary(const sim::NetworkReport& network, const sim::SimulationReport& report,
                    const std::vector<sim::FleetRobot>& robots) {
  std::string text = fmt::format("  network: {}", base::Counted(network.datagrams, "datagram"));
  if (report.rounds > 0) {
    const double each =
        static_cast<double>(network.bytes) / static_cast<double>(report.rounds * robots.size());
    text += fmt::format(", {:.0f} bytes for each robot and round", each);
  }
  if (!network.waits.empty()) {
    text += fmt::format(
        "; a round is final after {:.3g} ms (half of them), {:.3g} ms (99 of 100), {:.3g} ms (all)",
        1e3 * Quantile(network.waits, 0.5), 1e3 * Quantile(network.waits, 0.99), 1e3 * network.waits.back());
  }
  text += "\n";
  constexpr size_t kMost = 20;
  for (size_t i = 0; i < network.happenings.size() && i < kMost; ++i) {
    const sim::Happening& h = network.happenings[i];
    text += fmt::format("  {:9.3f} s  {}{}\n", h.time,
                        h.robot < 0 ? "" : robots[static_cast<size_t>(h.robot)].name + " ", h.what);
  }
  if (network.happenings.size() > kMost)
    text +=
        fmt::format("  and {} more: `--json` and traces have them all\n", network.happenings.size() - kMost);
  return text;
}

// Why a run that violates nothing says less than it could.
std::string Undecided(const sim::SimulationReport& report, const sim::Fleet& fleet) {
  std::string text;
  if (!report.unchecked.empty())
    text += fmt::format("  not checked: {}\n", fmt::join(report.unchecked, ", "));
  if (fleet.until == sim::Until::kMapped && report.ended == sim::Ending::kTime)
    text += "  the time was over before the map was complete\n";
  return text;
}

std::string Summary(const sim::SimulationReport& report, double seconds,
                    const std::vector<sim::FleetRobot>& robots) {
  const bool real = seconds > 0.005;
  std::string text = fmt::format("  {:.6g} s in {}, {}{}\n", report.time,
                                 base::Counted(report.rounds, "round"), base::Counted(report.events, "event"),
                                 real ? fmt::format("; {:.1f} x real time", report.time / seconds) : "");
  if (report.collisions > 0) {
    text += fmt::format("  {}; the first at {:.6g} s: {}\n", base::Counted(report.collisions, "collision"),
                        report.first_collision, report.first_pair);
  } else {
    text += fmt::format("  no collision, looked at every {:.3g} s\n", report.observed_every);
  }
  if (std::isfinite(report.least_between_robots))
    text += fmt::format("  robots never closer than {:.3f} m\n", report.least_between_robots);
  if (std::isfinite(report.least_to_obstacles))
    text += fmt::format("  obstacles never closer than {:.3f} m\n", report.least_to_obstacles);
  if (report.known_cells > 0) {
    text +=
        fmt::format("  map: {} known, {} wrongly occupied, {} reachable but unknown\n",
                    base::Counted(report.known_cells, "cell"), report.wrong_cells, report.reachable_unknown);
  }
  if (report.network) text += Summary(*report.network, report, robots);
  switch (report.ended) {
    case sim::Ending::kStopped:
      text += "  every robot stopped\n";
      break;
    case sim::Ending::kQuiet:
      text += "  nothing moves any more, and no event can run\n";
      break;
    case sim::Ending::kMapped:
      text += "  the map is complete\n";
      break;
    case sim::Ending::kInterrupted:
      text += "  interrupted\n";
      break;
    case sim::Ending::kTime:
    case sim::Ending::kFailed:
      break;
  }
  for (const sim::Violation& v : report.violations) {
    if (v.count > 1)
      text += fmt::format("  {}{}: violated {} times, first at {:.6g} s\n", v.what,
                          v.robot < 0 ? "" : fmt::format(" by robot {}", v.robot), v.count, v.first);
  }
  for (const std::string& line : report.log) text += "  " + line + "\n";
  return text;
}

nlohmann::json ToJson(const sim::NetworkReport& network) {
  nlohmann::json happenings = nlohmann::json::array();
  for (const sim::Happening& h : network.happenings)
    happenings.push_back({{"time", h.time}, {"robot", h.robot}, {"what", h.what}});
  nlohmann::json json{{"datagrams", network.datagrams}, {"bytes", network.bytes},
                      {"epochs", network.epochs},       {"fallbacks", network.fallbacks},
                      {"happenings", happenings},       {"wait", nullptr}};
  if (!network.waits.empty()) {
    json["wait"] = {{"median", Quantile(network.waits, 0.5)},
                    {"p99", Quantile(network.waits, 0.99)},
                    {"max", network.waits.back()}};
  }
  return json;
}

nlohmann::json ToJson(const sim::SimulationReport& report) {
  nlohmann::json violations = nlohmann::json::array();
  for (const sim::Violation& v : report.violations)
    violations.push_back({{"what", v.what}, {"robot", v.robot}, {"first", v.first}, {"count", v.count}});
  return {
      {"time", report.time},
      {"rounds", report.rounds},
      {"events", report.events},
      {"ended", sim::Name(report.ended)},
      {"collisions", report.collisions},
      {"observed_every", report.observed_every},
      {"least_between_robots", Finite(report.least_between_robots)},
      {"least_to_obstacles", Finite(report.least_to_obstacles)},
      {"violations", violations},
      {"unchecked", report.unchecked},
      {"plans", report.plans},
      {"map",
       {{"known", report.known_cells}, {"wrong", report.wrong_cells}, {"missing", report.reachable_unknown}}},
      {"log", report.log},
      {"network", report.network ? ToJson(*report.network) : nlohmann::json(nullptr)}};
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  runs::SimulationFiles files = runs::FindSimulationFiles(options.files[0], options.spec, options.fleet);
  const auto loaded = workspace::LoadKoord({files.program, files.spec, true}, session);
  sim::Fleet fleet;
  runs::FleetFiles surroundings(files.fleet, session);
  if (loaded) {
    const auto file = workspace::ReadSource(files.fleet, workspace::Wanted::kToml, session);
    if (!file) PrintFailure("a simulation needs a fleet: robots, models and a world; see docs/simulation.md");
    if (file) fleet = surroundings.Read(*file);
  }
  sim::NetworkFaults network;
  files.network = options.network;
  if (!options.network.empty() && !session.diagnostics.has_errors()) {
    if (const auto file = workspace::ReadSource(options.network, workspace::Wanted::kToml, session))
      network = sim::ReadNetwork(session.sources, *file, fleet, session.diagnostics);
  }
  const auto finish_early = [&](ExitStatus status) {
    if (options.json) {
      PrintJson({{"command", "simulate"},
                 {"file", files.program},
                 {"status", status},
                 {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
    } else {
      PrintDiagnostics(session.sources, session.diagnostics);
    }
    return status;
  };
  if (session.diagnostics.has_errors()) return finish_early(ExitStatus::kRejected);
  sim::SimulationOptions simulation;
  simulation.seed = options.seed.value_or(fleet.seed.value_or(1));
  simulation.duration = options.duration;
  simulation.jobs = options.jobs;
  if (!options.network.empty()) simulation.network = &network;
  runs::KeepTexts(files, session, surroundings.contents(), simulation);
  std::optional<trace::Writer> writer;
  if (!options.trace.empty()) {
    auto opened = trace::Writer::Open(options.trace);
    if (!opened.ok()) {
      PrintFailure(fmt::format("cannot write `{}`: {}", options.trace, opened.error().message));
      return ExitStatus::kRejected;
    }
    writer.emplace(std::move(opened).value());
  }
  sim::SimulationReport report;
  const auto begin = std::chrono::steady_clock::now();
  {
    ProgressLine line;
    const InterruptScope interrupt(simulation.stop);
    auto last = begin;
    simulation.progress = [&](double time, double end) {
      const auto now = std::chrono::steady_clock::now();
      if (now - last < std::chrono::milliseconds(200)) return;
      last = now;
      const double seconds = std::chrono::duration<double>(now - begin).count();
      line.Show(fmt::format("[{:.0f} of {:.0f} s] {:.1f} x real time", time, end, time / seconds));
    };
    report =
        sim::Simulate(loaded->model, fleet, simulation, writer ? &*writer : nullptr, session.diagnostics);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!report.ran) return finish_early(ExitStatus::kRejected);
  // A run that was cut off is kept, for its end is in it; one that could not begin is not.
  bool written = true;
  if (writer) {
    const auto done = writer->Finish();
    written = done.ok();
    if (!written) PrintFailure(fmt::format("cannot write `{}`: {}", options.trace, done.error().message));
  }
  ExitStatus status = ExitStatus::kEstablished;
  if (!report.unchecked.empty() || report.ended == sim::Ending::kInterrupted) status = ExitStatus::kUndecided;
  if (fleet.until == sim::Until::kMapped && report.ended == sim::Ending::kTime)
    status = ExitStatus::kUndecided;
  if (session.diagnostics.has_errors() || !written || (options.fail_on_collision && report.collisions > 0))
    status = ExitStatus::kRejected;
  if (options.json) {
    nlohmann::json out = ToJson(report);
    out["command"] = "simulate";
    out["file"] = files.program;
    out["seed"] = simulation.seed;
    out["seconds"] = seconds;
    out["status"] = status;
    out["diagnostics"] = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson(out);
    return status;
  }
  Print(fmt::format("{}: {}, seed {}\n{}", files.program, base::Counted(fleet.robots.size(), "robot"),
                    simulation.seed, Summary(report, seconds, fleet.robots) + Undecided(report, fleet)));
  if (written && writer) Print(fmt::format("trace: {}\n", options.trace));
  PrintDiagnostics(session.sources, session.diagnostics);
  return status;
}

ExitStatus RunChoreography(const Options& options) {
  SimulateChoreographyOptions run;
  run.files = {options.files, options.admitted, options.choreography, options.projections};
  run.run.seed = options.seed.value_or(1);
  if (options.duration > 0) run.run.duration = options.duration;
  run.runs = options.runs;
  run.jobs = options.jobs;
  run.trace = options.trace;
  run.json = options.json;
  if (options.runs > 1 && !options.trace.empty())
    RefuseOption("--trace", "it is of one run: leave `--runs` out");
  return SimulateChoreography(run);
}

}  // namespace

void AddSimulateVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "simulate", "run a program or a choreography on simulated robots, in virtual time");
  verb.Option(
          "FILE", options->files,
          "a Koord program, with or without `.koord`; `NAME.toml` beside it is the fleet, `NAME.spec` the specification. Or a "
          "choreography (`.rondo`), with what belongs to it (`.chor`, `.rosl`)")
      .Required();
  verb.Option("--fleet", options->fleet, "the fleet, if it is not beside the program");
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option(
      "--network", options->network,
      "let the robots agree over a network that loses and robots that fail, as this file says (TOML)");
  verb.Option("--choreography", options->choreography, "which one of the file, if there are several");
  verb.Flag("--projections", options->projections,
            "let each robot follow its projection, even where it has a process");
  verb.Option("--option", options->admitted, "an option for every choreography: `equal_durations`").OneEach();
  verb.Option("--runs", options->runs, "so many runs of a choreography, of the seeds from `--seed` on")
      .Between(uint64_t{1}, uint64_t{1'000'000'000});
  verb.Option("--seed", options->seed, "of everything that is random; default: the fleet's, or 1");
  verb.Option("--duration", options->duration,
              "seconds; default: as the fleet says; of choreographies at most 60")
      .Between(1e-3, 1e7);
  verb.Option("--trace", options->trace, "write everything that happens into this file (MCAP)");
  verb.Flag("--open", options->open, "show it in a browser, with `--trace` or without (`rondo view`)");
  verb.Option("--jobs", options->jobs, "threads; default: one for each core. No run depends on it");
  verb.Flag("--fail-on-collision", options->fail_on_collision, "exit status 1 if robots touch anything");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo simulate examples/koord/mapping --seed 1 --trace mapping.mcap\n"
      "  rondo plot mapping.mcap --map --svg map.svg\n"
      "  rondo replay mapping.mcap\n"
      "  rondo simulate examples/koord/lineform --network examples/koord/radio.toml\n"
      "  rondo simulate examples/choreo/handover.rondo --trace handover.mcap\n"
      "  rondo simulate examples/choreo/fetch.rondo --runs 1000\n"
      "\n"
      "Every invariant, assumption and summary is checked while a program runs; contacts, contracts and assumptions of motions\n"
      "while a choreography does.\n"
      "exit status: 0 nothing was violated, 1 something was, 3 not everything could be checked, or interrupted");
  verb.Run([options, verb, &status] {
    const bool choreography = workspace::IsModuleFile(options->files[0]);
    if (choreography)
      RefuseAll(verb, {"--fleet", "--spec", "--network", "--fail-on-collision"},
                "only Koord programs have it");
    else
      RefuseAll(verb, {"--choreography", "--option", "--projections", "--runs"},
                "only choreographies have it");
    if (!choreography && options->files.size() > 1) RefuseOption("FILE", "a Koord program is one file");
    if (options->open && options->trace.empty()) options->trace = PlaceForTrace();
    status = choreography ? RunChoreography(*options) : Run(*options);
    if (options->open) ShowTrace(options->trace, options->json);
  });
}

}  // namespace rondo::driver
