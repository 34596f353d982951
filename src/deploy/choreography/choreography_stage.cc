#include "deploy/choreography/choreography_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "ros/std_msgs.h"
#include "sim/motions/beginning.h"

namespace rondo::deploy {

using sim::motions::Wrong;

ChoreographyStage::ChoreographyStage(const choreo::Cast& cast, uint64_t seed,
                                     sim::motions::StageRecorder* recorder)
    : cast_(cast),
      recorder_(recorder),
      random_(seed),
      scene_(*cast.graph->world),
      drivers_(*cast.graph->world, cast.declarations->evaluator().arena(), scene_) {}

base::Result<bool> ChoreographyStage::Begin(dds::Participant& participant) {
  expr::Arena& arena = cast_.declarations->evaluator().arena();
  if (const std::string both = platform::Collision(*cast_.graph->world, arena, scene_); !both.empty())
    return base::Error{both};
  if (!sim::motions::Place(*cast_.graph, arena, scene_, random_))
    return base::Error{"no state was found in which the choreography may begin"};
  disturbances_.emplace(*cast_.graph->world, arena, scene_, random_);
  contacts_.emplace(*cast_.graph->world, arena, scene_, report_);
  if (auto begun = drivers_.Begin(participant); !begun.ok()) return begun;
  if (auto listens = Listen(participant); !listens.ok()) return listens;
  thread_ = std::thread([this] { Run(); });
  return true;
}

base::Result<bool> ChoreographyStage::Listen(dds::Participant& participant) {
  const size_t node = participant.AddNode({"/", "rondo_launch"});
  for (size_t r = 0; r < cast_.graph->robots.size(); ++r) {
    const auto topics =
        platform::TopicsOf(*cast_.graph->world, r, cast_.declarations->evaluator().arena(), scene_);
    auto made =
        participant.Subscribe(node, topics.Full("events"), ros::std_msgs::String::kMessage, {.depth = 1000},
                              [this, r](std::string_view bytes, const dds::Received&) { Hear(r, bytes); });
    if (!made.ok()) return made.error();
    subscriptions_.push_back(std::move(made).value());
  }
  return true;
}

void ChoreographyStage::Hear(size_t robot, std::string_view bytes) {
  ros::std_msgs::String m;
  if (!ros::Parse(bytes, m)) return;
  auto event = EventIn(nlohmann::json::parse(m.data, nullptr, false));
  if (!event || event->robot != cast_.graph->robots[robot].text) return;
  const std::lock_guard lock(mutex_);
  events_.push_back(*event);
  heard_.emplace_back(robot, std::move(*event));
}

std::vector<SessionEvent> ChoreographyStage::TakeEvents() {
  const std::lock_guard lock(mutex_);
  return std::exchange(events_, {});
}

// A message is told by whom it is for.
void ChoreographyStage::Record(const SessionEvent& event, size_t robot) {
  if (event.did == Did::kBegins) recorder_->Begins(time_, robot, event.what);
  if (event.did == Did::kEnds) recorder_->Ends(time_, robot, event.what);
  if (event.did == Did::kBreaks)
    recorder_->Incident(
        time_, Wrong::kContract,
        fmt::format("`{}: {}` missed its contract by {:.2g}", event.robot, event.what, event.missed));
  if (event.did == Did::kLeaves && (event.outcome == "failed" || event.outcome == "lost"))
    recorder_->Incident(time_, Wrong::kGaveUp,
                        fmt::format("`{}`: {}: {}", event.robot, event.outcome, event.what));
  if (event.did != Did::kTook) return;
  if (const auto from = cast_.graph->Find(event.peer))
    recorder_->Message(time_, from->value, static_cast<uint32_t>(robot), event.what, event.values);
}

// The world follows the clock. What it cannot catch up within a tenth of a second is time that does not pass in it.
void ChoreographyStage::Run() {
  using Clock = std::chrono::steady_clock;
  constexpr double kStep = 0.005;  // seconds
  constexpr uint64_t kTell = 2;    // steps from one message of a driver to the next
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kStep));
  const std::vector<bool> none(scene_.variables().size());
  const std::vector<sim::motions::MotionRun*> unknown(cast_.graph->robots.size(), nullptr);
  const sim::motions::Tell tell = [this](Wrong wrong, const std::string& what) {
    if (recorder_ != nullptr) recorder_->Incident(time_, wrong, what);
    report_.incidents.push_back({wrong, what, time_, 1});
  };
  auto due = Clock::now();
  for (uint64_t step = 1; !stop_.StopRequested(); ++step) {
    due += period;
    const auto now = Clock::now();
    if (now < due) std::this_thread::sleep_until(due);
    const double behind = std::chrono::duration<double>(now - due).count();
    behind_ = std::max(behind_, behind);
    if (behind > 0.1) due = now;
    drivers_.Step(kStep);
    time_ = static_cast<double>(step) * kStep;
    if (step % kTell != 0) continue;
    disturbances_->To(time_, none);
    drivers_.Tell();
    contacts_->Look(scene_, unknown, tell);
    std::vector<std::pair<size_t, SessionEvent>> heard;
    {
      const std::lock_guard lock(mutex_);
      heard.swap(heard_);
    }
    if (recorder_ == nullptr) continue;
    for (const auto& [robot, event] : heard) Record(event, robot);
    recorder_->Scene(time_, scene_);
  }
}

const sim::motions::ChoreographyReport& ChoreographyStage::End() {
  stop_.RequestStop();
  if (!thread_.joinable()) return report_;
  thread_.join();
  subscriptions_.clear();
  report_.time = time_;
  // What came while it ended.
  for (const auto& [robot, event] : heard_) {
    if (recorder_ != nullptr) Record(event, robot);
  }
  if (recorder_ != nullptr) recorder_->Finish(time_, scene_, report_);
  return report_;
}

}  // namespace rondo::deploy
