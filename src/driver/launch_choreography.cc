#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/file.h"
#include "driver/choreography_robots.h"
#include "driver/terminal.h"

namespace rondo::driver {

namespace fs = std::filesystem;
using deploy::Did;
using nlohmann::json;
using verdict::ExitStatus;

namespace {

json Finite(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

std::string TextOf(const deploy::SessionsReport& judged) {
  std::string text = fmt::format("  {}, {}", base::Counted(judged.messages, "message"),
                                 base::Counted(judged.motions, "motion"));
  text += judged.findings.empty() ? "; their order is as the choreography says\n" : "\n";
  for (const std::string& finding : judged.findings) text += fmt::format("  {}\n", finding);
  for (const auto& end : judged.ends)
    text += end.why.empty() ? fmt::format("  {}: {}\n", end.robot, end.outcome)
                            : fmt::format("  {}: {}: {}\n", end.robot, end.outcome, end.why);
  for (const std::string& gap : judged.gaps) text += fmt::format("  not judged: {}\n", gap);
  for (const auto& miss : judged.broken)
    text += std::isfinite(miss.missed) ? fmt::format("  `{}: {}` missed its contract by {:.2g} (SI units)\n",
                                                     miss.robot, miss.motion, miss.missed)
                                       : fmt::format("  `{}: {}`: its contract has no value where it was\n",
                                                     miss.robot, miss.motion);
  if (judged.late > kTellLate)
    text += fmt::format("  motions took up to {:.2f} s longer than they may\n", judged.late);
  if (judged.broken.empty() && judged.worst.missed > 0)
    text += fmt::format("  contracts kept up to {:.2g} (SI units), as sensors tell: `{}: {}` missed most\n",
                        judged.worst.missed, judged.worst.robot, judged.worst.motion);
  return text;
}

json JsonOf(const deploy::SessionsReport& judged) {
  json broken = json::array();
  for (const auto& m : judged.broken)
    broken.push_back({{"robot", m.robot}, {"motion", m.motion}, {"missed", Finite(m.missed)}});
  json ends = json::array();
  for (const auto& e : judged.ends)
    ends.push_back({{"robot", e.robot}, {"ended", e.outcome}, {"why", e.why}});
  return {{"messages", judged.messages},
          {"motions", judged.motions},
          {"findings", judged.findings},
          {"gaps", judged.gaps},
          {"ends", ends},
          {"broken", broken},
          {"missed", Finite(judged.worst.missed)},
          {"late", judged.late}};
}

// Whether robots were stopped is for whoever judges to say.
ExitStatus StatusOf(const deploy::SessionsReport& judged) {
  if (!judged.findings.empty() || !judged.broken.empty()) return ExitStatus::kRejected;
  bool whole = judged.gaps.empty();
  for (const auto& end : judged.ends) {
    if (end.outcome == "failed" || end.outcome == "lost") return ExitStatus::kRejected;
    whole = false;
  }
  return whole ? ExitStatus::kEstablished : ExitStatus::kUndecided;
}

// What became of the process of a robot, if its log does not say it.
std::string EndOf(const runs::LaunchChoreographyReport& report, const runs::RobotEnd& end) {
  if (report.interrupted || report.time_over) return {};
  if (end.signal != 0)
    return fmt::format("  {}: signal {} ended it; what it said is in {}\n", end.robot, end.signal,
                       end.output);
  const auto of_it = [&](const auto& list) {
    return std::ranges::any_of(list, [&](const auto& one) { return one.robot == end.robot; });
  };
  if (end.status == 0 || of_it(report.judged.ends) || of_it(report.judged.broken)) return {};
  return fmt::format("  {}: ended with status {}; what it said is in {}\n", end.robot, end.status,
                     end.output);
}

ExitStatus StatusOf(const runs::LaunchChoreographyReport& report) {
  const ExitStatus judged = StatusOf(report.judged);
  bool bad = !report.stage.incidents.empty() || judged == ExitStatus::kRejected;
  for (const runs::RobotEnd& end : report.robots) bad = bad || !EndOf(report, end).empty();
  if (bad) return ExitStatus::kRejected;
  return report.interrupted ? ExitStatus::kUndecided : judged;
}

std::string TextOf(const runs::LaunchChoreographyReport& report) {
  std::string text = fmt::format("  {:.1f} s\n", report.time) + TextOf(report.judged);
  for (const auto& i : report.stage.incidents)
    text += fmt::format("  {}: {}, at {:.3g} s\n", Name(i.wrong), i.what, i.first);
  if (report.stage.incidents.empty()) text += "  no collision; looked at every 0.01 s\n";
  if (std::isfinite(report.stage.least_between_robots))
    text += fmt::format("  robots never closer than {:.3f} m\n", report.stage.least_between_robots);
  if (std::isfinite(report.stage.least_to_obstacles))
    text += fmt::format("  obstacles never closer than {:.3f} m\n", report.stage.least_to_obstacles);
  for (const std::string& what : report.stage.unchecked) text += fmt::format("  not checked: {}\n", what);
  if (report.behind > 0.1)
    text +=
        fmt::format("  this machine is too slow: the bodies were {:.2f} s behind the clock\n", report.behind);
  std::string ends;
  for (const runs::RobotEnd& end : report.robots) ends += EndOf(report, end);
  if (report.interrupted) return text + ends + "  interrupted\n";
  if (report.time_over) return text + ends + "  the time was over\n";
  const bool whole = ends.empty() && report.judged.ends.empty() && report.judged.gaps.empty();
  return text + (whole ? "  every robot is at its end\n" : ends);
}

json JsonOf(const runs::LaunchChoreographyReport& report) {
  json robots = json::array(), incidents = json::array();
  for (const runs::RobotEnd& end : report.robots) {
    const auto left = report.left.find(end.robot);
    robots.push_back({{"name", end.robot},
                      {"status", end.status},
                      {"signal", end.signal},
                      {"ended", left == report.left.end() ? json(nullptr) : json(left->second.outcome)},
                      {"why", left == report.left.end() ? "" : left->second.what},
                      {"output", end.output},
                      {"log", end.log}});
  }
  for (const auto& i : report.stage.incidents)
    incidents.push_back({{"kind", Name(i.wrong)}, {"what", i.what}, {"first", i.first}});
  return {{"time", report.time},
          {"interrupted", report.interrupted},
          {"time_over", report.time_over},
          {"robots", robots},
          {"incidents", incidents},
          {"least_between_robots", Finite(report.stage.least_between_robots)},
          {"least_to_obstacles", Finite(report.stage.least_to_obstacles)},
          {"unchecked", report.stage.unchecked},
          {"behind", report.behind},
          {"judged", JsonOf(report.judged)}};
}

// A file as a shell takes it.
std::string Quoted(const std::string& file) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-";
  if (file.find_first_not_of(kPlain) == std::string::npos) return file;
  std::string quoted = "'";
  for (const char c : file) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// One line for the terminal: what each robot did last.
std::string Line(const std::map<std::string, deploy::SessionEvent>& robots, double time) {
  std::string text = fmt::format("[{:.0f} s]", time);
  for (const auto& [robot, event] : robots) {
    text += fmt::format(" {}: {}", robot,
                        event.did == Did::kBegins ? event.what
                        : event.what.empty()      ? std::string(Name(event.did))
                                                  : fmt::format("{} {}", Name(event.did), event.what));
  }
  return text.substr(0, 150);
}

}  // namespace

ExitStatus LaunchChoreography(LaunchedChoreographyOptions options) {
  workspace::Session session;
  const std::string& file = options.files.files.front();
  const auto fail = [&](const std::string& why) {
    return Refuse("launch", file, options.json, session.sources, session.diagnostics, why);
  };
  const auto staged = runs::StageChoreography(options.files, session);
  if (!staged) return fail("");
  runs::LaunchChoreographyOptions& launch = options.launch;
  launch.executable = fs::read_symlink("/proc/self/exe").string();
  const bool wanted = !launch.logs.empty();
  if (!wanted) {
    const auto folder = base::MakeTemporaryFolder();
    if (!folder.ok())
      return fail(fmt::format("cannot make a folder for the logs: {}", folder.error().message));
    launch.logs = folder.value();
  }
  base::Result<runs::LaunchChoreographyReport> ran = base::Error{};
  {
    ProgressLine line;
    const InterruptScope interrupt(launch.stop);
    launch.progress = [&](const auto& robots, double time) { line.Show(Line(robots, time)); };
    ran = runs::LaunchChoreography(options.files, *staged, launch, session);
  }
  std::error_code ignored;
  if (!ran.ok()) {
    if (!wanted) fs::remove_all(launch.logs, ignored);
    return fail(ran.error().message);
  }
  const runs::LaunchChoreographyReport& report = ran.value();
  const ExitStatus status = StatusOf(report);
  const bool keep = wanted || status == ExitStatus::kRejected;
  if (!keep) fs::remove_all(launch.logs, ignored);
  const std::string& name = staged->cast.graph->source->name.text;
  if (options.json) {
    json out = JsonOf(report);
    out["command"] = "launch";
    out["file"] = file;
    out["choreography"] = name;
    out["seed"] = launch.seed;
    out["status"] = status;
    if (keep) out["logs"] = launch.logs;
    out["diagnostics"] = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson(out);
    return status;
  }
  Print(fmt::format("{}: {}, each a process, bodies over ROS topics; seed {}\n{}", name,
                    base::Counted(report.robots.size(), "robot"), launch.seed, TextOf(report)));
  if (keep) {
    std::string replay;
    for (const runs::RobotEnd& end : report.robots) replay += " " + Quoted(end.log);
    Print(fmt::format("logs: `rondo replay{}`\n", replay));
  }
  if (!launch.trace.empty()) Print(fmt::format("trace: {}\n", launch.trace));
  PrintDiagnostics(session.sources, session.diagnostics);
  return status;
}

ExitStatus JudgeChoreography(const std::vector<deploy::SessionLog>& logs, const std::string& file,
                             bool as_json) {
  workspace::Session session;
  const auto fail = [&](const std::string& why) {
    return Refuse("replay", file, as_json, session.sources, session.diagnostics, why);
  };
  const auto staged = runs::StageRecorded(logs[0].run, session);
  if (!staged) return fail("the choreography that the log keeps cannot be used");
  const auto judged = deploy::JudgeSessions(logs, staged->cast);
  if (!judged.ok()) return fail(judged.error().message);
  const ExitStatus status = StatusOf(judged.value());
  if (as_json) {
    json out = JsonOf(judged.value());
    out["command"] = "replay";
    out["file"] = file;
    out["status"] = status;
    out["diagnostics"] = diag::RenderJson(session.sources, session.diagnostics);
    PrintJson(out);
    return status;
  }
  Print(fmt::format("{} of {}\n{}", base::Counted(logs.size(), "log"), staged->cast.graph->source->name.text,
                    TextOf(judged.value())));
  return status;
}

}  // namespace rondo::driver
