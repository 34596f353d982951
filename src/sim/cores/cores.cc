#include "sim/cores/cores.h"

#include <algorithm>
#include <utility>

#include "base/mixed.h"

namespace rondo::sim::cores {

namespace rounds = runtime::rounds;
using runtime::codec::Bytes;
using runtime::codec::View;
using transport::simulated::Conditions;

bool Cores::MemoryDisk::Keep(View bytes) {
  if (full) return false;
  record = Bytes(bytes.begin(), bytes.end());
  fresh = true;
  return true;
}

Cores::Cores(const Setup& setup, Robots& robots)
    : robots_(robots),
      settings_(setup.settings),
      disks_(setup.disks),
      usual_(setup.conditions),
      faults_(setup.faults),
      network_(setup.settings.robots, setup.seed),
      lives_(setup.settings.robots) {
  network_.conditions = usual_;
  for (size_t r = 0; r < lives_.size(); ++r) {
    const uint64_t x = base::Mixed(setup.seed ^ (r + 1));
    lives_[r].clock = {static_cast<int64_t>(x % 1'000'000'000'000),
                       static_cast<int32_t>((x >> 40) % 200) - 100};
  }
}

void Cores::Start() {
  for (uint32_t r = 0; r < robots(); ++r) Begin(r);
  for (size_t i = 0; i < faults_.size(); ++i) {
    Time end = faults_[i].at + faults_[i].length;
    Push(faults_[i].at, What::kFaultBegins, static_cast<uint32_t>(i));
    Push(end, What::kFaultEnds, static_cast<uint32_t>(i));
    if (faults_[i].kind == FaultKind::kSlow) end += Nanoseconds(faults_[i].amount);  // its last step
    quiet_ = std::max(quiet_, end);
  }
}

bool Cores::Next(Time until) {
  if (events_.empty() || events_.top().at > until) {
    if (until != kNever) now_ = std::max(now_, until);
    return false;
  }
  const Event event = events_.top();
  events_.pop();
  now_ = event.at;
  Handle(event);
  return true;
}

void Cores::Push(Time at, What what, uint32_t number, uint64_t serial, std::shared_ptr<Bytes> bytes) {
  events_.push({at, order_++, what, number, serial, std::move(bytes)});
}

void Cores::Begin(uint32_t r) {
  Life& life = lives_[r];
  settings_.self = r;
  settings_.incarnation = ++life.incarnation;
  std::optional<View> record;
  if (disks_ && life.disk.record) record = *life.disk.record;
  life.core =
      std::make_unique<rounds::Core>(settings_, robots_.Begin(r), disks_ ? &life.disk : nullptr, record);
  Step(r, {});
}

void Cores::Crash(uint32_t r) {
  Life& life = lives_[r];
  if (life.crashes++ > 0) return;
  life.core.reset();
  ++life.wake;
  robots_.Crashed(r);
}

bool Cores::Known() const {
  return std::ranges::any_of(lives_, [](const Life& life) {
    return (life.core != nullptr && life.core->place().epoch > 0) || life.kept > 0;
  });
}

void Cores::Handle(const Event& event) {
  if (event.what == What::kFaultBegins) return Let(faults_[event.number], true);
  if (event.what == What::kFaultEnds) return Let(faults_[event.number], false);
  Life& life = lives_[event.number];
  if (life.core == nullptr) return;
  if (now_ < life.paused_until)
    return Push(life.paused_until, event.what, event.number, event.serial, event.bytes);
  if (event.what == What::kWakes && event.serial != life.wake) return;
  Step(event.number, event.bytes == nullptr ? View() : View(*event.bytes));
}

void Cores::Step(uint32_t r, View datagram) {
  Life& life = lives_[r];
  outputs_.Clear();
  life.core->Step(life.clock.At(now_), datagram, outputs_);
  if (std::exchange(life.disk.fresh, false)) life.kept = life.core->place().epoch;
  known_ = known_ || life.core->place().epoch > 0;
  for (const rounds::Output& output : outputs_) {
    if (const auto* send = std::get_if<rounds::Send>(&output))
      Deliver(r, *send);
    else
      robots_.On(r, output);
  }
  if (life.step > 0) life.paused_until = std::max(life.paused_until, now_ + life.step);
  visited_.insert(static_cast<uint64_t>(life.phase) * kPhases + static_cast<uint64_t>(life.core->phase()));
  life.phase = life.core->phase();
  if (life.core->wake() == INT64_MAX) return;
  Push(std::max(now_ + 1, life.clock.When(life.core->wake())), What::kWakes, r, ++life.wake);
}

void Cores::Deliver(uint32_t from, const rounds::Send& send) {
  for (uint32_t to = 0; to < robots(); ++to) {
    if (to == from || (send.to != rounds::kAll && send.to != to)) continue;
    deliveries_.clear();
    network_.Send(now_, from, to, send.bytes, deliveries_);
    for (auto& d : deliveries_)
      Push(d.at, What::kArrives, to, 0, std::make_shared<Bytes>(std::move(d.bytes)));
  }
  digest_ = base::Mixed(digest_ ^ runtime::codec::Sum(send.bytes));
}

// Cuts the way from one robot to another, or mends it.
void Cores::Way(uint32_t from, uint32_t to, bool cut) {
  cut ? network_.Cut(from, to) : network_.Mend(from, to);
}

void Cores::Let(const Fault& f, bool begins) {
  Conditions& c = network_.conditions;
  Life& life = lives_[f.robot];
  switch (f.kind) {
    case FaultKind::kLoss:
      c.loss = begins ? f.amount : usual_.loss;
      break;
    case FaultKind::kDelay:
      c.most = begins ? static_cast<Time>(f.amount * 1e9) : usual_.most;
      c.least = begins ? std::min(c.least, c.most) : usual_.least;
      break;
    case FaultKind::kDuplicate:
      c.duplicate = begins ? f.amount : usual_.duplicate;
      break;
    case FaultKind::kCorrupt:
      c.corrupt = begins ? f.amount : usual_.corrupt;
      break;
    case FaultKind::kOneWay:
      Way(f.robot, f.other, begins);
      break;
    case FaultKind::kCut:
      Way(f.robot, f.other, begins);
      Way(f.other, f.robot, begins);
      break;
    case FaultKind::kAlone:
      for (uint32_t r = 0; r < robots(); ++r) {
        Way(f.robot, r, begins);
        Way(r, f.robot, begins);
      }
      break;
    case FaultKind::kCrash:
    case FaultKind::kForget:
      if (!begins) {
        if (--life.crashes == 0) Begin(f.robot);
        break;
      }
      if (f.kind == FaultKind::kForget) {
        life.disk.record.reset();
        life.kept = 0;
      }
      Crash(f.robot);
      forgotten_ = forgotten_ || (known_ && !Known());
      break;
    case FaultKind::kPause:
      if (begins) life.paused_until = std::max(life.paused_until, f.at + f.length);
      break;
    case FaultKind::kDiskFull:
      life.disk.full = begins;
      break;
    case FaultKind::kSlow:
      life.step = begins ? Nanoseconds(f.amount) : 0;
      break;
    case FaultKind::kPlanner:
      robots_.Slows(f.robot, begins ? Nanoseconds(f.amount) : 0);
      break;
    case FaultKind::kClock:
      life.ahead += (begins ? 1 : -1) * Nanoseconds(f.amount);
      break;
  }
}

}  // namespace rondo::sim::cores
