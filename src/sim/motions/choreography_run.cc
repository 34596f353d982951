#include "sim/motions/choreography_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "sim/motions/beginning.h"
#include "sim/motions/contacts.h"
#include "sim/motions/disturbances.h"
#include "sim/motions/performer.h"
#include "sim/motions/promises.h"

namespace rondo::sim::motions {
namespace {

using runtime::sessions::Expected;
using runtime::sessions::Frame;
using runtime::sessions::Session;
using runtime::sessions::Step;
using runtime::sessions::Time;

constexpr double kLook = 0.01;  // seconds from one look at the world to the next
constexpr uint64_t kSession = 1;
constexpr Time kResend = 20'000'000;  // nanoseconds; nothing gets lost
constexpr int kMostAtOnce = 10'000;   // things that happen at one instant

class ChoreographyRun final : public Audience {
 public:
  ChoreographyRun(const choreo::Cast& cast, const ChoreographyOptions& options, StageRecorder* recorder)
      : cast_(cast),
        graph_(*cast.graph),
        world_(*graph_.world),
        arena_(cast.declarations->evaluator().arena()),
        options_(options),
        recorder_(recorder),
        random_(options.seed),
        scene_(world_),
        library_(graph_, arena_, scene_),
        places_(cast),
        promises_(cast, scene_, random_) {}

  ChoreographyReport Go() {
    if (!Place(graph_, arena_, scene_, random_)) {
      report_.ended = Curtain::kLost;
      report_.lost = "no state was found in which the choreography may begin";
      if (recorder_ != nullptr) recorder_->Finish(0, scene_, report_);
      return report_;
    }
    order_ = CarriersFirst(world_);
    stood_since_.resize(order_.size());
    disturbances_.emplace(world_, arena_, scene_, random_);
    contacts_.emplace(world_, arena_, scene_, report_);
    for (size_t r = 0; r < graph_.robots.size(); ++r) {
      performers_.push_back(std::make_unique<Performer>(cast_, choreo::RobotId(r), scene_, library_, random_,
                                                        Manner::kAny, *this));
      sessions_.emplace_back(kSession, static_cast<uint32_t>(r), kResend, *performers_.back(),
                             *performers_.back());
    }
    if (recorder_ != nullptr) recorder_->Scene(0, scene_);
    while (!Over()) Advance();
    report_.time = time_;
    if (recorder_ != nullptr) recorder_->Finish(time_, scene_, report_);
    return report_;
  }

 private:
  // -- the beginning

  // -- what happens

  void Happens(Wrong wrong, const std::string& what) {
    if (recorder_ != nullptr) recorder_->Incident(time_, wrong, what);
    for (Incident& known : report_.incidents) {
      if (known.wrong != wrong || known.what != what) continue;
      ++known.count;
      return;
    }
    report_.incidents.push_back({wrong, what, time_, 1});
  }

  void Begins(MotionRun& motion) override {
    ++report_.motions;
    scene_.SetClock(0);
    const double miss = motion.code().pre.Miss(scene_.values());
    if (miss > Condition::kTolerance)
      Happens(Wrong::kPrecondition,
              fmt::format("the precondition of `{}` does not hold where it begins", motion.code().text));
    const choreo::RobotId robot(motion.code().robot);
    places_.Moves(robot);
    motion.LastAtLeast(places_.LeastOf(robot));
    if (recorder_ != nullptr) recorder_->Begins(time_, robot.index(), motion.code().call);
  }

  void Ends(const MotionRun& motion) override {
    if (!motion.broken().empty()) Happens(Wrong::kContract, motion.broken());
    if (recorder_ != nullptr) recorder_->Ends(time_, motion.code().robot, motion.code().call);
  }

  void Takes(choreo::RobotId robot, const Expected& message, const std::vector<double>& values) override {
    ++report_.messages;
    if (recorder_ != nullptr) recorder_->Message(time_, message.from, robot.value, message.label, values);
    const choreo::RobotId from(message.from);
    const auto sent = places_.Says(from, choreo::Action::Kind::kSend, robot, message.label);
    const auto taken = places_.Says(robot, choreo::Action::Kind::kReceive, from, message.label);
    if (sent.empty() || taken.empty())
      Happens(Wrong::kOrder,
              fmt::format("`{}` from `{}` to `{}` is not what the choreography says comes next",
                          message.label, graph_.NameOf(from), graph_.NameOf(robot)));
    promises_.Look(scene_, sent, values, tell_);
  }

  // Lets everything happen that can happen at this instant. False if that has no end.
  bool Settle() {
    for (int i = 0; i < kMostAtOnce; ++i) {
      bool went = false;
      for (Session& session : sessions_) went = session.Advance(now_) || went;
      for (Session& session : sessions_) {
        for (const Frame& frame : session.TakeFrames()) {
          went = true;
          sessions_[frame.to].Hear(frame);
        }
      }
      if (!went) return true;
    }
    return false;
  }

  // -- time

  void Advance() {
    double until = std::min(time_ + kLook, std::max(options_.duration, time_));
    for (const auto& performer : performers_) {
      const MotionRun* motion = performer->motion();
      if (motion == nullptr) continue;
      until = std::min({until, time_ + motion->resolution(), time_ + (motion->next() - motion->time())});
    }
    const Time next = std::max<Time>(now_ + 1, std::llround(until * 1e9));
    const double dt = static_cast<double>(next - now_) * 1e-9;
    now_ = next;
    time_ = static_cast<double>(now_) * 1e-9;
    Disturb();
    for (const size_t r : order_) {
      if (MotionRun* motion = performers_[r]->motion()) motion->To(motion->time() + dt);
    }
  }

  void Disturb() {
    std::vector<bool> set(scene_.variables().size());
    for (const auto& performer : performers_) {
      MotionRun* motion = performer->motion();
      if (motion == nullptr || !motion->code().drive || !motion->code().drive->laws) continue;
      for (const size_t place : motion->code().drive->laws->set) set[place] = true;
    }
    disturbances_->To(time_, set);
    for (const auto& performer : performers_) {
      MotionRun* motion = performer->motion();
      if (motion == nullptr) continue;
      scene_.SetClock(motion->time());
      if (!motion->code().assume.Holds(scene_.values()))
        motion->code().assume.Approach(scene_.values(), disturbances_->all());
    }
  }

  // -- what is seen

  void Look() {
    std::vector<MotionRun*> motions;
    for (const auto& performer : performers_) {
      motions.push_back(performer->motion());
      MotionRun* motion = motions.back();
      if (motion == nullptr) continue;
      scene_.SetClock(motion->time());
      if (!motion->code().assume.Holds(scene_.values()))
        Happens(Wrong::kAssumption,
                fmt::format("what `{}` assumes of others does not hold", motion->code().text));
      if (!motion->broken().empty()) Happens(Wrong::kContract, motion->broken());
      if (!motion->lost().empty() && report_.lost.empty()) report_.lost = motion->lost();
    }
    contacts_->Look(scene_, motions, tell_);
    for (const MotionRun* motion : motions) {
      if (motion != nullptr) promises_.Look(scene_, *motion, places_, tell_);
    }
  }

  static bool Stands(const Session& session) { return !session.ended() && !session.moving(); }
  bool SomebodyStands() const { return std::ranges::any_of(sessions_, Stands); }

  // A joint motion is over when one of its motions is: then the others do not last either. False if what follows has no end.
  bool Urge() {
    for (const auto& performer : performers_) {
      if (MotionRun* motion = performer->motion()) motion->Urge();
    }
    return Settle();
  }

  bool End(Curtain curtain) {
    report_.ended = curtain;
    return true;
  }

  // Does what is to be done at this instant, and tells whether the run is over.
  bool Over() {
    if (!Settle() || (SomebodyStands() && !Urge())) {
      Happens(Wrong::kNoTime, "things happen without end, and no time passes");
      return End(Curtain::kFailed);
    }
    Look();
    if (recorder_ != nullptr) recorder_->Scene(time_, scene_);
    if (!report_.lost.empty()) return End(Curtain::kLost);
    for (const auto& performer : performers_) {
      if (!performer->problem().empty()) {
        report_.lost = performer->problem();
        return End(Curtain::kLost);
      }
    }
    const auto all = [&](auto holds) { return std::ranges::all_of(sessions_, holds); };
    for (size_t r = 0; r < sessions_.size(); ++r) {
      const Session& session = sessions_[r];
      if (!session.failed()) continue;
      Happens(Wrong::kChoice, fmt::format("`{}`: {}", graph_.NameOf(choreo::RobotId(r)), session.fault()));
      return End(Curtain::kFailed);
    }
    if (all([](const Session& s) { return s.ended(); })) return End(Curtain::kEnd);
    const bool waits = all([](const Session& s) { return s.idle(); });
    if (waits || all([](const Session& s) { return s.ended() || !s.moving(); })) {
      Happens(Wrong::kStuck, Waiting());
      return End(Curtain::kFailed);
    }
    if (options_.stop.StopRequested() || time_ >= options_.interrupt_at) return End(Curtain::kInterrupted);
    if (time_ >= options_.duration) return End(Curtain::kTime);
    for (size_t r = 0; r < performers_.size(); ++r) {
      // Moments are rounded to nanoseconds, each of them: threads drift apart a little.
      constexpr double kDrift = 1e-6;
      std::optional<double>& since = stood_since_[r];
      if (!Stands(sessions_[r])) {
        since.reset();
      } else if (!since) {
        since = time_;
      } else if (time_ > *since + kDrift) {
        Happens(Wrong::kWaiting, fmt::format("time passes for `{}`, which makes no motion",
                                             graph_.NameOf(choreo::RobotId(r))));
      }
    }
    if (options_.progress) options_.progress(time_, options_.duration);
    return false;
  }

  // What everybody waits for.
  std::string Waiting() const {
    std::string text;
    for (size_t r = 0; r < performers_.size(); ++r) {
      const Session& session = sessions_[r];
      if (session.ended() || !session.step()) continue;
      const Step& step = *session.step();
      std::string what;
      if (step.kind == Step::Kind::kSend)
        what = fmt::format("to send `{}` to `{}`", step.label, graph_.NameOf(choreo::RobotId(step.to)));
      for (const auto& c : step.cases)
        what += fmt::format("{}`{}` from `{}`", what.empty() ? "for " : " or ", c.label,
                            graph_.NameOf(choreo::RobotId(c.from)));
      text +=
          fmt::format("{}`{}` waits {}", text.empty() ? "" : ", ", graph_.NameOf(choreo::RobotId(r)), what);
    }
    return text;
  }

  const choreo::Cast& cast_;
  const choreo::Graph& graph_;
  const robot::World& world_;
  expr::Arena& arena_;
  const ChoreographyOptions& options_;
  StageRecorder* recorder_;
  std::mt19937_64 random_;
  SceneState scene_;
  MotionLibrary library_;
  Places places_;
  Promises promises_;
  std::optional<Disturbances> disturbances_;
  std::optional<Contacts> contacts_;
  std::vector<std::unique_ptr<Performer>> performers_;  // by robot
  std::deque<Session> sessions_;                        // by robot
  ChoreographyReport report_;
  const Tell tell_ = [this](Wrong wrong, const std::string& what) { Happens(wrong, what); };
  std::vector<size_t> order_;                       // of the robots, to move
  std::vector<std::optional<double>> stood_since_;  // by robot, seconds
  Time now_ = 0;                                    // nanoseconds
  double time_ = 0;                                 // the same in seconds
};

}  // namespace

ChoreographyReport RunChoreography(const choreo::Cast& cast, const ChoreographyOptions& options,
                                   StageRecorder* recorder) {
  return ChoreographyRun(cast, options, recorder).Go();
}

}  // namespace rondo::sim::motions
