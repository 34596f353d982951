#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "deploy/doctor.h"
#include "deploy/keystore.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/robot_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string file;
  std::string fleet;
  std::string spec;
  double seconds = 3;
  bool json = false;
};

std::string TextOf(const deploy::Trouble& trouble) {
  return fmt::format("{}: {}{}\n  help: {}\n", trouble.wrong ? "wrong" : "note",
                     trouble.of.empty() ? "" : trouble.of + ": ", trouble.what, trouble.help);
}

std::string TextOf(const deploy::Health& health) {
  std::string text;
  for (const deploy::RobotStatus& s : health.robots) {
    text += fmt::format("  {}: {}, round {}", s.robot, s.active ? "acts" : s.phase, s.round);
    if (s.median > 0)
      text += fmt::format(", final after {:.3g} ms (half of them), {:.3g} ms (99 of 100)", s.median, s.p99);
    for (const deploy::WayTo& way : health.ways) {
      if (way.robot != s.robot) continue;
      text += fmt::format("; there and back {:.2g} ms, {:.0f} % lost, clock {:+.1f} ms", 1e3 * way.median,
                          100 - 100.0 * static_cast<double>(way.answered) / static_cast<double>(way.asked),
                          1e3 * way.ahead);
    }
    text += "\n";
  }
  return text;
}

nlohmann::json ToJson(const deploy::Health& health) {
  nlohmann::json robots = nlohmann::json::array(), ways = nlohmann::json::array(),
                 troubles = nlohmann::json::array();
  for (const deploy::RobotStatus& s : health.robots)
    robots.push_back({{"name", s.robot},
                      {"phase", s.phase},
                      {"active", s.active},
                      {"round", s.round},
                      {"agreement", s.agreement},
                      {"median_ms", s.median},
                      {"p99_ms", s.p99},
                      {"sensors", s.sensors},
                      {"unheard", s.unheard}});
  for (const deploy::WayTo& w : health.ways)
    ways.push_back({{"robot", w.robot},
                    {"asked", w.asked},
                    {"answered", w.answered},
                    {"median", w.median},
                    {"max", w.most},
                    {"ahead", w.ahead}});
  for (const deploy::Trouble& t : health.troubles)
    troubles.push_back({{"wrong", t.wrong}, {"robot", t.of}, {"what", t.what}, {"help", t.help}});
  return {{"robots", robots}, {"ways", ways}, {"troubles", troubles}};
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  deploy::Health health;
  std::string problem;
  bool reported = false;
  const auto network = [&](const base::Result<dds::Network>& with) {
    if (!with.ok()) problem = with.error().message;
    return with.ok() ? with.value() : dds::Network();
  };
  if (options.file.empty()) {
    const dds::Network used = network(dds::WithEnvironment({.profile = dds::Profile::kLan}));
    if (problem.empty()) health.troubles = deploy::ExamineMachine(used);
  } else if (const auto program = runs::LoadRobotProgram(
                 runs::FindSimulationFiles(options.file, options.spec, options.fleet), {}, session)) {
    const dds::Network used = network(runs::NetworkOf(*program, deploy::kDoctorEnclave));
    const std::string agreement =
        deploy::AgreementOf(program->loaded->model, program->fleet, program->texts, session.diagnostics);
    if (problem.empty() && !agreement.empty()) {
      const base::StopToken stop;
      const InterruptScope interrupt(stop);
      auto found = deploy::Examine(program->loaded->model, program->fleet, used, agreement, options.seconds,
                                   stop, session.diagnostics);
      if (found.ok()) health = std::move(found).value();
      if (!found.ok()) problem = found.error().message;
    }
  }
  reported = session.diagnostics.has_errors();
  const ExitStatus status =
      reported || !problem.empty() || !health.healthy() ? ExitStatus::kRejected : ExitStatus::kEstablished;
  if (options.json) {
    nlohmann::json out = ToJson(health);
    out["command"] = "doctor";
    out["file"] = options.file;
    out["status"] = status;
    if (!problem.empty()) out["error"] = problem;
    out["diagnostics"] = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson(out);
    return status;
  }
  PrintDiagnostics(session.sources, session.diagnostics);
  if (!problem.empty()) PrintFailure(problem);
  if (reported || !problem.empty()) return status;
  Print(TextOf(health));
  for (const deploy::Trouble& trouble : health.troubles) Print(TextOf(trouble));
  if (status == ExitStatus::kEstablished)
    Print(options.file.empty() ? "robots can run on this machine\n" : "nothing is wrong\n");
  return status;
}

}  // namespace

void AddDoctorVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "doctor", "find out why a fleet does not run as it should");
  verb.Option(
      "FILE", options->file,
      "the Koord program that the fleet runs, with or without `.koord`; without it, what is missing on this machine");
  verb.Option("--fleet", options->fleet, "the fleet, if it is not beside the program");
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option("--seconds", options->seconds, "how long to listen; default: 3").Between(0.1, 3600.0);
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo doctor\n"
      "  ROS_DOMAIN_ID=7 rondo doctor fleet.koord\n"
      "\n"
      "Listens to the robots and their topics while they run, and asks each of them: who misses whom, how long answers take, what is\n"
      "lost, whose clock is wrong, who runs other files, which topics are silent or of another type or quality.\n"
      "exit status: 0 nothing is wrong, 1 something is");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
