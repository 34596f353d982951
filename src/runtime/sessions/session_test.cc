#include "runtime/sessions/session.h"

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <random>

namespace rondo::runtime::sessions {
namespace {

Step Sending(uint32_t to, const std::string& label, std::vector<double> values = {}) {
  Step step;
  step.kind = Step::Kind::kSend;
  step.to = to;
  step.label = label;
  step.values = std::move(values);
  return step;
}
Step Receiving(std::vector<Expected> cases, std::optional<size_t> motion = std::nullopt) {
  Step step;
  step.kind = Step::Kind::kReceive;
  step.cases = std::move(cases);
  step.motion = motion;
  return step;
}
Step Moving(size_t motion) {
  Step step;
  step.kind = Step::Kind::kMove;
  step.motion = motion;
  return step;
}

/// Does steps one after the other, and remembers what happened.
class List : public Program {
 public:
  explicit List(std::vector<Step> steps) : steps_(steps.begin(), steps.end()) {}
  Step Next() override {
    ++asked;
    return steps_.empty() ? Step{} : steps_.front();
  }
  bool Waits() const override { return steps_.size() > 1 && steps_[1].kind == Step::Kind::kReceive; }
  void Sent() override { Drop("sent " + steps_.front().label); }
  void Took(size_t taken, const std::vector<double>& values) override {
    std::string text = "took " + steps_.front().cases[taken].label;
    for (const double v : values) text += " " + std::to_string(static_cast<int>(v));
    Drop(text);
  }
  void Moved() override { Drop("moved"); }

  std::vector<std::string> did;
  int asked = 0;

 private:
  void Drop(std::string text) {
    did.push_back(std::move(text));
    steps_.pop_front();
  }
  std::deque<Step> steps_;
};

/// A motion that is as far as the test says.
class Hand : public Motions {
 public:
  void Begin(size_t motion) override {
    begun.push_back(motion);
    now = after;
  }
  Progress Tick() override { return now; }
  void Halt() override {
    ++halts;
    if (stops) now = Progress::kStopped;
  }

  std::vector<size_t> begun;
  Progress now = Progress::kStopped;
  Progress after = Progress::kBound;  // right behind the beginning
  bool stops = true;                  // at once, when it is told to
  int halts = 0;
};

using Did = std::vector<std::string>;

struct Robot {
  explicit Robot(uint32_t self, std::vector<Step> steps)
      : program(std::move(steps)), session(7, self, 10, program, hand) {}
  List program;
  Hand hand;
  Session session;
};

// Everything that both say arrives at once.
void Settle(Time now, Robot& a, Robot& b) {
  for (bool went = true; went;) {
    went = a.session.Advance(now) || b.session.Advance(now);
    for (const Frame& f : a.session.TakeFrames()) b.session.Hear(f), went = true;
    for (const Frame& f : b.session.TakeFrames()) a.session.Hear(f), went = true;
  }
}

TEST(Session, AMessageIsSentWhenItIsTaken) {
  Robot a(0, {Sending(1, "m", {3, 4})}), b(1, {Moving(5), Receiving({{0, "m"}})});
  Settle(0, a, b);
  EXPECT_EQ(a.program.did, Did{});  // the other one moves
  EXPECT_FALSE(a.session.ended());
  b.hand.now = Progress::kStopped;
  Settle(1, a, b);
  EXPECT_EQ(a.program.did, Did{"sent m"});
  EXPECT_EQ(b.program.did, (Did{"moved", "took m 3 4"}));
  EXPECT_TRUE(a.session.ended() && b.session.ended());
}

TEST(Session, AMessageEndsAMotionThatIsOpen) {
  Robot a(0, {Moving(1), Sending(1, "m")}), b(1, {Receiving({{0, "m"}}, 2)});
  b.hand.after = Progress::kOpen;
  Settle(0, a, b);
  EXPECT_EQ(b.hand.begun, std::vector<size_t>{2});
  EXPECT_TRUE(b.session.idle());
  a.hand.now = Progress::kStopped;
  Settle(1, a, b);
  EXPECT_EQ(b.hand.halts, 1);
  EXPECT_EQ(b.program.did, Did{"took m"});
}

TEST(Session, NoMessageEndsAMotionThatIsBound) {
  Robot a(0, {Sending(1, "m")}), b(1, {Receiving({{0, "m"}}, 2)});
  b.session.Advance(0);
  Settle(0, a, b);
  Settle(1, a, b);
  EXPECT_EQ(b.program.did, Did{});
  EXPECT_EQ(b.hand.halts, 0);
  EXPECT_FALSE(b.session.idle());
  b.hand.now = Progress::kOpen;
  Settle(2, a, b);
  EXPECT_EQ(b.program.did, Did{"took m"});
}

TEST(Session, AMessageIsNotTakenBeforeTheMotionHasStopped) {
  Robot a(0, {Sending(1, "m")}), b(1, {Receiving({{0, "m"}}, 2)});
  b.hand.after = Progress::kOpen;
  b.hand.stops = false;
  b.session.Advance(0);
  Settle(0, a, b);
  EXPECT_EQ(b.hand.halts, 1);
  Settle(1, a, b);
  EXPECT_EQ(b.hand.halts, 1);  // told once
  EXPECT_EQ(a.program.did, Did{});
  b.hand.now = Progress::kStopped;
  Settle(2, a, b);
  EXPECT_EQ(a.program.did, Did{"sent m"});
}

TEST(Session, WhatItDoesMeanwhileIsDoneAgain) {
  Robot b(1, {Receiving({{0, "m"}}, 2)});
  b.session.Advance(0);
  b.hand.now = Progress::kStopped;
  b.session.Advance(1);
  EXPECT_EQ(b.hand.begun, (std::vector<size_t>{2, 2}));
}

TEST(Session, AMotionGoesOnUntilSomethingEndsIt) {
  Robot a(0, {Moving(1), Sending(1, "m"), Moving(3)}), b(1, {Receiving({{0, "m"}})});
  a.hand.after = Progress::kOpen;
  a.session.Advance(0);
  EXPECT_EQ(a.program.did, Did{});  // it decides only when it is ready
  a.hand.now = Progress::kReady;
  a.session.Advance(1);
  EXPECT_EQ(a.program.did, Did{"moved"});
  EXPECT_TRUE(a.session.moving());
  EXPECT_EQ(a.hand.halts, 0);
  a.hand.after = Progress::kBound;
  Settle(2, a, b);
  EXPECT_EQ(a.hand.halts, 1);
  EXPECT_EQ(a.hand.begun, (std::vector<size_t>{1, 3}));
}

TEST(Session, AMessageIsNotSentBeforeTheMotionHasStopped) {
  Robot a(0, {Moving(1), Sending(1, "m")}), b(1, {Receiving({{0, "m"}})});
  a.hand.after = Progress::kReady;
  a.hand.stops = false;
  Settle(0, a, b);
  EXPECT_EQ(b.program.did, Did{"took m"});
  EXPECT_EQ(a.program.did, Did{"moved"});
  a.hand.now = Progress::kStopped;
  Settle(1, a, b);
  EXPECT_EQ(a.program.did, (Did{"moved", "sent m"}));
}

// It listens, and if nothing comes it has moved.
Step Onward(std::vector<Expected> cases, size_t motion) {
  Step step = Receiving(std::move(cases), motion);
  step.again = false;
  return step;
}

TEST(Session, IfNoMessageComesItHasMoved) {
  Robot a(0, {Onward({{1, "m"}}, 4), Moving(5)});
  a.hand.after = Progress::kReady;
  a.session.Advance(0);
  a.session.Advance(0);
  EXPECT_EQ(a.program.did, Did{});  // a message may come at this instant
  a.session.Advance(1);
  EXPECT_EQ(a.program.did.front(), "moved");
  Robot b(0, {Onward({{1, "m"}}, 4), Moving(5)});
  b.session.Advance(0);
  b.session.Advance(1);
  EXPECT_EQ(b.program.did, Did{});
  b.hand.now = Progress::kStopped;
  b.session.Advance(2);
  EXPECT_EQ(b.program.did.front(), "moved");
  EXPECT_EQ(b.hand.begun, (std::vector<size_t>{4, 5}));
}

TEST(Session, WhoMayBeAtTheEndIsItUnlessAMessageComes) {
  Step last = Onward({{0, "m"}}, 4);
  last.ends = true;
  Robot a(0, {Sending(1, "m")}), b(1, {last});
  b.session.Advance(0);
  EXPECT_FALSE(b.session.ended());  // it has to go on
  b.hand.now = Progress::kOpen;
  b.session.Advance(0);
  EXPECT_TRUE(b.session.ended());
  a.session.Advance(0);
  for (const Frame& f : a.session.TakeFrames()) b.session.Hear(f);
  EXPECT_FALSE(b.session.ended());
  b.session.Advance(0);
  EXPECT_EQ(b.program.did, Did{"took m"});
}

TEST(Session, WhoWaitsListensAsSoonAsItsMotionIsOpen) {
  Robot a(0, {Sending(1, "m")}), b(1, {Moving(1), Receiving({{0, "m"}})});
  b.hand.after = Progress::kOpen;
  Settle(0, a, b);
  EXPECT_EQ(b.program.did, (Did{"moved", "took m"}));
}

TEST(Session, AMessageThatIsNotExpectedYetWaits) {
  Robot a(0, {Sending(1, "second")}),
      b(1, {Receiving({{2, "first"}}), Receiving({{0, "other"}, {0, "second"}})});
  Settle(0, a, b);
  EXPECT_EQ(b.program.did, Did{});
  b.session.Hear({Frame::Kind::kOffer, 7, 2, 1, 0, "first", {}});
  Settle(1, a, b);
  EXPECT_EQ(b.program.did, (Did{"took first", "took second"}));
}

TEST(Session, OffersAreSentAgainAndTakenOnce) {
  Robot a(0, {Sending(1, "m"), Sending(1, "m")}), b(1, {Receiving({{0, "m"}}), Receiving({{0, "m"}})});
  a.session.Advance(0);
  EXPECT_EQ(a.session.Wake(), 10);
  EXPECT_EQ(a.session.TakeFrames().size(), 1u);  // lost
  a.session.Advance(9);
  EXPECT_TRUE(a.session.TakeFrames().empty());
  a.session.Advance(10);
  const std::vector<Frame> again = a.session.TakeFrames();
  ASSERT_EQ(again.size(), 1u);
  b.session.Hear(again[0]);
  b.session.Advance(10);
  EXPECT_EQ(b.session.TakeFrames().size(), 1u);  // lost
  b.session.Hear(again[0]);                      // the same once more
  b.session.Advance(11);
  EXPECT_EQ(b.program.did, Did{"took m"});
  const std::vector<Frame> answers = b.session.TakeFrames();
  ASSERT_EQ(answers.size(), 1u);
  a.session.Hear(answers[0]);
  a.session.Advance(12);
  EXPECT_EQ(a.program.did, Did{"sent m"});
  a.session.Hear(answers[0]);  // of the first message, not of the second
  a.session.Advance(13);
  EXPECT_EQ(a.program.did, Did{"sent m"});
  EXPECT_EQ(a.session.Wake(), 22);
}

TEST(Session, IgnoresWhatIsNotForIt) {
  Robot b(1, {Receiving({{0, "m"}})});
  b.session.Hear({Frame::Kind::kOffer, 8, 0, 1, 0, "m", {}});  // another session
  b.session.Hear({Frame::Kind::kOffer, 7, 0, 2, 0, "m", {}});  // another robot
  b.session.Hear({Frame::Kind::kOffer, 7, 1, 1, 0, "m", {}});  // from itself
  b.session.Hear({Frame::Kind::kOffer, 7, 0, 1, 3, "m", {}});  // too early
  b.session.Hear({Frame::Kind::kTaken, 7, 0, 1, 0, "", {}});
  b.session.Advance(0);
  EXPECT_EQ(b.program.did, Did{});
  EXPECT_TRUE(b.session.TakeFrames().empty());
}

TEST(Session, FaultsAndFailedMotionsEndIt) {
  Step fault;
  fault.kind = Step::Kind::kFault;
  fault.label = "why";
  Robot a(0, {fault});
  a.session.Advance(0);
  EXPECT_TRUE(a.session.failed());
  EXPECT_EQ(a.session.fault(), "why");
  Robot b(0, {Moving(1)});
  b.hand.after = Progress::kFailed;
  b.session.Advance(0);
  EXPECT_TRUE(b.session.failed());
  EXPECT_EQ(b.program.did, Did{});
}

TEST(Session, AsksOncePerStep) {
  Robot a(0, {Sending(1, "m")});
  for (Time t = 0; t < 50; ++t) a.session.Advance(t);
  EXPECT_EQ(a.program.asked, 1);
}

// Three robots say a hundred things to each other, over a network that loses, doubles, delays and exchanges frames.
TEST(Session, MessagesArriveOnceAndInOrderWhateverTheNetworkDoes) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    std::array<std::vector<Step>, 3> steps;
    std::array<Did, 3> wanted;
    for (int k = 0; k < 100; ++k) {
      const auto from = static_cast<uint32_t>(random() % 3),
                 to = (from + 1 + static_cast<uint32_t>(random() % 2)) % 3;
      const std::string label(1, static_cast<char>('a' + random() % 3));
      steps[from].push_back(Sending(to, label, {static_cast<double>(k)}));
      steps[to].push_back(Receiving({{from, label}}));
      wanted[from].push_back("sent " + label);
      wanted[to].push_back("took " + label + " " + std::to_string(k));
    }
    Robot a(0, steps[0]), b(1, steps[1]), c(2, steps[2]);
    std::array<Robot*, 3> robots{&a, &b, &c};
    std::vector<std::pair<Time, Frame>> radio;
    Time now = 0;
    const auto ended = [&] { return a.session.ended() && b.session.ended() && c.session.ended(); };
    for (; now < 100'000 && !ended(); ++now) {
      for (Robot* robot : robots) {
        robot->session.Advance(now);
        for (const Frame& f : robot->session.TakeFrames()) {
          for (uint64_t copies = random() % 3; copies > 0; --copies)
            radio.emplace_back(now + 1 + static_cast<Time>(random() % 30), f);
        }
      }
      std::erase_if(radio, [&](const auto& flying) {
        if (flying.first > now) return false;
        robots[flying.second.to]->session.Hear(flying.second);
        return true;
      });
    }
    ASSERT_TRUE(ended()) << seed;
    for (size_t r = 0; r < 3; ++r) ASSERT_EQ(robots[r]->program.did, wanted[r]) << seed;
  }
}

}  // namespace
}  // namespace rondo::runtime::sessions
