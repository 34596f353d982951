#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "sim/run.h"
#include "sim/scanner.h"

namespace rondo::sim {

using diag::Kind;
using koord::semantics::FromFloat;

uint32_t Run::At(const Port& port, size_t robot) const {
  return team_->layout().Address(port.variable, robot);
}

void Run::Sense() {
  for (size_t r = 0; r < bodies_.size(); ++r) {
    for (const Port& port : ports_) {
      Word* at = state_.data() + At(port, r);
      if (port.role == PortRole::kScans)
        *at = team_->heap().Intern(scans_[r]);
      else
        Sense(port, r, team_->heap(), at);
    }
  }
}

// What a sensor of a robot reads now; of scans, those since it was asked last.
void Run::Sense(const Port& port, size_t r, Heap& heap, Word* at) const {
  if (port.role != PortRole::kScans) return ReadSensor(port, r, *bodies_[r], at);
  std::vector<Word> words;
  for (const Seen& seen : seen_[r]) {
    for (const double x : seen.from) words.push_back(FromFloat(x + 0.0));
    words.push_back(EncodeRays(heap, seen.rays));
  }
  *at = heap.Intern(words);
}

// How many controller periods from one instant of this kind to the next?
uint64_t Run::Every(double period, double step) {
  return std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(period / step)));
}

void Run::FindPeriods() {
  Periods& p = periods_;
  p.dt = fleet_.delta / static_cast<double>(Every(fleet_.delta, fleet_.step));
  p.monitor = Every(fleet_.monitor, p.dt);
  p.pose = Every(1 / fleet_.pose_rate, p.dt);
  p.scan = Every(1 / fleet_.lidar.rate, p.dt);
  // Small teams are looked at after every step: fast robots are through each other soon.
  p.touch = bodies_.size() <= 100 ? 1 : p.monitor;
  p.scans =
      std::any_of(ports_.begin(), ports_.end(), [](const Port& q) { return q.role == PortRole::kScans; });
  report_.observed_every = static_cast<double>(p.touch) * p.dt;
}

// Is something looked at after this step?
bool Run::Due(uint64_t step) const {
  const Periods& p = periods_;
  return step % p.monitor == 0 || step % p.pose == 0 || step % p.touch == 0 ||
         (p.scans && step % p.scan == 0);
}

// Lets `n` steps pass, from t until `now`; nothing is due between them. `last`: everything is looked at
// behind them.
bool Run::Pass(uint64_t n, double t, double now, bool last) {
  const Periods& p = periods_;
  if (!Move(n, p.dt, t)) return false;
  step_ += n;
  report_.time = now;
  if (step_ % p.pose == 0) {
    for (size_t r = 0; r < bodies_.size(); ++r) recorder_.Pose(now, r, *bodies_[r]);
  }
  if (p.scans && step_ % p.scan == 0) Scan(now);
  if (step_ % p.touch == 0 || last) touches_->Observe(now);
  if ((step_ % p.monitor == 0 || last) && settled_at_ >= 0) {
    Sense();
    monitor_->During(now, state_, settled_, last && networked_ == nullptr);
    WatchModels(now);
  }
  return true;
}

// What models exclude is an assumption of every proof that rests on them.
void Run::WatchModels(double now) {
  for (size_t r = 0; r < bodies_.size(); ++r) {
    for (const std::string& what : bodies_[r]->TakeBroken())
      monitor_->Model(now, fmt::format("{} of `{}`", what, fleet_.robots[r].model), r, fleet_.robots[r].span);
  }
}

void Run::Environment(double t) {
  const uint64_t steps = Every(fleet_.delta, fleet_.step);
  settled_ = state_;
  settled_at_ = t;
  for (auto& s : scans_) s.clear();
  for (uint64_t i = 0; i < steps;) {
    // Up to the next instant at which something is looked at.
    uint64_t n = 1;
    while (i + n < steps && !Due(step_ + n)) ++n;
    const auto at = [&](uint64_t k) { return t + static_cast<double>(k) * periods_.dt; };
    if (!Pass(n, at(i), at(i + n), i + n == steps)) return;
    i += n;
  }
  report_.time = t + fleet_.delta;
}

// All bodies, on their own: the result does not depend on the number of threads.
bool Run::Move(uint64_t n, double dt, double t) {
  const size_t chunks = bodies_.size() < 64 ? 1 : 8;
  std::vector<int> bad(chunks, -1);
  const auto work = [&](size_t chunk) {
    for (size_t r = chunk; r < bodies_.size(); r += chunks) {
      for (uint64_t k = 0; k < n; ++k) {
        if (!bodies_[r]->Step(dt, fleet_.integrator) && bad[chunk] < 0) bad[chunk] = static_cast<int>(r);
        if (bad[chunk] >= 0) return;
      }
    }
  };
  if (chunks == 1)
    work(0);
  else
    base::ParallelFor(chunks, options_.jobs, work);
  int robot = -1;
  for (const int b : bad) {
    if (b >= 0 && (robot < 0 || b < robot)) robot = b;
  }
  if (robot < 0) return true;
  const FleetRobot& who = fleet_.robots[static_cast<size_t>(robot)];
  diagnostics_
      .Report(Kind::kFleetValue, who.span,
              fmt::format("the state of `{}` is not finite behind t = {:.6g} s", who.name, t))
      .Under(fmt::format("model `{}` with these parameters", who.model))
      .Help("a smaller `step` in `[run]`, or other parameters, may help");
  report_.ended = Ending::kFailed;
  return false;
}

void Run::Scan(double now) {
  std::vector<Rays> all(bodies_.size());
  const auto work = [&](size_t r) { all[r] = sim::Scan(fleet_, bodies_, r, noise_[r]); };
  if (bodies_.size() < 16) {
    for (size_t r = 0; r < bodies_.size(); ++r) work(r);
  } else {
    base::ParallelFor(bodies_.size(), options_.jobs, work);
  }
  for (size_t r = 0; r < bodies_.size(); ++r) {
    recorder_.Scan(now, r, all[r], bodies_[r]->yaw(), 1 / fleet_.lidar.rate);
    for (const double x : bodies_[r]->position()) scans_[r].push_back(FromFloat(x + 0.0));
    scans_[r].push_back(EncodeRays(team_->heap(), all[r]));
    if (networked_ == nullptr) continue;
    // Of a round; where rounds take longer, or do not come, of the last seconds that one should take.
    std::erase_if(seen_[r], [&](const Seen& seen) { return seen.time <= now - fleet_.delta; });
    seen_[r].push_back({now, bodies_[r]->position(), std::move(all[r])});
    if (settled_at_ < 0) scans_[r].clear();
  }
}

}  // namespace rondo::sim
