#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/file.h"
#include "driver/choreography_robots.h"
#include "driver/command.h"
#include "driver/logs_text.h"
#include "driver/page.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/launch.h"
#include "workspace/module_files.h"

namespace rondo::driver {

namespace fs = std::filesystem;
using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> cores;
  std::vector<std::string> files;
  std::string choreography;
  std::vector<std::string> admitted;
  bool projections = false;
  double tolerance = 0;
  std::string fleet;
  std::string spec;
  std::string logs;
  std::string trace;
  std::string ros2;
  std::optional<uint64_t> seed;
  double duration = 0;
  double speed = 1;
  bool fail_on_collision = false;
  bool open = false;
  bool json = false;
};

nlohmann::json Finite(double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(nullptr); }

std::string TextOf(const deploy::StageReport& stage) {
  std::string text = stage.collisions > 0 ? fmt::format("  {}; the first at {:.6g} s: {}\n",
                                                        base::Counted(stage.collisions, "collision"),
                                                        stage.first_collision, stage.first_pair)
                                          : "  no collision\n";
  if (std::isfinite(stage.least_between_robots))
    text += fmt::format("  robots never closer than {:.3f} m\n", stage.least_between_robots);
  if (std::isfinite(stage.least_to_obstacles))
    text += fmt::format("  obstacles never closer than {:.3f} m\n", stage.least_to_obstacles);
  if (stage.behind > 0.1)
    text +=
        fmt::format("  this machine is too slow: the bodies were {:.2f} s behind the clock\n", stage.behind);
  if (!stage.failed.empty()) text += fmt::format("  {}\n", stage.failed);
  return text;
}

std::string TextOf(const runs::RobotEnd& end) {
  if (end.signal != 0)
    return fmt::format("  {}: signal {} ended it; what it said is in {}\n", end.robot, end.signal,
                       end.output);
  if (end.status != 0)
    return fmt::format("  {}: ended with status {}; what it said is in {}\n", end.robot, end.status,
                       end.output);
  return {};
}

nlohmann::json ToJson(const runs::LaunchReport& report) {
  nlohmann::json robots = nlohmann::json::array();
  for (const runs::RobotEnd& end : report.robots)
    robots.push_back({{"name", end.robot},
                      {"status", end.status},
                      {"signal", end.signal},
                      {"output", end.output},
                      {"log", end.log}});
  const deploy::StageReport& stage = report.stage;
  return {{"time", report.time},
          {"interrupted", report.interrupted},
          {"collisions", stage.collisions},
          {"least_between_robots", Finite(stage.least_between_robots)},
          {"least_to_obstacles", Finite(stage.least_to_obstacles)},
          {"behind", stage.behind},
          {"robots", robots},
          {"problem", report.problem},
          {"judged", report.logs ? LogsJson(*report.logs) : nlohmann::json(nullptr)}};
}

// One line for the terminal: how far they are, and who has a problem.
std::string Line(const std::vector<deploy::RobotStatus>& robots, double time) {
  uint64_t most = 0;
  size_t active = 0;
  double median = 0;
  std::string problems;
  for (const deploy::RobotStatus& s : robots) {
    most = std::max(most, s.round);
    active += s.active ? 1 : 0;
    median = std::max(median, s.median);
    if (!s.sensors.empty())
      problems += fmt::format("; {}: {}", s.robot, s.sensors);
    else if (!s.unheard.empty())
      problems += fmt::format("; {} misses {}", s.robot, fmt::join(s.unheard, ", "));
  }
  return fmt::format("[{:.0f} s] round {}, final after {:.2g} ms; {} of {} act{}", time, most, median, active,
                     robots.size(), problems)
      .substr(0, 150);
}

ExitStatus StatusOf(const runs::LaunchReport& report, const Options& options) {
  if (!report.logs || !report.stage.failed.empty()) return ExitStatus::kRejected;
  if (options.fail_on_collision && report.stage.collisions > 0) return ExitStatus::kRejected;
  for (const runs::RobotEnd& end : report.robots) {
    if (end.status != 0) return ExitStatus::kRejected;
  }
  const ExitStatus judged = LogsStatus(*report.logs);
  return judged == ExitStatus::kEstablished && report.interrupted ? ExitStatus::kUndecided : judged;
}

ExitStatus Fail(const Options& options, const workspace::Session& session, const std::string& why) {
  return Refuse("launch", options.files[0], options.json, session.sources, session.diagnostics, why);
}

// A description for `ros2 launch`, which is Python.
ExitStatus WriteDescription(const Options& options, const runs::RobotProgram& program) {
  const auto quoted = [](const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  std::string more;
  if (!options.spec.empty()) more += ", \"--spec\", " + quoted(fs::absolute(options.spec).string());
  if (options.seed) more += fmt::format(", \"--seed\", \"{}\"", *options.seed);
  std::string names;
  for (const sim::FleetRobot& robot : program.fleet.robots) names += quoted(robot.name) + ", ";
  const std::string text = fmt::format(
      R"py(# Runs the robots of a fleet: `ros2 launch {0}`, or one of them: `ros2 launch {0} robot:=NAME`. Made by `rondo launch --ros2`.
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PythonExpression

ROBOTS = [{1}]


def generate_launch_description():
    robot = LaunchConfiguration("robot")
    actions = [
        DeclareLaunchArgument("robot", default_value="", description="which robot; default: all"),
        DeclareLaunchArgument("program", default_value={2}, description="the Koord program"),
        DeclareLaunchArgument("fleet", default_value={3}, description="the fleet"),
        DeclareLaunchArgument("session", default_value="0", description="a number that all robots have in common"),
    ]
    for name in ROBOTS:
        actions.append(ExecuteProcess(
            cmd=["rondo", "run", LaunchConfiguration("program"), "--fleet", LaunchConfiguration("fleet"), "--robot", name,
                 "--session", LaunchConfiguration("session"), "--log", name + ".mcap"{4}],
            output="screen", condition=IfCondition(PythonExpression(["'", robot, "' in ('', '", name, "')"]))))
    return LaunchDescription(actions)
)py",
      fs::path(options.ros2).filename().string(), names, quoted(fs::absolute(program.files.program).string()),
      quoted(fs::absolute(program.files.fleet).string()), more);
  const auto written = base::WriteFileAtomically(options.ros2, text);
  if (!written.ok()) {
    PrintFailure(fmt::format("cannot write `{}`: {}", options.ros2, written.error().message));
    return ExitStatus::kRejected;
  }
  Print(fmt::format("wrote {}\n", options.ros2));
  return ExitStatus::kEstablished;
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  const auto program = runs::LoadRobotProgram(
      runs::FindSimulationFiles(options.files[0], options.spec, options.fleet), options.seed, session);
  if (!program) return Fail(options, session, {});
  if (!options.ros2.empty()) return WriteDescription(options, *program);
  runs::LaunchOptions launch;
  launch.executable = fs::read_symlink("/proc/self/exe").string();
  launch.duration = options.duration;
  launch.speed = options.speed;
  if (options.speed != 1 && !program->fleet.ros.use_sim_time)
    return Fail(options, session,
                "`--speed` needs a fleet whose time is simulated: `use_sim_time = true` in its `[ros]`");
  launch.logs = options.logs;
  for (const std::string& core : options.cores) {
    const size_t equals = core.find('=');
    const std::string robot = equals == std::string::npos ? "" : core.substr(0, equals);
    if (!robot.empty() && std::ranges::find(program->fleet.robots, robot, &sim::FleetRobot::name) ==
                              program->fleet.robots.end())
      return Fail(options, session, fmt::format("`--core {}`: the fleet has no robot `{}`", core, robot));
    launch.cores[robot] = equals == std::string::npos ? core : core.substr(equals + 1);
  }
  std::optional<trace::Writer> writer;
  if (!options.trace.empty()) {
    auto opened = trace::Writer::Open(options.trace);
    if (!opened.ok())
      return Fail(options, session,
                  fmt::format("cannot write `{}`: {}", options.trace, opened.error().message));
    writer.emplace(std::move(opened).value());
    launch.trace = &*writer;
  }
  if (launch.logs.empty()) {
    const auto folder = base::MakeTemporaryFolder();
    if (!folder.ok())
      return Fail(options, session,
                  fmt::format("cannot make a folder for the logs: {}", folder.error().message));
    launch.logs = folder.value();
  }
  base::Result<runs::LaunchReport> ran = base::Error{};
  {
    ProgressLine line;
    const InterruptScope interrupt(launch.stop);
    launch.progress = [&](const auto& robots, double time) { line.Show(Line(robots, time)); };
    ran = runs::Launch(*program, launch, session);
  }
  if (!ran.ok()) {
    std::error_code left;
    if (options.logs.empty()) fs::remove_all(launch.logs, left);
    return Fail(options, session, ran.error().message);
  }
  const runs::LaunchReport& report = ran.value();
  ExitStatus status = StatusOf(report, options);
  if (writer) {
    if (const auto done = writer->Finish(); !done.ok()) {
      PrintFailure(fmt::format("cannot write `{}`: {}", options.trace, done.error().message));
      status = ExitStatus::kRejected;
    }
  }
  const bool keep = !options.logs.empty() || status == ExitStatus::kRejected;
  std::error_code ignored;
  if (!keep) fs::remove_all(launch.logs, ignored);
  if (options.json) {
    nlohmann::json out = ToJson(report);
    out["command"] = "launch";
    out["file"] = program->files.program;
    out["status"] = status;
    if (keep) out["logs"] = launch.logs;
    out["diagnostics"] = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson(out);
    return status;
  }
  std::string text =
      fmt::format("{}: {}, each a process, bodies over ROS topics\n  {:.1f} s\n", program->files.program,
                  base::Counted(program->fleet.robots.size(), "robot"), report.time);
  if (report.logs) text += LogsText(*report.logs);
  if (!report.problem.empty()) text += fmt::format("  the logs cannot be judged: {}\n", report.problem);
  text += TextOf(report.stage);
  for (const runs::RobotEnd& end : report.robots) text += TextOf(end);
  if (report.interrupted) text += "  interrupted\n";
  Print(text);
  if (keep) Print(fmt::format("logs: {0}: `rondo replay {0}/*.mcap*`\n", launch.logs));
  if (writer) Print(fmt::format("trace: {}\n", options.trace));
  PrintDiagnostics(session.sources, session.diagnostics);
  return status;
}

ExitStatus LaunchParts(const Options& options) {
  LaunchedChoreographyOptions launched;
  launched.files = {options.files, options.admitted, options.choreography, options.projections};
  launched.launch.logs = options.logs;
  launched.launch.trace = options.trace;
  launched.launch.seed = options.seed.value_or(1);
  launched.launch.duration = options.duration;
  launched.launch.tolerance = options.tolerance;
  launched.json = options.json;
  return LaunchChoreography(launched);
}

}  // namespace

void AddLaunchVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "launch", "run all robots on this machine: a process for each, bodies over ROS topics");
  verb.Option(
          "FILE", options->files,
          "a Koord program, with or without `.koord`; `NAME.toml` beside it is the fleet. Or a choreography (`.rondo`), with "
          "what belongs to it")
      .Required();
  verb.Option("--fleet", options->fleet, "the fleet, if it is not beside the program");
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option(
          "--core", options->cores,
          "a library that `rondo build` made of the program runs the events of the robots, or with `NAME=LIBRARY` of one of them, "
          "instead of the machine")
      .OneEach();
  verb.Option("--choreography", options->choreography, "which one of the file, if there are several");
  verb.Flag("--projections", options->projections,
            "let each robot follow its projection, even where it has a process");
  verb.Option("--option", options->admitted, "an option for every choreography: `equal_durations`").OneEach();
  verb.Option("--tolerance", options->tolerance,
              "metres or radians by which a motion may miss its contract; default: 0.05")
      .Between(1e-6, 1e3);
  verb.Option(
          "--duration", options->duration,
          "seconds from the first round on; default: as the fleet says, or until the choreography is over")
      .Between(1e-3, 1e7);
  verb.Option("--speed", options->speed,
              "how many seconds pass in one, if the fleet has `use_sim_time`; default: 1")
      .Between(0.01, 100.0);
  verb.Option("--seed", options->seed, "of everything that is random; default: the fleet's, or 1");
  verb.Option("--logs", options->logs,
              "a folder for what each robot logs and says; default: it is kept only if something is wrong");
  verb.Option("--trace", options->trace, "write where the bodies are into this file (MCAP)");
  verb.Flag("--open", options->open, "show it in a browser, with `--trace` or without (`rondo view`)");
  verb.Option("--ros2", options->ros2,
              "write a file for `ros2 launch` that runs the robots, and start nothing");
  verb.Flag("--fail-on-collision", options->fail_on_collision, "exit status 1 if robots touch anything");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo launch examples/koord/lineform --duration 30\n"
      "  ROS_DOMAIN_ID=7 rondo launch examples/koord/delivery --logs logs\n"
      "  rondo launch examples/choreo/handover.rondo --trace handover.mcap\n"
      "\n"
      "Nothing but DDS is between the processes. While they run, the usual tools see them: `ros2 topic list`, RViz.\n"
      "Behind the run its logs are judged: each round by the program, each final state by its invariants; each message by the\n"
      "choreography.\n"
      "exit status: 0 nothing is wrong, 1 something is, 3 not everything could be judged, or interrupted");
  verb.Run([options, verb, &status] {
    const bool choreography = workspace::IsModuleFile(options->files[0]);
    if (choreography)
      RefuseAll(verb, {"--fleet", "--spec", "--core", "--speed", "--ros2", "--fail-on-collision"},
                "only Koord programs have it");
    else
      RefuseAll(verb, {"--choreography", "--option", "--projections", "--tolerance"},
                "only choreographies have it");
    if (!choreography && options->files.size() > 1) RefuseOption("FILE", "a Koord program is one file");
    if (options->open && options->trace.empty()) options->trace = PlaceForTrace();
    status = choreography ? LaunchParts(*options) : Run(*options);
    if (options->open) ShowTrace(options->trace, options->json);
  });
}

}  // namespace rondo::driver
