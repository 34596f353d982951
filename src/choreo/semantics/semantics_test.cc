#include <gtest/gtest.h>

#include <algorithm>

#include "choreo/semantics/search.h"
#include "choreo/semantics/team.h"

namespace rondo::choreo {
namespace {

using Kind = MachineEdge::Kind;
using expr::Rational;

Duration Lasting(int least, int most) { return {Rational(least), Rational(most), false}; }
Duration Idling(int least = 0) { return {Rational(least), std::nullopt, true}; }

MachineEdge Send(size_t peer, const std::string& label, size_t to) {
  return {Kind::kSend, RobotId(peer), label, {}, to};
}
MachineEdge Receive(size_t peer, const std::string& label, size_t to) {
  return {Kind::kReceive, RobotId(peer), label, {}, to};
}
MachineEdge Move(Duration duration, size_t to) {
  return {Kind::kMove, {}, "Move()", std::move(duration), to};
}
MachineEdge Choose(size_t to) { return {Kind::kChoose, {}, "", {}, to}; }

Machine Of(std::vector<std::vector<MachineEdge>> states) {
  Machine machine;
  for (auto& edges : states) {
    const bool ends = edges.empty();
    machine.states.push_back({std::move(edges), ends});
  }
  return machine;
}

// One robot sends these labels to the other, one after the other.
Machine Sender(size_t peer, const std::vector<std::string>& labels, bool receives = false) {
  Machine machine;
  for (size_t i = 0; i < labels.size(); ++i) {
    const MachineEdge edge = receives ? Receive(peer, labels[i], i + 1) : Send(peer, labels[i], i + 1);
    machine.states.push_back({{edge}, false});
  }
  machine.states.push_back({{}, true});
  return machine;
}

std::vector<std::string> Labels(const std::vector<Team::Step>& steps) {
  std::vector<std::string> labels;
  for (const Team::Step& s : steps) labels.push_back(s.label);
  return labels;
}

TEST(TickLength, IsHalfOfTheCommonDivisorOfAllDurations) {
  const Ticks ticks({Lasting(4, 6), {Rational(3), std::nullopt, true}});
  EXPECT_EQ(ticks.Least(Lasting(4, 6)), 8);
  EXPECT_EQ(ticks.Most(Lasting(4, 6)), 12);
  EXPECT_EQ(ticks.Least(Idling(3)), 6);
}

TEST(TickLength, DividesFractionsOfSeconds) {
  const Duration half{Rational(1) / Rational(2), Rational(1) / Rational(2), false};
  const Duration third{Rational(1) / Rational(3), Rational(1) / Rational(3), false};
  const Ticks ticks({half, third});
  EXPECT_EQ(ticks.Least(half), 6);
  EXPECT_EQ(ticks.Least(third), 4);
}

TEST(TickLength, AMotionWithoutALongestTimeMayLastForEver) {
  EXPECT_EQ(Ticks({Idling()}).Most(Idling()), Ticks::kForever);
  EXPECT_EQ(Ticks({Idling()}).Least(Idling()), 0);
}

TEST(TickLength, ClocksCountBeyondEveryBound) {
  const Ticks ticks({Lasting(2, 5), Idling(7)});
  EXPECT_GT(ticks.enough(), ticks.Most(Lasting(2, 5)));
  EXPECT_GT(ticks.enough(), ticks.Least(Idling(7)));
}

TEST(TeamOfMachines, AMessageNeedsBothSides) {
  const Team team({Sender(1, {"l"}), Sender(0, {"l"}, true)});
  const auto steps = team.Next(team.Start());
  ASSERT_EQ(Labels(steps), std::vector<std::string>{"0>1:l"});
  EXPECT_FALSE(team.Ended(team.Start()));
  EXPECT_TRUE(team.Ended(steps[0].state));
  EXPECT_TRUE(team.Next(steps[0].state).empty());
}

TEST(TeamOfMachines, AnotherLabelIsNotHeard) {
  const SearchResult found = FindStuck(Team({Sender(1, {"l"}), Sender(0, {"r"}, true)}), 100);
  EXPECT_TRUE(found.stuck);
  EXPECT_TRUE(found.run.empty());
}

TEST(TeamOfMachines, TheRunToWhereNothingHappensIsTold) {
  const SearchResult found = FindStuck(Team({Sender(1, {"l", "m", "n"}), Sender(0, {"l", "m"}, true)}), 100);
  EXPECT_TRUE(found.stuck);
  EXPECT_EQ(found.run, (std::vector<std::string>{"0>1:l", "0>1:m"}));
}

TEST(TeamOfMachines, WhoWaitsForEachOtherIsStuck) {
  EXPECT_TRUE(FindStuck(Team({Sender(1, {"l"}, true), Sender(0, {"l"}, true)}), 100).stuck);
}

TEST(TeamOfMachines, StatesOfASimpleExchangeAreCounted) {
  const SearchResult found = FindStuck(Team({Sender(1, {"l", "m"}), Sender(0, {"l", "m"}, true)}), 100);
  EXPECT_FALSE(found.stuck);
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.states, 3U);
}

TEST(TeamOfMachines, ASearchGivesUpBeyondItsLimit) {
  const SearchResult found = FindStuck(Team({Sender(1, {"l", "m"}), Sender(0, {"l", "m"}, true)}), 0);
  EXPECT_FALSE(found.complete);
}

TEST(TeamOfMachines, ARobotMayChooseAnyAlternative) {
  const Team team({Of({{Choose(1), Choose(2)}, {}, {}})});
  const auto steps = team.Next(team.Start());
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].state[0].at, 1U);
  EXPECT_EQ(steps[1].state[0].at, 2U);
}

TEST(TeamOfMachines, AMotionThatCannotBeInterruptedTakesItsTime) {
  const Team team({Of({{Move(Lasting(1, 1), 1)}, {}})});
  Team::State state = team.Start();
  for (int i = 0; i < 4; ++i) {  // it begins, there are two ticks, it ends
    EXPECT_FALSE(team.Ended(state));
    std::set<Team::State> next;
    for (const Team::Step& step : team.Next(state)) next.insert(step.state);
    ASSERT_EQ(next.size(), 1U);
    state = *next.begin();
  }
  EXPECT_FALSE(state[0].moving);
  EXPECT_TRUE(team.Ended(state));
}

TEST(TeamOfMachines, AMessageDoesNotReachWhoCannotBeInterrupted) {
  const Team team({Of({{Move(Lasting(2, 2), 1)}, {Receive(1, "l", 2)}, {}}),
                   Of({{Move(Idling(), 1)}, {Send(0, "l", 2)}, {}})});
  const SearchResult found = FindStuck(team, 1000);
  EXPECT_FALSE(found.stuck);
  Team::State state = team.Start();
  state[0] = {1, true, 0, 0, 0};
  state[1] = {1, true, 0, 0, 0};
  for (const std::string& label : Labels(team.Next(state))) EXPECT_EQ(label, "");
}

TEST(TeamOfMachines, AMessageEndsAMotionThatCanBeInterrupted) {
  const Team team({Of({{Move(Idling(), 1)}, {Receive(1, "l", 2)}, {}}),
                   Of({{Move(Idling(), 1)}, {Send(0, "l", 2)}, {}})});
  Team::State state = team.Start();
  state[0] = {1, true, 0, 0, 0};
  state[1] = {1, true, 0, 0, 0};
  const auto steps = team.Next(state);
  const auto labels = Labels(steps);
  const auto back = std::ranges::find(labels, "1>0:l");
  ASSERT_NE(back, labels.end());
  EXPECT_TRUE(team.Ended(steps[static_cast<size_t>(back - labels.begin())].state));
}

TEST(TeamOfMachines, AMotionIsNotInterruptedBeforeItsLeastTime) {
  const Team team({Of({{Move(Idling(1), 1)}, {Receive(1, "l", 2)}, {}}),
                   Of({{Move(Idling(), 1)}, {Send(0, "l", 2)}, {}})});
  const auto speaks = [&](int64_t clock) {
    Team::State state = team.Start();
    state[0] = {1, true, 0, 0, clock};
    state[1] = {1, true, 0, 0, clock};
    const auto labels = Labels(team.Next(state));
    return std::ranges::find(labels, "1>0:l") != labels.end();
  };
  EXPECT_FALSE(speaks(0));
  EXPECT_FALSE(speaks(1));
  EXPECT_TRUE(speaks(2));  // two ticks are a second
}

TEST(TeamOfMachines, TimePassesOnlyWhileEverybodyMoves) {
  const Team team({Of({{Move(Lasting(1, 1), 1)}, {}}), Sender(0, {"l"}, true)});
  EXPECT_TRUE(FindStuck(team, 100).stuck);
}

TEST(TracesOfSystems, EqualOnesDoNotDiffer) {
  const auto one = [] { return Team({Sender(1, {"l", "m"}), Sender(0, {"l", "m"}, true)}); };
  EXPECT_TRUE(DifferentTrace(one(), one(), 50).empty());
}

TEST(TracesOfSystems, AShortestDifferenceIsTold) {
  const Team longer({Sender(1, {"l", "m"}), Sender(0, {"l", "m"}, true)});
  const Team shorter({Sender(1, {"l"}), Sender(0, {"l"}, true)});
  EXPECT_EQ(DifferentTrace(longer, shorter, 50),
            (std::vector<std::string>{"0>1:l", "0>1:m", "only the first"}));
  EXPECT_EQ(DifferentTrace(shorter, longer, 50),
            (std::vector<std::string>{"0>1:l", "0>1:m", "only the second"}));
}

TEST(TracesOfSystems, SilentStepsAreNoDifference) {
  const Team direct({Sender(1, {"l"}), Sender(0, {"l"}, true)});
  const Team choosing({Of({{Choose(1)}, {Send(1, "l", 2)}, {}}), Sender(0, {"l"}, true)});
  EXPECT_TRUE(DifferentTrace(direct, choosing, 50).empty());
}

TEST(TracesOfSystems, StatesWithoutAMessageAreReachedSilently) {
  const Team team({Of({{Choose(1), Choose(2)}, {Choose(2)}, {}})});
  EXPECT_EQ(Silently(team, {team.Start()}).size(), 3U);
  EXPECT_TRUE(Heard(team, {team.Start()}).empty());
}

}  // namespace
}  // namespace rondo::choreo
