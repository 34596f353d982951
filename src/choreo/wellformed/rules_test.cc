#include <gtest/gtest.h>

#include "choreo/graph/lowered_module_test.h"
#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

/// Returns what is wrong with the steps of two or three robots, each kind once for each report.
std::vector<Kind> Wrong(const std::string& steps, bool three = false, bool equal = false) {
  const std::string text =
      "robot R {\n state x: length in [-9 m, 9 m]\n motion Idle() interruptible [0 s, inf) {}\n"
      " motion Wait() interruptible [1 s, inf) {}\n motion Go() noninterruptible [2 s, 2 s] {}\n"
      " motion Slow() noninterruptible [1 s, 3 s] {}\n motion Long() noninterruptible [3 s, 3 s] {}\n"
      " motion Rest() interruptible [0 s, 1 s] {}\n motion Blink() noninterruptible [0 s, 0 s] {}\n}\n"
      "world W { a: R b: R " +
      std::string(three ? "c: R " : "") + "}\nchoreography C in W {\n" +
      (equal ? "option equal_durations\n" : "") + steps + "\n}\n";
  LoweredModule m(text);
  EXPECT_FALSE(m.diagnostics.has_errors()) << text;
  EXPECT_EQ(m.graphs.size(), 1U) << text;
  for (const Graph& graph : m.graphs) CheckWellFormed(graph, m.diagnostics);
  return m.kinds();
}

std::vector<Kind> WrongOfThree(const std::string& steps) { return Wrong(steps, true); }

using Kinds = std::vector<Kind>;
const Kinds kGood;

std::string Choice(const std::string& first, const std::string& second) {
  return "choose at a { when a.x > 0 m { " + first + " } when a.x <= 0 m { " + second + " } }";
}

TEST(WellFormedChoices, EachAlternativeBeginsWithADistinctMessageOfTheOneWhoChooses) {
  EXPECT_EQ(Wrong(Choice("a -> b: l()", "a -> b: r()")), kGood);
}

TEST(WellFormedChoices, EqualLabelsCannotBeToldApart) {
  EXPECT_EQ(Wrong(Choice("a -> b: l()", "a -> b: l()")), Kinds{Kind::kChoreoChoiceLabel});
}

TEST(WellFormedChoices, AMessageOfAnotherRobotDoesNotTellOfTheChoice) {
  EXPECT_EQ(Wrong(Choice("a -> b: l()", "b -> a: r()")), Kinds{Kind::kChoreoChoiceSilent});
}

TEST(WellFormedChoices, AnAlternativeMayNotEndWithoutAWord) {
  EXPECT_EQ(Wrong("while a.x > 0 m { a -> b: on() { a: Wait(), b: Wait() } }"),
            Kinds{Kind::kChoreoChoiceSilent});
}

TEST(WellFormedChoices, ARobotAloneTellsNobody) {
  EXPECT_EQ(Wrong("parallel { thread { " + Choice("a: Idle()", "a: Wait() a: Idle()") +
                  " } thread { b: Idle() } }"),
            kGood);
}

TEST(WellFormedSynchronisation, OneMotionAloneNeedsNoMessage) {
  EXPECT_EQ(Wrong("{ a: Go(), b: Idle() }"), kGood);
}

TEST(WellFormedSynchronisation, WhoCannotBeInterruptedSpeaksFirst) {
  EXPECT_EQ(Wrong("{ a: Go(), b: Idle() } a -> b: done()"), kGood);
  EXPECT_EQ(Wrong("{ a: Go(), b: Idle() } b -> a: stop()"), Kinds{Kind::kChoreoNotReady});
}

TEST(WellFormedSynchronisation, AMotionMustHaveLastedItsLeastTimeBeforeAMessage) {
  EXPECT_EQ(Wrong("{ a: Wait(), b: Idle() } a -> b: now()"), kGood);
  EXPECT_EQ(WrongOfThree("{ a: Idle(), b: Idle(), c: Wait() } a -> b: l() a -> c: l()"),
            Kinds{Kind::kChoreoNotReady});
}

TEST(WellFormedSynchronisation, AMessageStandsBetweenTwoMotions) {
  EXPECT_EQ(Wrong("{ a: Go(), b: Idle() } a -> b: done() { a: Idle(), b: Go() }"), kGood);
  EXPECT_EQ(Wrong("{ a: Go(), b: Idle() } { a: Idle(), b: Go() }"), Kinds{Kind::kChoreoMotionAfterMotion});
}

TEST(WellFormedSynchronisation, EveryRobotIsToldThatTheMotionChanges) {
  const std::string before = "{ a: Idle(), b: Idle(), c: Idle() } a -> b: go() ";
  const std::string after = "{ a: Go(), b: Idle(), c: Idle() }";
  EXPECT_EQ(WrongOfThree(before + after), Kinds{Kind::kChoreoNotInformed});
  EXPECT_EQ(WrongOfThree(before + "b -> c: go() " + after), kGood);
}

TEST(WellFormedSynchronisation, OneMessageIsTheFirstAfterAMotion) {
  EXPECT_EQ(WrongOfThree("{ a: Idle(), b: Idle(), c: Idle() } a -> b: one() c -> b: two()"),
            Kinds{Kind::kChoreoUnordered});
  EXPECT_EQ(WrongOfThree("{ a: Idle(), b: Idle(), c: Idle() } a -> b: one() b -> c: two() c -> b: three()"),
            kGood);
}

TEST(WellFormedTime, AtMostOneMotionOfAStepCannotBeInterrupted) {
  EXPECT_EQ(Wrong("{ a: Go(), b: Go() }"), Kinds{Kind::kChoreoTwoRigid});
}

TEST(WellFormedTime, EqualFixedDurationsAreAllowedOnDemand) {
  EXPECT_EQ(Wrong("{ a: Go(), b: Go() }", false, true), kGood);
  EXPECT_EQ(Wrong("{ a: Go(), b: Long() }", false, true), Kinds{Kind::kChoreoTwoRigid});
  EXPECT_EQ(Wrong("{ a: Slow(), b: Slow() }", false, true), Kinds{Kind::kChoreoTwoRigid});
}

TEST(WellFormedTime, AMotionThatCanBeInterruptedLastsAsLongAsTheOneThatCannot) {
  EXPECT_EQ(Wrong("{ a: Blink(), b: Rest() }"), kGood);
  EXPECT_EQ(Wrong("{ a: Go(), b: Rest() }"), Kinds{Kind::kChoreoDurationOutside});
  EXPECT_EQ(Wrong("{ a: Blink(), b: Wait() }"), Kinds{Kind::kChoreoDurationOutside});
}

TEST(WellFormedTime, ALoopHasAStepOnEveryWay) {
  EXPECT_EQ(Wrong("rec X { continue X }"), Kinds{Kind::kChoreoUnguarded});
}

TEST(WellFormedTime, ALoopTakesTimeOnEveryWay) {
  EXPECT_EQ(Wrong("loop { a -> b: l() b -> a: l() }"), Kinds{Kind::kChoreoZeno});
  EXPECT_EQ(Wrong("loop { a -> b: l() { a: Idle(), b: Idle() } }"), Kinds{Kind::kChoreoZeno});
  EXPECT_EQ(Wrong("loop { a -> b: l() { a: Blink(), b: Idle() } }"), Kinds{Kind::kChoreoZeno});
  EXPECT_EQ(Wrong("loop { a -> b: l() { a: Wait(), b: Idle() } }"), kGood);
  EXPECT_EQ(Wrong("loop { a -> b: l() { a: Go(), b: Idle() } }"), kGood);
}

TEST(WellFormedDurations, ThreadsOfEqualLengthAreThroughTogether) {
  EXPECT_EQ(Wrong("parallel { thread { a: Go() } thread { b: Go() } }"), kGood);
  EXPECT_EQ(Wrong("parallel { thread { a: Go() } thread { b: Long() } }"),
            Kinds{Kind::kChoreoDurationOutside});
}

TEST(WellFormedDurations, DurationsAddUpAlongAThread) {
  EXPECT_EQ(Wrong("parallel { thread { a: Go() a: Go() a: Go() } thread { b: Long() b: Long() } }"), kGood);
  EXPECT_EQ(Wrong("parallel { thread { a: Go() a: Go() } thread { b: Long() b: Long() } }"),
            Kinds{Kind::kChoreoDurationOutside});
}

TEST(WellFormedDurations, AThreadThatIdlesAtItsEndWaits) {
  EXPECT_EQ(Wrong("parallel { thread { a: Go() a: Idle() } thread { b: Long() } }"), kGood);
  EXPECT_EQ(Wrong("parallel { thread { a: Long() a: Idle() } thread { b: Go() } }"),
            Kinds{Kind::kChoreoDurationOutside});
}

TEST(WellFormedDurations, TwoUnknownDurationsNeedNotMeet) {
  EXPECT_EQ(Wrong("parallel { thread { a: Slow() } thread { b: Slow() } }"),
            Kinds{Kind::kChoreoDurationOutside});
  EXPECT_EQ(Wrong("parallel { thread { a: Slow() } thread { b: Idle() } }"), kGood);
}

TEST(WellFormedDurations, EitherAllThreadsGoOnForEverOrNone) {
  EXPECT_EQ(Wrong("parallel { thread { loop { a: Go() } } thread { loop { b: Go() } } }"), kGood);
  EXPECT_EQ(Wrong("parallel { thread { loop { a: Go() } } thread { b: Go() } }"),
            Kinds{Kind::kChoreoThreadEndless});
}

TEST(WellFormedDurations, AThreadWithoutMotionCannotWaitForOthers) {
  EXPECT_EQ(WrongOfThree("parallel { thread { a -> b: hello() } thread { c: Go() } }"),
            Kinds{Kind::kChoreoThreadStill});
}

}  // namespace
}  // namespace rondo::choreo
