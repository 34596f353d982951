// Runs of the session core are runs of the semantics: whatever durations motions take and whichever alternatives are
// chosen, the messages and the time between them are possible there; nobody gets stuck, and no time passes for a
// robot that makes no motion.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <memory>

#include "checked.h"
#include "choreo/node/cast.h"
#include "choreo/semantics/search.h"
#include "random_choreographies.h"

namespace rondo::choreo {
namespace {

using runtime::sessions::Frame;
using runtime::sessions::Progress;
using runtime::sessions::Session;

constexpr int64_t kTick = 2;  // in a second, as `Ticks` counts for durations of whole seconds
constexpr int64_t kForever = 1'000'000;

/// Is everything that is left open, one decision after the other: given ones first, then the first of each.
class Tape {
 public:
  explicit Tape(std::vector<size_t> given) : given_(std::move(given)) {}
  size_t Pick(size_t count) {
    const size_t chosen = made_.size() < given_.size() ? given_[made_.size()] : 0;
    made_.push_back(chosen);
    counts_.push_back(count);
    return chosen;
  }
  // The next tape in the order of all; false if this was the last one.
  bool Next() {
    while (!made_.empty() && made_.back() + 1 >= counts_.back()) {
      made_.pop_back();
      counts_.pop_back();
    }
    if (made_.empty()) return false;
    ++made_.back();
    given_ = std::move(made_);
    made_.clear();
    counts_.clear();
    return true;
  }

 private:
  std::vector<size_t> given_, made_, counts_;
};

/// Is a robot whose motions take as long as the tape says, and do nothing.
class Robot : public runtime::sessions::Motions, public Senses {
 public:
  Robot(const Cast& cast, size_t robot, Tape& tape, const int64_t& now)
      : graph_(*cast.graph),
        tape_(tape),
        now_(now),
        script_(ScriptOf(cast, RobotId(robot), *this)),
        session_(1, static_cast<uint32_t>(robot), 1, *script_, *this) {}

  Session& session() { return session_; }
  void Urge() { ready_ = 0; }
  bool stands() const { return !session_.ended() && !session_.moving(); }

  void Begin(size_t motion) override {
    const Duration& d = graph_.instances[motion].duration;
    const auto ticks = [](const expr::Rational& seconds) { return std::llround(seconds.ToDouble() * kTick); };
    begun_ = now_;
    least_ = ticks(d.least);
    most_ = d.most ? ticks(*d.most) : kForever;
    interruptible_ = d.interruptible;
    // Longer than two seconds more than it has to be is nothing new.
    const int64_t longest = std::min(most_, least_ + 2 * kTick);
    ready_ = least_ + static_cast<int64_t>(tape_.Pick(static_cast<size_t>(longest - least_ + 1)));
    moving_ = true;
  }
  Progress Tick() override {
    const int64_t time = now_ - begun_;
    if (!moving_ || time >= most_ || (!interruptible_ && time >= ready_)) return Progress::kStopped;
    if (!interruptible_ || time < least_) return Progress::kBound;
    return time >= ready_ ? Progress::kReady : Progress::kOpen;
  }
  void Halt() override { moving_ = false; }

  const expr::Numeric::Point& Now() override {
    state_.clear();
    for (const robot::Body& body : graph_.world->bodies) {
      for (const robot::Variable& v : body.states) state_[v.term] = tape_.Pick(2) == 0 ? 1 : -1;
    }
    return state_;
  }
  size_t Pick(size_t count) override { return tape_.Pick(count); }
  std::optional<std::vector<double>> Choose(const Node&) override { return std::vector<double>{}; }

 private:
  const Graph& graph_;
  Tape& tape_;
  const int64_t& now_;
  int64_t begun_ = 0, least_ = 0, most_ = 0, ready_ = 0;
  bool interruptible_ = false, moving_ = false;
  expr::Numeric::Point state_;
  std::unique_ptr<runtime::sessions::Program> script_;
  Session session_;
};

/// Follows a run in the semantics: where it may be there.
class Follower {
 public:
  explicit Follower(const Team& team) : team_(team), at_{team.Start()} { Close(); }

  bool Hears(const std::string& label) {
    std::set<Team::State> next;
    for (const Team::State& s : at_) {
      for (Team::Step& step : team_.Next(s)) {
        if (step.label == label) next.insert(std::move(step.state));
      }
    }
    return Go(std::move(next));
  }
  bool Waits() {
    std::set<Team::State> next;
    for (const Team::State& s : at_) {
      for (Team::Step& step : team_.Next(s)) {
        if (IsTick(s, step)) next.insert(std::move(step.state));
      }
    }
    return Go(std::move(next));
  }
  bool MayEnd() const {
    return std::ranges::any_of(at_, [&](const Team::State& s) { return team_.Ended(s); });
  }

 private:
  // Everybody goes on with what he does; all but clocks stay as they are.
  static bool IsTick(const Team::State& before, const Team::Step& step) {
    if (!step.label.empty()) return false;
    bool moving = false;
    for (size_t r = 0; r < before.size(); ++r) {
      const Team::Local &a = before[r], &b = step.state[r];
      if (a.at != b.at || a.moving != b.moving || a.from != b.from || a.edge != b.edge || b.clock < a.clock)
        return false;
      moving = moving || a.moving;
    }
    return moving;
  }
  bool Go(std::set<Team::State> next) {
    at_ = std::move(next);
    Close();
    return !at_.empty();
  }
  void Close() {
    std::vector<Team::State> todo(at_.begin(), at_.end());
    while (!todo.empty()) {
      const Team::State s = std::move(todo.back());
      todo.pop_back();
      for (Team::Step& step : team_.Next(s)) {
        if (!step.label.empty() || IsTick(s, step)) continue;
        if (at_.insert(step.state).second) todo.push_back(std::move(step.state));
      }
    }
  }

  const Team& team_;
  std::set<Team::State> at_;
};

/// One run, up to a time.
class Run {
 public:
  Run(const Cast& cast, const Team& team, Tape& tape) : follower_(team) {
    for (size_t r = 0; r < cast.types.size(); ++r)
      robots_.push_back(std::make_unique<Robot>(cast, r, tape, now_));
  }

  // Nothing if it is a run of the semantics.
  std::string Problem(int64_t until) {
    for (; now_ <= until; ++now_) {
      if (!Settle()) return text_;
      // A joint motion is over when one of its motions has to be: then the others do not last either.
      if (!Ended() && (Stands() || !Follower(follower_).Waits())) {
        for (const auto& robot : robots_) robot->Urge();
        if (!Settle()) return text_;
      }
      if (Ended()) return follower_.MayEnd() ? "" : text_ + " | ends too early";
      if (Stands()) return text_ + " | somebody stands while time passes";
      if (std::ranges::all_of(robots_, [](const auto& r) { return r->session().idle(); }))
        return text_ + " | stuck";
      if (!follower_.Waits()) return text_ + " | no time may pass";
      text_ += " .";
    }
    return "";
  }

 private:
  bool Ended() const {
    return std::ranges::all_of(robots_, [](const auto& r) { return r->session().ended(); });
  }
  bool Stands() const {
    return std::ranges::any_of(robots_, [](const auto& r) { return r->stands(); });
  }

  bool Settle() {
    for (int i = 0; i < 1000; ++i) {
      bool went = false;
      for (const auto& robot : robots_) {
        if (robot->session().Advance(now_)) went = true;
        for (const Frame& frame : robot->session().TakeFrames()) {
          went = true;
          // Taken by the robot that answers: the message happens now.
          if (frame.kind == Frame::Kind::kOffer) offers_[{frame.from, frame.to}] = frame.label;
          if (frame.kind == Frame::Kind::kTaken && !Happens(frame.to, frame.from)) return false;
          robots_[frame.to]->session().Hear(frame);
        }
      }
      if (!went) return true;
    }
    text_ += " | no end of it";
    return false;
  }

  bool Happens(uint32_t from, uint32_t to) {
    const auto offer = offers_.extract({from, to});
    if (offer.empty()) return true;  // it was answered before
    const std::string label = std::to_string(from) + ">" + std::to_string(to) + ":" + offer.mapped();
    text_ += " " + label;
    if (follower_.Hears(label)) return true;
    text_ += " | not allowed";
    return false;
  }

  int64_t now_ = 0;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::map<std::pair<uint32_t, uint32_t>, std::string> offers_;
  Follower follower_;
  std::string text_;
};

// Looks at all runs, as many as there are up to a limit. Returns how many.
int ExpectRuns(const std::string& text, Checked& checked, bool projections, int most) {
  const Team team = checked.team();
  const Cast cast = MakeCast(checked.module, checked.graphs[0], *checked.declarations, projections);
  Tape tape({});
  for (int runs = 1; runs <= most; ++runs) {
    const std::string problem = Run(cast, team, tape).Problem(8 * kTick);
    EXPECT_EQ(problem, "") << text;
    if (!problem.empty() || !tape.Next()) return runs;
  }
  return most;
}

TEST(Sessions, RunsAreRunsOfTheSemantics) {
  const char* cases = std::getenv("RONDO_CASES");
  const uint64_t seeds = cases == nullptr ? 6000 : std::strtoull(cases, nullptr, 10);
  int good = 0, runs = 0;
  for (uint64_t seed = 0; seed < seeds && !testing::Test::HasFailure(); ++seed) {
    const std::string text = RandomChoreography(seed).Whole();
    Checked checked(text);
    if (!checked.good()) continue;
    ++good;
    runs += ExpectRuns(text, checked, true, 40);
  }
  EXPECT_GT(good, 100);
  EXPECT_GT(runs, 1000);
}

// Payloads, guards and assignments decide what they do, so that there are few runs of each.
TEST(Sessions, ProcessesDoWhatTheirProjectionsDo) {
  const std::string text = R"(
robot R {
  state x : length in [-9 m, 9 m]
  motion Idle() interruptible [0 s, inf) {}
  motion Go(d : length = 1 m, T = 1 s) noninterruptible [T, T] { modifies x }
}
world W { a: R  b: R  c: R }
choreography C in W {
  { a: Go(), b: Idle(), c: Idle() }
  a -> b: done(far: length)
  b -> c: done(far: length)
  while b.x > 0 m {
    b -> a: more()
    b -> c: more()
    parallel { thread { { a: Go(2 m), c: Idle() } a -> c: half() } thread { b: Idle() } }
    a -> b: half()
    b -> c: go()
    { a: Idle(), b: Go(), c: Idle() }
  }
  b -> a: enough()
  b -> c: enough()
  { a: Idle(), b: Idle(), c: Go(3 m) }
  c -> a: end()
  c -> b: end()
}
process a in C {
  Go()
  send b.done(2 m)
  rec X {
    receive from b while Idle() {
      more => { Go(2 m) send c.half() send b.half() continue X }
      enough => { receive from c while Idle() { end => exit } }
    }
  }
}
process b in C {
  receive from a while Idle() { done(d) => { twice = d + d send c.done(twice) } }
  while x > 0 m {
    send a.more()
    send c.more()
    receive from a while Idle() { half => {} }
    send c.go()
    Go()
  }
  send a.enough()
  send c.enough()
  receive from c while Idle() { end => exit }
}
process c in C {
  receive from b while Idle() { done(d) => {} }
  rec X {
    receive from b while Idle() {
      more => { receive from a while Idle() { half => {} } receive from b { go => {} } continue X }
      enough => { Go(3 m) send a.end() send b.end() }
    }
  }
}
)";
  for (const bool projections : {true, false}) {
    Checked checked(text);
    ASSERT_TRUE(checked.good()) << checked.trouble();
    EXPECT_GT(ExpectRuns(text, checked, projections, 400), 10) << projections;
  }
}

}  // namespace
}  // namespace rondo::choreo
