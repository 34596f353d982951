#include "runs/launch.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

#include "base/file.h"
#include "deploy/keystore.h"
#include "platform/topics.h"
#include "runs/children.h"

namespace rondo::runs {

namespace fs = std::filesystem;

namespace {

class Launcher {
 public:
  Launcher(const RobotProgram& program, const LaunchOptions& options, workspace::Session& session)
      : program_(program), options_(options), session_(session) {}

  base::Result<LaunchReport> Run() {
    if (const auto made = base::MakeFolders(options_.logs); !made.ok())
      return base::Error{fmt::format("cannot use the folder `{}`: {}", options_.logs, made.error().message)};
    StayOnThisMachine();
    const auto with = NetworkOf(program_, deploy::kBodiesEnclave);
    if (!with.ok()) return with.error();
    domain_ = with.value().domain;
    ::setenv("ROS_DOMAIN_ID", fmt::to_string(domain_).c_str(), 1);
    if (const auto started = Start(); !started.ok()) return started.error();
    auto participant = dds::Participant::Open(with.value());
    if (!participant.ok()) return participant.error();
    deploy::Stage stage(program_.loaded->model, program_.fleet, program_.texts.seed, options_.speed,
                        options_.trace);
    if (const auto alone = Alone(*participant.value()); !alone.ok()) return alone.error();
    if (const auto begun = stage.Begin(*participant.value(), Record(), session_.diagnostics); !begun.ok())
      return begun.error();
    const auto listens = Listen(*participant.value());
    if (!listens.ok()) return listens.error();
    Watch(stage);
    children_.End();
    report_.stage = stage.End();
    subscription_.reset();
    report_.robots = children_.Ends();
    Judge();
    return std::move(report_);
  }

 private:
  base::Result<bool> Start() {
    const uint64_t session = static_cast<uint64_t>(platform::WallTime());
    for (const sim::FleetRobot& robot : program_.fleet.robots) {
      const fs::path folder(options_.logs);
      RobotEnd end{robot.name, 0, 0, (folder / (robot.name + ".txt")).string(),
                   (folder / (robot.name + ".mcap")).string()};
      std::error_code ignored;
      for (const std::string& file : LogsOf(robot.name)) fs::remove(file, ignored);
      std::vector<std::string> arguments{options_.executable,
                                         "run",
                                         program_.files.program,
                                         "--robot",
                                         robot.name,
                                         "--fleet",
                                         program_.files.fleet,
                                         "--log",
                                         end.log,
                                         "--seed",
                                         fmt::to_string(program_.texts.seed),
                                         "--session",
                                         fmt::to_string(session)};
      const auto own = options_.cores.find(robot.name), all = options_.cores.find("");
      if (const auto core = own != options_.cores.end() ? own : all; core != options_.cores.end())
        arguments.insert(arguments.end(), {"--core", core->second});
      if (!program_.files.spec.empty()) arguments.insert(arguments.end(), {"--spec", program_.files.spec});
      if (program_.fleet.rounds.disks)
        arguments.insert(arguments.end(), {"--state", (folder / "state").string()});
      if (auto started = children_.Start(arguments, std::move(end)); !started.ok()) return started;
    }
    return true;
  }

  // Bodies of another run would be read and obeyed as if they were ours.
  base::Result<bool> Alone(dds::Participant& participant) const {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    for (const auto& node : participant.Nodes()) {
      for (const sim::FleetRobot& robot : program_.fleet.robots) {
        if (node.name.node_namespace == "/" + robot.node_namespace && node.name.name == "driver")
          return base::Error{fmt::format(
              "somebody else has a driver of `{}` in domain {}: end that, or use another ROS_DOMAIN_ID",
              robot.name, domain_)};
      }
    }
    return true;
  }

  nlohmann::json Record() const {
    nlohmann::json run{{"format", "rondo-trace/1"},
                       {"engine", "launch"},
                       {"program_name", program_.texts.program_name},
                       {"program", program_.texts.program},
                       {"spec", program_.texts.spec},
                       {"fleet", program_.texts.fleet},
                       {"seed", program_.texts.seed},
                       {"delta", program_.fleet.delta}};
    if (!program_.texts.files.is_null()) run["files"] = program_.texts.files;
    return run;
  }

  base::Result<bool> Listen(dds::Participant& participant) {
    const size_t node = participant.AddNode({"/", "rondo_launch"});
    auto subscription =
        participant.Subscribe(node, "/diagnostics", ros::diagnostic_msgs::DiagnosticArray::kMessage,
                              {.depth = 1000}, [this](std::string_view bytes, const dds::Received&) {
                                ros::diagnostic_msgs::DiagnosticArray message;
                                if (!ros::Parse(bytes, message)) return;
                                const std::lock_guard lock(mutex_);
                                for (deploy::RobotStatus& status : deploy::StatusesOf(message))
                                  statuses_[status.robot] = std::move(status);
                              });
    if (!subscription.ok()) return subscription.error();
    subscription_ = std::move(subscription).value();
    return true;
  }

  std::vector<deploy::RobotStatus> Statuses() {
    std::vector<deploy::RobotStatus> all;
    const std::lock_guard lock(mutex_);
    for (const sim::FleetRobot& robot : program_.fleet.robots) {
      const auto known = statuses_.find(robot.name);
      all.emplace_back();
      if (known != statuses_.end()) all.back() = known->second;
      all.back().robot = robot.name;
    }
    return all;
  }

  void Watch(const deploy::Stage& stage) {
    std::optional<double> begun;  // in the world
    const double duration = options_.duration > 0 ? options_.duration : program_.fleet.duration;
    for (int i = 0;; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const auto statuses = Statuses();
      const bool rounds = std::ranges::any_of(statuses, [](const auto& s) { return s.round > 0; });
      if (rounds && !begun) begun = stage.time();
      if (begun) report_.time = stage.time() - *begun;
      if (options_.progress && i % 25 == 0) options_.progress(statuses, report_.time);
      report_.interrupted = options_.stop.StopRequested();
      const size_t running = children_.Running();
      // Without one of them the first round never comes.
      const bool hopeless = !begun && running < program_.fleet.robots.size();
      if (report_.interrupted || report_.time >= duration || running == 0 || hopeless) return;
    }
  }

  void Judge() {
    std::vector<deploy::RobotLog> logs;
    for (RobotEnd& end : report_.robots) {
      // Also of lives that somebody began by hand.
      const std::vector<std::string> files = LogsOf(end.robot);
      end.log = files.empty() ? "" : files.front();
      for (const std::string& file : files) {
        auto log = deploy::ReadRobotLog(file);
        if (log.ok())
          logs.push_back(std::move(log).value());
        else
          report_.problem = fmt::format("`{}`: {}", file, log.error().message);
      }
    }
    auto judged = deploy::JudgeLogs(logs, program_.loaded->model, program_.fleet, base::StopToken(),
                                    session_.diagnostics);
    if (judged.ok())
      report_.logs = std::move(judged).value();
    else
      report_.problem = judged.error().message;
  }

  // `bot0.mcap`, `bot0.2.mcap`, ..., complete or not.
  std::vector<std::string> LogsOf(const std::string& robot) const {
    std::vector<std::string> files;
    std::error_code ignored;
    for (int life = 1;; ++life) {
      const fs::path path =
          fs::path(options_.logs) / (life == 1 ? robot + ".mcap" : fmt::format("{}.{}.mcap", robot, life));
      for (const std::string& name : {path.string(), path.string() + ".partial"}) {
        if (fs::is_regular_file(name, ignored)) files.push_back(name);
      }
      if (files.size() < static_cast<size_t>(life)) return files;
    }
  }

  const RobotProgram& program_;
  const LaunchOptions& options_;
  workspace::Session& session_;
  LaunchReport report_;
  uint32_t domain_ = 0;
  std::mutex mutex_;
  std::map<std::string, deploy::RobotStatus> statuses_;
  std::unique_ptr<dds::Subscription> subscription_;
  Children children_;
};

}  // namespace

base::Result<LaunchReport> Launch(const RobotProgram& program, const LaunchOptions& options,
                                  workspace::Session& session) {
  return Launcher(program, options, session).Run();
}

}  // namespace rondo::runs
