#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "deploy/keystore.h"
#include "driver/choreography_robots.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "koord/native/native_program.h"
#include "lang/suggest.h"
#include "runs/robot_files.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using deploy::RobotEnding;
using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::string robot;
  std::string choreography;
  std::vector<std::string> admitted;
  bool projections = false;
  double tolerance = deploy::Precision().tolerance, patience = 1;
  std::string fleet;
  std::string spec;
  std::string log;
  std::string folder;
  std::string core;
  std::optional<uint64_t> seed;
  uint64_t session = 0;
  double duration = 0;
  bool json = false;
};

std::string Tell(const deploy::RobotReport& report) {
  std::string text = fmt::format("  {}", base::Counted(report.rounds, "round"));
  if (report.most > 0) {
    text += fmt::format(
        "; a round is final after {:.3g} ms (half of them), {:.3g} ms (99 of 100), {:.3g} ms (all)",
        1e3 * report.median, 1e3 * report.p99, 1e3 * report.most);
  }
  text += "\n";
  if (report.fallbacks > 0) text += fmt::format("  fell back: {}\n", base::Counted(report.fallbacks, "time"));
  if (report.failed > 0)
    text +=
        fmt::format("  an operation of an event had no value in {}\n", base::Counted(report.failed, "round"));
  if (report.blind > 0)
    text += fmt::format("  skipped {} because of its sensors\n", base::Counted(report.blind, "round"));
  if (report.late > 0) text += fmt::format("  {} too late to be sent\n", base::Counted(report.late, "order"));
  switch (report.ending) {
    case RobotEnding::kTime:
      return text + "  its time is over\n";
    case RobotEnding::kInterrupted:
      return text + "  interrupted: it stays where it is\n";
    case RobotEnding::kStopped:
      return text + "  every robot stopped\n";
    case RobotEnding::kHalted:
      return text + "  it lost the others; its fleet halts then (`on_loss = \"halt\"`)\n";
    case RobotEnding::kBroken:
      return text +
             fmt::format("  this is a mistake of the round protocol: please report it, with the log: {}\n",
                         report.broken);
  }
  return text;
}

ExitStatus Fail(const Options& options, const workspace::Session& session, const std::string& why) {
  return Refuse("run", options.files[0], options.json, session.sources, session.diagnostics, why);
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  auto program = runs::LoadRobotProgram(
      runs::FindSimulationFiles(options.files[0], options.spec, options.fleet), options.seed, session);
  if (!program) return Fail(options, session, {});
  const auto& robots = program->fleet.robots;
  const auto robot = std::ranges::find(robots, options.robot, &sim::FleetRobot::name);
  if (robot == robots.end()) {
    std::vector<std::string> names;
    for (const auto& r : robots) names.push_back(r.name);
    const std::string near = lang::Suggest(options.robot, names);
    return Fail(options, session,
                fmt::format("`{}` has no robot `{}`: {}", program->files.fleet, options.robot,
                            near.empty() ? fmt::format("it has {}", fmt::join(names, ", "))
                                         : fmt::format("did you mean `{}`?", near)));
  }
  auto network = runs::NetworkOf(*program, deploy::EnclaveOf(*robot));
  if (!network.ok()) return Fail(options, session, network.error().message);
  deploy::RobotOptions run = program->texts;
  run.robot = static_cast<uint32_t>(robot - robots.begin());
  run.network = network.value();
  run.session = options.session;
  run.duration = options.duration;
  run.log = options.log;
  run.folder = options.folder;
  if (!options.core.empty()) {
    const auto library = koord::native::Library::Load(options.core);
    if (!library.ok()) return Fail(options, session, library.error().message);
    run.attach = [library = library.value(), &session](koord::semantics::Team& team) {
      return library.Attach(team, session.sources);
    };
  }
  if (!options.json)
    run.tell = [&](const std::string& text) { PrintError(fmt::format("{}: {}\n", options.robot, text)); };
  base::Result<deploy::RobotReport> ran = base::Error{};
  {
    const InterruptScope interrupt(run.stop);
    if (run.tell)
      run.tell(
          fmt::format("domain {}; {}", run.network.domain,
                      run.network.keys.folder.empty()
                          ? "DDS without security: whoever is in the network can disturb it (`rondo keys`)"
                          : fmt::format("DDS with security: the keys are in `{}`", run.network.keys.folder)));
    ran = deploy::RunRobot(program->loaded->model, program->fleet, run, session.diagnostics);
  }
  if (!ran.ok()) return Fail(options, session, ran.error().message);
  const deploy::RobotReport& report = ran.value();
  const ExitStatus status = report.ending == RobotEnding::kHalted || report.failed > 0 ? ExitStatus::kRejected
                            : report.ending == RobotEnding::kBroken                    ? ExitStatus::kBug
                                                                    : ExitStatus::kEstablished;
  if (options.json) {
    PrintJson({{"command", "run"},
               {"file", program->files.program},
               {"robot", options.robot},
               {"ended", deploy::Name(report.ending)},
               {"rounds", report.rounds},
               {"fallbacks", report.fallbacks},
               {"blind", report.blind},
               {"late", report.late},
               {"failed", report.failed},
               {"log", report.log},
               {"wait", {{"median", report.median}, {"p99", report.p99}, {"max", report.most}}},
               {"status", status},
               {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
    return status;
  }
  Print(fmt::format("{}: {}\n{}", program->files.program, options.robot, Tell(report)));
  if (!report.log.empty()) Print(fmt::format("log: {}\n", report.log));
  PrintDiagnostics(session.sources, session.diagnostics);
  return status;
}

ExitStatus RunPart(const Options& options) {
  RunChoreographyOptions run;
  run.files = {options.files, options.admitted, options.choreography, options.projections};
  run.robot = options.robot;
  run.run.seed = options.seed.value_or(1);
  run.run.session = options.session;
  run.run.duration = options.duration;
  run.run.patience = options.patience;
  run.run.precision.tolerance = options.tolerance;
  run.run.log = options.log;
  run.json = options.json;
  return RunChoreography(run);
}

}  // namespace

void AddRunVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "run",
               "run one robot: a node of ROS 2 that takes part in a Koord program or a choreography");
  verb.Option(
          "FILE", options->files,
          "a Koord program, with or without `.koord`; `NAME.toml` beside it is the fleet, the same on all robots. Or a "
          "choreography (`.rondo`), with what belongs to it")
      .Required();
  verb.Option("--robot", options->robot, "which robot of the fleet or the choreography this is").Required();
  verb.Option("--fleet", options->fleet, "the fleet, if it is not beside the program");
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option("--log", options->log,
              "write what the robot does into this file (MCAP); `rondo replay` judges the logs of a fleet");
  verb.Option("--state", options->folder,
              "a folder for what has to survive a crash; default: nothing survives");
  verb.Option("--core", options->core,
              "a library that `rondo build` made of the program runs its events, instead of the machine");
  verb.Option("--choreography", options->choreography, "which one of the file, if there are several");
  verb.Flag("--projections", options->projections,
            "let it follow its projection, even where it has a process: on all robots, or on none");
  verb.Option("--option", options->admitted, "an option for every choreography: `equal_durations`").OneEach();
  verb.Option(
          "--tolerance", options->tolerance,
          "metres or radians by which a motion may miss its contract before it counts as broken; it ends within a tenth "
          "of it, and fails at five times as much; default: 0.05")
      .Between(1e-6, 1e3);
  verb.Option(
          "--patience", options->patience,
          "seconds of a choreography without a sign of life of another robot, before this one gives up; default: 1")
      .Between(0.1, 1e5);
  verb.Option("--session", options->session,
              "a number that all robots have in common; another one for each run of a fleet with `--state`");
  verb.Option("--seed", options->seed, "of everything that is random; default: the fleet's, or 1");
  verb.Option(
          "--duration", options->duration,
          "seconds from the first round, or the begin of the session, on; default: until it is over, or stopped")
      .Between(1e-3, 1e7);
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo run examples/koord/lineform --robot drone0 --log drone0.mcap\n"
      "  ROS_DOMAIN_ID=7 rondo run fleet.koord --robot car1\n"
      "  rondo run examples/choreo/handover.rondo --robot cart --log cart.mcap\n"
      "\n"
      "The robot waits for its sensors and for all others. Ctrl-C stops it where it is; how robots are found, and which topics\n"
      "they use, is in docs/robots.md.\n"
      "exit status: 0 its time is over, every robot stopped, or it was interrupted; 1 it lost the others, or something is wrong");
  verb.Run([options, verb, &status] {
    const bool choreography = workspace::IsModuleFile(options->files[0]);
    if (choreography)
      RefuseAll(verb, {"--fleet", "--spec", "--state", "--core"}, "only Koord programs have it");
    else
      RefuseAll(verb, {"--choreography", "--option", "--projections", "--tolerance", "--patience"},
                "only choreographies have it");
    if (!choreography && options->files.size() > 1) RefuseOption("FILE", "a Koord program is one file");
    status = choreography ? RunPart(*options) : Run(*options);
  });
}

}  // namespace rondo::driver
