#include "deploy/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "platform/ports.h"
#include "sim/scanner.h"

namespace rondo::deploy {

namespace {

constexpr double kTold = 0.02;  // seconds from one message of a driver to the next

uint64_t Every(double period, double step) {
  return std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(period / step)));
}

}  // namespace

Stage::Stage(const koord::Model& model, const sim::Fleet& fleet, uint64_t seed, double speed,
             trace::Writer* trace)
    : model_(model), fleet_(fleet), seed_(seed), speed_(speed), recorder_(trace, fleet) {}

base::Result<bool> Stage::Begin(dds::Participant& participant, const nlohmann::json& run,
                                diag::Diagnostics& diagnostics) {
  const size_t before = diagnostics.errors();
  ports_ = platform::PortsOf(model_, fleet_, diagnostics);
  if (diagnostics.errors() != before) return base::Error{};
  for (size_t r = 0; r < fleet_.robots.size(); ++r) {
    const sim::FleetRobot& robot = fleet_.robots[r];
    bodies_.push_back(robot.make());
    bodies_.back()->Seed(seed_ * 0x9e3779b97f4a7c15U + 0x51ed2701U * (r + 1));
    bodies_.back()->Place(robot.position, robot.yaw);
    noise_.emplace_back(seed_ * 0x9e3779b97f4a7c15U + r + 1);
  }
  scans_ = std::ranges::any_of(ports_, [](const sim::Port& p) { return p.role == sim::PortRole::kScans; });
  touches_ = std::make_unique<sim::Touches>(
      fleet_, bodies_, [this](double t, const std::string& robot, const std::string& with) {
        recorder_.Event(t, {{"event", "collision"}, {"robot", robot}, {"with", with}});
      });
  drivers_ = std::make_unique<platform::Drivers>(model_, fleet_, ports_, bodies_, fleet_.ros.use_sim_time);
  if (auto begun = drivers_->Begin(participant); !begun.ok()) return begun;
  nlohmann::json record = run;
  for (size_t r = 0; r < bodies_.size(); ++r)
    record["robots"].push_back({{"name", fleet_.robots[r].name},
                                {"model", fleet_.robots[r].model},
                                {"radius", bodies_[r]->radius()}});
  recorder_.Run(record);
  recorder_.World(fleet_);
  thread_ = std::thread([this] { Run(); });
  return true;
}

// The world follows the clock in steps of the controllers. What it cannot catch up within a tenth of a second is time that
// does not pass in it.
void Stage::Run() {
  using Clock = std::chrono::steady_clock;
  const double dt = fleet_.step;
  const uint64_t tell = Every(kTold, dt), pose = Every(1 / fleet_.pose_rate, dt),
                 scan = Every(1 / fleet_.lidar.rate, dt);
  auto due = Clock::now();
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(dt / speed_));
  std::vector<sim::Rays> rays;
  touches_->Observe(0);
  drivers_->TellTime(0);
  for (uint64_t step = 1; !stop_.StopRequested(); ++step) {
    due += period;
    const auto now = Clock::now();
    if (now < due) std::this_thread::sleep_until(due);
    const double behind = std::chrono::duration<double>(now - due).count();
    report_.behind = std::max(report_.behind, behind);
    if (behind > 0.1) due = now;
    drivers_->Obey();
    if (const auto bad = drivers_->Step(dt)) {
      report_.failed = fmt::format("the state of `{}` is not finite any more", fleet_.robots[*bad].name);
      return;
    }
    const double t = time_ = report_.time = static_cast<double>(step) * dt;
    drivers_->TellTime(t);
    touches_->Observe(t);
    rays.clear();
    if (scans_ && step % scan == 0) {
      for (size_t r = 0; r < bodies_.size(); ++r) {
        rays.push_back(sim::Scan(fleet_, bodies_, r, noise_[r]));
        recorder_.Scan(t, r, rays[r], bodies_[r]->yaw(), 1 / fleet_.lidar.rate);
      }
    }
    if (step % tell == 0 || !rays.empty()) drivers_->Tell(rays);
    if (step % pose == 0) {
      for (size_t r = 0; r < bodies_.size(); ++r) recorder_.Pose(t, r, *bodies_[r]);
    }
  }
}

StageReport Stage::End() {
  stop_.RequestStop();
  if (!thread_.joinable()) return report_;
  thread_.join();
  report_.collisions = touches_->collisions();
  report_.first_collision = touches_->first();
  report_.first_pair = touches_->first_pair();
  report_.least_between_robots = touches_->least_between_robots();
  report_.least_to_obstacles = touches_->least_to_obstacles();
  return report_;
}

}  // namespace rondo::deploy
