#include "runs/launch_choreography.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/file.h"
#include "platform/topics.h"
#include "ros/names.h"

namespace rondo::runs {

namespace fs = std::filesystem;
using deploy::Did;

namespace {

class Launcher {
 public:
  Launcher(const ChoreographyFiles& files, const StagedChoreography& staged,
           const LaunchChoreographyOptions& options, const workspace::Session& session)
      : files_(files), staged_(staged), graph_(*staged.cast.graph), options_(options), session_(session) {}

  base::Result<LaunchChoreographyReport> Run() {
    if (const auto made = base::MakeFolders(options_.logs); !made.ok())
      return base::Error{fmt::format("cannot use the folder `{}`: {}", options_.logs, made.error().message)};
    StayOnThisMachine();
    const auto network = ChoreographyNetwork();
    if (!network.ok()) return network.error();
    ::setenv("ROS_DOMAIN_ID", fmt::to_string(network.value().domain).c_str(), 1);
    auto participant = dds::Participant::Open(network.value());
    if (!participant.ok()) return participant.error();
    if (const auto alone = Alone(*participant.value(), network.value().domain); !alone.ok())
      return alone.error();
    report_.interrupted = options_.stop.StopRequested();
    if (report_.interrupted) return std::move(report_);
    if (const auto opened = OpenTrace(); !opened.ok()) return opened.error();
    deploy::ChoreographyStage stage(staged_.cast, options_.seed, recorder_ ? &*recorder_ : nullptr);
    if (const auto begun = stage.Begin(*participant.value()); !begun.ok()) return begun.error();
    if (const auto started = Start(); !started.ok()) return started.error();
    Watch(stage);
    children_.End();
    Hear(stage);
    report_.stage = stage.End();
    report_.behind = stage.behind();
    report_.robots = children_.Ends();
    if (writer_) {
      if (const auto done = writer_->Finish(); !done.ok())
        return base::Error{fmt::format("cannot write `{}`: {}", options_.trace, done.error().message)};
    }
    if (const auto judged = Judge(); !judged.ok()) return judged.error();
    return std::move(report_);
  }

 private:
  base::Result<bool> OpenTrace() {
    if (options_.trace.empty()) return true;
    for (const choreo::Name& robot : graph_.robots) {
      if (fs::weakly_canonical(options_.trace) == fs::weakly_canonical(LogOf(robot.text)))
        return base::Error{
            fmt::format("`{}` is the log of `{}`: the trace needs another name", options_.trace, robot.text)};
    }
    auto opened = trace::Writer::Open(options_.trace);
    if (!opened.ok())
      return base::Error{fmt::format("cannot write `{}`: {}", options_.trace, opened.error().message)};
    writer_.emplace(std::move(opened).value());
    nlohmann::json record = LogRecordOf(files_, staged_, session_);
    record["live"] = true;
    record["seed"] = options_.seed;
    recorder_.emplace(*writer_, graph_, staged_.module->arena, record);
    return true;
  }

  // Bodies of another run would be read and obeyed as if they were ours.
  base::Result<bool> Alone(dds::Participant& participant, uint32_t domain) const {
    constexpr int kLooks = 25;
    for (int i = 0; i < kLooks && !options_.stop.StopRequested(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::vector<std::string> ours{"environment"};
    for (const choreo::Name& robot : graph_.robots) ours.push_back(ros::Plain(robot.text));
    for (const auto& node : participant.Nodes()) {
      for (const std::string& robot : ours) {
        if (node.name.node_namespace == "/" + robot && node.name.name == "driver")
          return base::Error{fmt::format(
              "somebody else has a driver of `{}` in domain {}: end that, or use another ROS_DOMAIN_ID",
              robot, domain)};
      }
    }
    return true;
  }

  std::string LogOf(const std::string& robot) const {
    return (fs::path(options_.logs) / (robot + ".mcap")).string();
  }

  base::Result<bool> Start() {
    const uint64_t session = static_cast<uint64_t>(platform::WallTime());
    for (const choreo::Name& robot : graph_.robots) {
      RobotEnd end{robot.text, 0, 0, (fs::path(options_.logs) / (robot.text + ".txt")).string(),
                   LogOf(robot.text)};
      std::error_code ignored;
      for (const std::string& file : {end.log, end.log + ".partial"}) fs::remove(file, ignored);
      std::vector<std::string> arguments{options_.executable, "run"};
      arguments.insert(arguments.end(), files_.files.begin(), files_.files.end());
      for (const std::string& option : files_.admitted)
        arguments.insert(arguments.end(), {"--option", option});
      if (files_.projections) arguments.emplace_back("--projections");
      arguments.insert(arguments.end(),
                       {"--choreography", graph_.source->name.text, "--robot", robot.text, "--log", end.log,
                        "--seed", fmt::to_string(options_.seed), "--session", fmt::to_string(session)});
      if (options_.tolerance > 0)
        arguments.insert(arguments.end(), {"--tolerance", fmt::format("{:.17g}", options_.tolerance)});
      if (auto started = children_.Start(arguments, std::move(end)); !started.ok()) return started;
    }
    return true;
  }

  void Hear(deploy::ChoreographyStage& stage) {
    for (deploy::SessionEvent& event : stage.TakeEvents()) {
      if (event.did == Did::kStarts && !begun_) begun_ = stage.time();
      if (event.did == Did::kLeaves && !stopping_) report_.left.emplace(event.robot, event);
      last_.insert_or_assign(event.robot, std::move(event));
    }
    if (begun_) report_.time = stage.time() - *begun_;
  }

  void Watch(deploy::ChoreographyStage& stage) {
    for (int i = 0;; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      Hear(stage);
      if (options_.progress && i % 10 == 0) options_.progress(last_, report_.time);
      if (children_.Running() == 0) return;
      report_.interrupted = options_.stop.StopRequested();
      report_.time_over = options_.duration > 0 && report_.time >= options_.duration;
      stopping_ = report_.interrupted || report_.time_over;
      // Without one of them it never begins, and ends soon.
      const bool apart = children_.Running() < graph_.robots.size() || !report_.left.empty();
      if (!apart) whole_ = stage.time();
      constexpr double kFarewell = 5;  // seconds
      const bool hopeless = apart && (!begun_ || stage.time() - whole_ > kFarewell);
      const bool never = options_.duration > 0 && !begun_ && stage.time() > options_.duration + kFarewell;
      if (stopping_ || hopeless || never) return;
    }
  }

  base::Result<bool> Judge() {
    std::vector<deploy::SessionLog> logs;
    std::vector<std::string> unread;
    for (const choreo::Name& robot : graph_.robots) {
      const std::string whole = LogOf(robot.text);
      std::error_code ignored;
      const std::string file = fs::is_regular_file(whole, ignored) ? whole : whole + ".partial";
      for (RobotEnd& end : report_.robots) {
        if (end.robot == robot.text) end.log = file;
      }
      auto log = deploy::ReadSessionLog(file);
      if (log.ok())
        logs.push_back(std::move(log).value());
      else
        unread.push_back(fmt::format("`{}`: {}", file, log.error().message));
    }
    auto judged = deploy::JudgeSessions(logs, staged_.cast);
    if (!judged.ok()) return judged.error();
    report_.judged = std::move(judged).value();
    // That those were stopped who were told to stop is nothing to tell.
    if (stopping_)
      std::erase_if(report_.judged.ends,
                    [](const auto& end) { return end.outcome == "left" || end.outcome == "stopped"; });
    report_.judged.gaps.insert(report_.judged.gaps.end(), unread.begin(), unread.end());
    return true;
  }

  const ChoreographyFiles& files_;
  const StagedChoreography& staged_;
  const choreo::Graph& graph_;
  const LaunchChoreographyOptions& options_;
  const workspace::Session& session_;
  std::optional<trace::Writer> writer_;
  std::optional<sim::motions::StageRecorder> recorder_;
  std::map<std::string, deploy::SessionEvent> last_;  // by robot
  std::optional<double> begun_;                       // seconds of the stage
  double whole_ = 0;                                  // seconds of the stage until which all were there
  bool stopping_ = false;
  LaunchChoreographyReport report_;
  Children children_;
};

}  // namespace

base::Result<LaunchChoreographyReport> LaunchChoreography(const ChoreographyFiles& files,
                                                          const StagedChoreography& staged,
                                                          const LaunchChoreographyOptions& options,
                                                          const workspace::Session& session) {
  return Launcher(files, staged, options, session).Run();
}

base::Result<dds::Network> ChoreographyNetwork() {
  dds::Network network;
  network.profile = dds::Profile::kLan;
  return dds::WithEnvironment(network);
}

nlohmann::json LogRecordOf(const ChoreographyFiles& files, const StagedChoreography& staged,
                           const workspace::Session& session) {
  nlohmann::json record = RecordOf(files, staged, {}, session);
  record.erase("duration");
  record.erase("seed");
  return record;
}

}  // namespace rondo::runs
