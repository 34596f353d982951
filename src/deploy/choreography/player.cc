#include "deploy/choreography/player.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "transport/mailbox.h"

namespace rondo::deploy {

using runtime::sessions::Progress;
using sim::motions::Condition;
using sim::motions::MotionRun;

namespace {

constexpr double kGrace = 3;    // seconds after its end in which a motion may still arrive
constexpr double kLate = 0.05;  // seconds by which a body may be behind

}  // namespace

Player::Player(const choreo::Cast& cast, choreo::RobotId robot, const Precision& precision, uint64_t seed,
               std::vector<size_t> heard, const platform::StateSenses& senses, platform::StateOrders& orders,
               Say say)
    : cast_(cast),
      robot_(robot),
      precision_(precision),
      heard_(std::move(heard)),
      senses_(senses),
      orders_(orders),
      say_(std::move(say)),
      random_(seed * 0x9e3779b97f4a7c15U + robot.value + 1),
      wanted_(*cast.graph->world),
      sensed_(*cast.graph->world),
      known_(wanted_.variables().size()),
      library_(*cast.graph, cast.declarations->evaluator().arena(), wanted_),
      places_(cast) {
  const robot::World& world = *cast.graph->world;
  const auto know = [&](const std::vector<robot::Variable>& list) {
    for (const robot::Variable& v : list) known_[wanted_.Of(v.term)] = true;
  };
  for (const size_t body : heard_) know(world.bodies[body].states);
  const robot::Body& body = world.bodies[robot.index()];
  know(body.unknowns);
  know(world.environment);
  known_[wanted_.Of(world.clock)] = true;
  for (const robot::Variable& v : body.states) own_.push_back(wanted_.Of(v.term));
  sim::motions::Audience& audience = *this;
  performer_ = std::make_unique<sim::motions::Performer>(cast, robot, wanted_, library_, random_,
                                                         sim::motions::Manner::kPlain, audience);
}

void Player::Begin() {
  for (size_t i = 0; i < heard_.size(); ++i) senses_.Read(i, wanted_.values());
  senses_.ReadSignals(wanted_.values());
  sensed_.values() = wanted_.values();
  moments_ = {{0, wanted_.values()}};
}

void Player::Step(int64_t now) {
  now_ = now;
  for (size_t i = 0; i < heard_.size(); ++i) {
    senses_.Read(i, sensed_.values());
    if (i > 0) senses_.Read(i, wanted_.values());
  }
  senses_.ReadSignals(sensed_.values());
  senses_.ReadSignals(wanted_.values());
  seen_ = std::min(now, senses_.Heard(0));
  if (MotionRun* motion = performer_->motion()) {
    const double seen = transport::Seconds(seen_ - began_);
    if (seen >= 0) WatchLate(motion->code().during, std::min(seen, motion->time()));
    motion->To(transport::Seconds(now - began_) + platform::StateOrders::kAhead);
  }
  Remember(now);
  orders_.Follow(now, wanted_.values(), moments_[Present()].wanted, sensed_.values());
}

// Moments stay for as long as a body may lag behind them.
void Player::Remember(int64_t now) {
  constexpr int64_t kLag = 2 * static_cast<int64_t>(kLate * 1e9);
  moments_.push_back({now + static_cast<int64_t>(platform::StateOrders::kAhead * 1e9), wanted_.values()});
  while (moments_.size() > 1 && moments_[1].time <= now - kLag) moments_.pop_front();
}

size_t Player::Present() const {
  size_t i = 0;
  while (i + 1 < moments_.size() && moments_[i + 1].time <= seen_) ++i;
  return i;
}

double Player::Astray() const {
  double least = Away(moments_.front().wanted);
  for (size_t i = 1; i <= Present(); ++i) least = std::min(least, Away(moments_[i].wanted));
  return least;
}

void Player::Stop() { orders_.Stay(sensed_.values()); }

double Player::Away(const std::vector<double>& wanted) const {
  double away = 0;
  for (const size_t place : own_) away = std::max(away, std::abs(wanted[place] - sensed_.values()[place]));
  return away;
}

void Player::Watch(Condition& condition, double clock) {
  if (!watched_) return;
  sensed_.SetClock(clock);
  motion_missed_ = std::max(motion_missed_, condition.Miss(sensed_.values()));
}

void Player::WatchLate(Condition& condition, double clock) {
  constexpr int kMoments = 5;
  if (!watched_) return;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kMoments; ++i) {
    sensed_.SetClock(std::max(0.0, clock - kLate * i / kMoments));
    least = std::min(least, condition.Miss(sensed_.values()));
  }
  motion_missed_ = std::max(motion_missed_, least);
}

void Player::Begins(MotionRun& motion) {
  ++motions_;
  began_ = now_;
  motion_missed_ = 0;
  places_.Moves(robot_);
  motion.LastAtLeast(places_.LeastOf(robot_));
  watched_ = std::ranges::all_of(motion.code().reads, [&](size_t place) { return known_[place]; });
  Watch(motion.code().pre, 0);
  say_(Event(Did::kBegins, motion.code().call));
}

void Player::Ends(const MotionRun& motion) {
  if (motion.progress() == Progress::kStopped) Watch(motion.code().end, motion.time());
  SessionEvent event = Event(Did::kEnds, motion.code().call);
  event.missed = motion_missed_;
  event.late = std::max(0.0, transport::Seconds(now_ - began_) - motion.code().most);
  late_ = std::max(late_, event.late);
  say_(event);
  if (motion_missed_ > missed_) {
    missed_ = motion_missed_;
    missed_by_ = motion.code().call;
  }
  if (motion_missed_ <= precision_.tolerance) return;
  ++broken_;
  event.did = Did::kBreaks;
  say_(event);
}

// A body is late, and has to be where the next motion may begin. One that is far away will not come.
Progress Player::Checked(const MotionRun& motion, Progress progress) {
  const double away = Away(wanted_.values()), astray = Astray();
  // It is led ahead of time; its contract counts from when it began.
  const bool early = transport::Seconds(now_ - began_) < motion.code().least;
  if (progress == Progress::kFailed) {
    trouble_ = motion.lost();
  } else if (astray > precision_.lost()) {
    trouble_ = fmt::format("it is {:.2g} (metres or radians) away from where `{}` has to bring it", astray,
                           motion.code().call);
  } else if (progress == Progress::kStopped && away > precision_.arrival()) {
    if (transport::Seconds(now_ - began_) - motion.time() < kGrace) return Progress::kBound;
    trouble_ = fmt::format("`{}` did not bring it where it ends: {:.2g} (metres or radians) are missing",
                           motion.code().call, away);
  } else {
    return early ? Progress::kBound : progress;
  }
  return Progress::kFailed;
}

void Player::Takes(choreo::RobotId robot, const runtime::sessions::Expected& message,
                   const std::vector<double>& values) {
  ++messages_;
  places_.Says(robot, choreo::Action::Kind::kReceive, choreo::RobotId(message.from), message.label);
  SessionEvent event = Event(Did::kTook, message.label);
  event.peer = cast_.graph->NameOf(choreo::RobotId(message.from));
  event.values = values;
  say_(std::move(event));
}

void Player::Sends(choreo::RobotId robot, const runtime::sessions::Step& message) {
  places_.Says(robot, choreo::Action::Kind::kSend, choreo::RobotId(message.to), message.label);
  SessionEvent event = Event(Did::kSent, message.label);
  event.peer = cast_.graph->NameOf(choreo::RobotId(message.to));
  event.values = message.values;
  say_(std::move(event));
}

SessionEvent Player::Event(Did did, std::string what) const {
  SessionEvent event;
  event.did = did;
  event.time = now_;
  event.robot = cast_.graph->NameOf(robot_);
  event.what = std::move(what);
  return event;
}

}  // namespace rondo::deploy
