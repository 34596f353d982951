#include "sim/motions/motion_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace rondo::sim::motions {

using runtime::sessions::Progress;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSmooth = 0.01;  // seconds from one state of a motion to the next
constexpr int kStates = 20;       // of a short motion, at least
constexpr double kFlow = 2e-3;    // seconds of one step of an integrator
constexpr double kFast = 1.5;     // of what swings: metres or radians per second
constexpr double kSlack = 0.02;   // metres or radians that nobody calls a jump
constexpr double kMoment = 1e-9;  // seconds by which times may differ for rounding

// Anywhere between two numbers, often one of them.
double Somewhere(std::mt19937_64& random, double low, double high) {
  const uint64_t how = random() % 4;
  return how == 0 ? low : how == 1 ? high : Between(random, low, high);
}

}  // namespace

MotionRun::MotionRun(MotionCode& code, SceneState& scene, std::mt19937_64& random, Manner manner)
    : code_(code), scene_(scene), random_(random), manner_(manner) {
  start_ = Free();
  goal_ = start_;
  ChooseTimes();
  resolution_ = code_.free.empty() && !code_.drive ? kInfinity : kSmooth;
  if (code_.drive) {
    happened_.resize(code_.drive->events.size());
    Act();
    return;
  }
  if (code_.free.empty()) return;
  if (!code_.interruptible) {
    ChooseGoal();
    if (manner_ == Manner::kPlain) ChoosePace();
    resolution_ = std::clamp(over_ / kStates, 1e-4, kSmooth);
  }
  ChooseWay();
}

std::vector<double> MotionRun::Free() const {
  std::vector<double> values;
  for (const size_t f : code_.free) values.push_back(scene_.values()[f]);
  return values;
}

void MotionRun::SetFree(std::span<const double> values) {
  for (size_t i = 0; i < values.size(); ++i) scene_.values()[code_.free[i]] = values[i];
}

double MotionRun::Longest() const {
  constexpr double kLonger = 10;  // seconds than it has to be, where nothing bounds it
  return std::min(code_.most, code_.least + kLonger);
}

void MotionRun::ChooseTimes() {
  if (!code_.interruptible) {
    over_ = manner_ == Manner::kPlain ? Longest() : Somewhere(random_, code_.least, Longest());
    // What takes no time has to be over where it begins.
    constexpr double kLeast = 0.01;
    scene_.SetClock(over_);
    if (over_ < kLeast && !code_.end.Holds(scene_.values()))
      over_ = std::min(Longest(), std::max(over_, kLeast));
    return;
  }
  over_ = code_.most;
  ready_ =
      manner_ == Manner::kPlain
          ? code_.least
          : std::min(over_, code_.least - std::log1p(-Between(random_, 0, 1)));  // a second more, on average
}

// A state in which the motion may end.
void MotionRun::ChooseGoal() {
  constexpr int kTries = 20;
  std::vector<double>& values = scene_.values();
  for (int i = 0; i < kTries; ++i) {
    // Some contracts can be kept only if the motion takes a certain time: its least or its longest, most likely.
    if (i > 0) over_ = i == 1 ? Longest() : i == 2 ? code_.least : Somewhere(random_, code_.least, Longest());
    std::vector<double> guess = start_;
    if (i > 0 || (manner_ == Manner::kAny && random_() % 2 == 0)) {
      for (size_t k = 0; k < guess.size(); ++k) {
        const bool bounded = std::isfinite(code_.low[k]) && std::isfinite(code_.high[k]);
        guess[k] = bounded && random_() % 2 == 0 ? Between(random_, code_.low[k], code_.high[k])
                                                 : guess[k] + Between(random_, -1, 1);
      }
    }
    SetFree(guess);
    scene_.SetClock(over_);
    const bool found = code_.end.Approach(values, code_.free);
    if (found) goal_ = Free();
    SetFree(start_);
    if (found) return;
  }
  lost_ = fmt::format("no state was found in which `{}` may end", code_.text);
}

// As long as it takes at an easy speed.
void MotionRun::ChoosePace() {
  constexpr double kEasy = 0.4;  // metres or radians per second, in the middle of the way
  constexpr double kPeak = 2;    // times the speed on average
  double farthest = 0;
  for (size_t k = 0; k < start_.size(); ++k) farthest = std::max(farthest, std::abs(goal_[k] - start_[k]));
  const double longest = over_;
  over_ = std::clamp(kPeak * farthest / kEasy, code_.least, longest);
  // Where it ends may depend on how long it takes.
  SetFree(goal_);
  scene_.SetClock(over_);
  if (code_.end.Approach(scene_.values(), code_.free))
    goal_ = Free();
  else
    over_ = longest;
  SetFree(start_);
}

// A third of the motions go straight, as far as their contract lets them; others swing, a little or through their ranges.
void MotionRun::ChooseWay() {
  if (manner_ == Manner::kPlain) {
    pace_ = -1;  // at rest in the beginning and in the end
    swing_.resize(start_.size());
    turns_.resize(start_.size());
    return;
  }
  pace_ = Between(random_, -0.8, 0.8);
  const uint64_t how = random_() % 3;
  const double span = std::isfinite(over_) && !code_.interruptible ? over_ : Between(random_, 2, 8);
  for (size_t k = 0; k < start_.size(); ++k) {
    const double range = std::min(code_.high[k] - code_.low[k], 20.0);
    const double turn = 2 * std::numbers::pi * static_cast<double>(1 + random_() % 2) / span;
    const double most = how == 0   ? 0
                        : how == 1 ? 0.3 * std::min(range, 1.0)
                                   : std::min(0.5 * range, kFast / turn);
    swing_.push_back(Between(random_, -most, most));
    turns_.push_back(turn);
  }
}

void MotionRun::To(double seconds) {
  const double until = std::min(seconds, over_), dt = until - time_;
  if (dt <= 0 || !lost_.empty()) {
    time_ = std::max(time_, until);
    return;
  }
  if (code_.drive) {
    Drive(until);
  } else if (!code_.free.empty()) {
    constexpr int kHalvings = 8;
    Follow(dt, kHalvings);
  }
  time_ = until;
}

// Where it would be at a time, whatever it promises.
std::vector<double> MotionRun::GuessAt(double time) const {
  const bool ends = !code_.interruptible;
  const double share = ends ? std::min(time / over_, 1.0) : 0;
  const double gone = share + pace_ * std::sin(2 * std::numbers::pi * share) / (2 * std::numbers::pi);
  const double window = ends ? std::sin(std::numbers::pi * share) : 1;
  std::vector<double> guess = start_;
  for (size_t k = 0; k < guess.size(); ++k)
    guess[k] += gone * (goal_[k] - start_[k]) + swing_[k] * window * std::sin(turns_[k] * time);
  return guess;
}

// Moves the robot to the nearest state that is wanted. Returns how far that is from where it was; infinite if none was found.
double MotionRun::Step(Condition& wanted, const std::vector<double>& guess,
                       const std::vector<double>& before) {
  for (const auto& begin : {guess, before}) {
    SetFree(begin);
    if (!wanted.Approach(scene_.values(), code_.free)) continue;
    std::vector<double> after = Free();
    double step = 0;
    for (size_t k = 0; k < after.size(); ++k) {
      after[k] = std::clamp(after[k], code_.low[k], code_.high[k]);
      step = std::max(step, std::abs(after[k] - before[k]));
    }
    SetFree(after);
    return step;
  }
  return kInfinity;
}

// Moves the robot on by this time. What looks like a jump is looked at in halves: if it is one, it stays as large. Then it is
// drawn towards where it would be, as far as it can come without.
bool MotionRun::Follow(double dt, int halvings) {
  const std::vector<double> before = Free();
  const double time = time_ + dt;
  const bool last = !code_.interruptible && time >= over_ - kMoment;
  scene_.SetClock(last ? over_ : time);
  Condition& wanted = last ? code_.end : code_.during;
  std::vector<double> guess = last ? goal_ : GuessAt(time);
  double step = Step(wanted, guess, before);
  if (step > kSlack && std::isfinite(step) && halvings > 0) {
    SetFree(before);
    return Follow(dt / 2, halvings - 1) && Follow(dt / 2, halvings - 1);
  }
  if (step > kSlack && !last) {
    for (size_t k = 0; k < guess.size(); ++k)
      guess[k] = before[k] + std::clamp(guess[k] - before[k], -kSlack / 2, kSlack / 2);
    step = std::min(step, Step(wanted, guess, before));
  }
  if (step <= kSlack) {
    time_ = time;
    return true;
  }
  SetFree(before);
  lost_ = std::isfinite(step)
              ? fmt::format("no continuous curve was found that keeps `{}`", code_.text)
              : fmt::format("no state was found that keeps `{}` after {:.3g} s", code_.text, time);
  return false;
}

// -- controllers

void MotionRun::Drive(double until) {
  const double period = code_.drive->period;
  while (time_ < until) {
    const double acts = period > 0 ? samples_ * period : kInfinity;
    if (acts <= time_ + kMoment) {
      Act();
      continue;
    }
    const double dt = std::min({kFlow, until - time_, acts - time_});
    Flow(dt);
    time_ += dt;
    Happen();
  }
  scene_.SetClock(time_);
  Condition& wanted = !code_.interruptible && time_ >= over_ ? code_.end : code_.during;
  const double miss = wanted.Miss(scene_.values());
  if (miss <= Condition::kTolerance || !broken_.empty()) return;
  broken_ = fmt::format("`{}` does not keep its contract", code_.text);
}

void MotionRun::Act() {
  scene_.SetClock(time_);
  ++samples_;
  if (!code_.drive->laws) return;
  const auto values = code_.drive->laws->values(scene_.values());
  for (size_t i = 0; i < values.size(); ++i) scene_.values()[code_.drive->laws->set[i]] = values[i];
}

// Runge and Kutta's step of the fourth order.
void MotionRun::Flow(double dt) {
  const std::vector<size_t>& states = code_.drive->rates.set;
  std::vector<double>& values = scene_.values();
  std::vector<double> start, sum(states.size(), 0.0), slope(states.size(), 0.0);
  for (const size_t s : states) start.push_back(values[s]);
  constexpr std::array<double, 4> kAt{0, 0.5, 0.5, 1}, kWeight{1, 2, 2, 1};
  for (size_t stage = 0; stage < kAt.size(); ++stage) {
    for (size_t i = 0; i < states.size(); ++i) values[states[i]] = start[i] + kAt[stage] * dt * slope[i];
    scene_.SetClock(time_ + kAt[stage] * dt);
    const auto rates = code_.drive->rates.values(values);
    for (size_t i = 0; i < states.size(); ++i) {
      slope[i] = rates[i];
      sum[i] += kWeight[stage] * rates[i];
    }
  }
  for (size_t i = 0; i < states.size(); ++i) values[states[i]] = start[i] + dt * sum[i] / 6;
}

void MotionRun::Happen() {
  scene_.SetClock(time_);
  for (size_t e = 0; e < code_.drive->events.size(); ++e) {
    DriveCode::Event& event = code_.drive->events[e];
    const bool holds = event.condition.Miss(scene_.values()) <= 0;
    if (holds && !happened_[e]) {
      const auto values = event.update.values(scene_.values());
      for (size_t i = 0; i < values.size(); ++i) scene_.values()[event.update.set[i]] = values[i];
    }
    happened_[e] = holds;
  }
}

// -- time

Progress MotionRun::progress() const {
  if (!lost_.empty()) return Progress::kFailed;
  if (time_ >= over_ - kMoment) return Progress::kStopped;
  if (!code_.interruptible || time_ < code_.least - kMoment) return Progress::kBound;
  return time_ >= ready_ - kMoment ? Progress::kReady : Progress::kOpen;
}

double MotionRun::next() const {
  for (const double t :
       {code_.interruptible ? code_.least : over_, code_.interruptible ? ready_ : over_, over_}) {
    if (t > time_ + kMoment) return t;
  }
  return kInfinity;
}

}  // namespace rondo::sim::motions
