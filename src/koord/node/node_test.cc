#include "koord/node/node.h"

#include <gtest/gtest.h>

#include "koord/node/compiled_test.h"
#include "runtime/rounds/merge.h"

namespace rondo::koord::node {
namespace {

using runtime::codec::Bytes;
using runtime::codec::Reader;
using runtime::codec::View;
using runtime::codec::Writer;
using runtime::rounds::Contribution;

constexpr const char* kProgram = R"(
using Motion:
    sensors:
        float x
    actuators:
        float v
allwrite:
    int sum = 0
    List<int> queue
allread:
    int count[N_sys]
local:
    bool done = false
    stream out

Add:
    pre: not done
    eff:
        atomic:
            sum += 1
            queue.append(pid)
        count[pid] += 1
        done = true
        Motion.v = Motion.x
        out << "added " << pid
)";

class Steady : public Sensors {
 public:
  void Read(size_t robot, uint64_t, Cell, std::span<Word> words) override {
    words[0] = semantics::FromFloat(static_cast<double>(robot) + 0.5);
  }
};

Contribution Read(const Bytes& payload) {
  Contribution contribution;
  EXPECT_TRUE(runtime::rounds::Decode(View(payload), contribution));
  return contribution;
}

std::vector<runtime::rounds::Turn> TurnsOf(uint64_t round, const std::vector<uint32_t>& robots,
                                           const std::vector<Contribution>& contributions) {
  std::vector<runtime::rounds::Turn> turns;
  const auto parts = runtime::rounds::PartsOf(runtime::rounds::Exchange::kAllToAll);
  runtime::rounds::Merge(round, *parts.locks, robots, contributions, turns);
  return turns;
}

// A robot of its own heap for each node, as on machines.
class NodeTest : public testing::Test {
 protected:
  NodeTest() {
    for (uint32_t r = 0; r < 3; ++r) {
      teams_.push_back(program_.Team(3));
      nodes_.push_back(std::make_unique<Node>(*teams_.back(), r, &sensors_, 1));
    }
  }
  void Round(uint64_t round) {
    std::vector<Bytes> payloads(3);
    std::vector<Contribution> contributions;
    for (uint32_t r = 0; r < 3; ++r) nodes_[r]->Contribute(round, payloads[r]);
    for (const Bytes& payload : payloads) contributions.push_back(Read(payload));
    const std::vector<uint32_t> robots{0, 1, 2};
    for (const auto& node : nodes_) {
      for (uint32_t r = 0; r < 3; ++r)
        EXPECT_TRUE(node->Accepts(r, contributions[r].inputs, contributions[r].alternatives));
      node->Apply(round, TurnsOf(round, robots, contributions));
    }
  }
  Bytes Store(size_t robot) {
    Bytes bytes;
    nodes_[robot]->Save(bytes);
    return bytes;
  }
  std::string Show(size_t robot, const std::string& name, size_t of = 0) {
    for (size_t v = 0; v < teams_[robot]->model().variables.size(); ++v) {
      if (teams_[robot]->model().variables[v].name == name)
        return teams_[robot]->ShowVariable(nodes_[robot]->state(), v, of);
    }
    return "?";
  }

  Compiled program_{kProgram};
  Steady sensors_;
  std::vector<std::unique_ptr<semantics::Team>> teams_;
  std::vector<std::unique_ptr<Node>> nodes_;
};

TEST_F(NodeTest, AllHaveTheSameStoreAfterEachRound) {
  for (uint64_t round = 0; round < 5; ++round) {
    Round(round);
    EXPECT_EQ(Store(0), Store(1));
    EXPECT_EQ(Store(0), Store(2));
  }
  EXPECT_EQ(Show(1, "sum"), "3");
  EXPECT_EQ(Show(2, "done", 0), "true");
}

TEST_F(NodeTest, OneRobotARoundGetsALock) {
  Round(0);
  Round(1);
  EXPECT_EQ(Show(0, "sum"), "1");
  EXPECT_EQ(Show(0, "queue"), "[1]");  // the order begins with robot 1 in round 1
  EXPECT_EQ(Show(0, "count", 1), "1");
  EXPECT_EQ(Show(0, "count", 0), "0");
}

TEST_F(NodeTest, SensorsAreInTheStoreAndReadInTheRound) {
  Round(0);
  Round(1);
  EXPECT_EQ(Show(0, "Motion.x", 2), "2.5");
  EXPECT_EQ(Show(0, "Motion.v", 1), "1.5");
}

TEST_F(NodeTest, AStoreComesBackInAnotherHeap) {
  for (uint64_t round = 0; round < 4; ++round) Round(round);
  const auto team = program_.Team(3);
  team->heap().Intern(std::vector<Word>{9, 9});  // other handles
  Node other(*team, 0, nullptr, 1);
  ASSERT_TRUE(other.Load(Store(0)));
  Bytes again;
  other.Save(again);
  EXPECT_EQ(again, Store(0));
}

TEST_F(NodeTest, AStoreThatIsCutOrTooLongChangesNothing) {
  for (uint64_t round = 0; round < 3; ++round) Round(round);
  const Bytes good = Store(0);
  const Bytes before = Store(1);
  for (size_t length = 0; length < good.size(); ++length)
    EXPECT_FALSE(nodes_[1]->Load(View(good).first(length))) << length;
  Bytes longer = good;
  longer.push_back(0);
  EXPECT_FALSE(nodes_[1]->Load(longer));
  EXPECT_EQ(Store(1), before);
}

TEST_F(NodeTest, AFrameWritesNoSensorAndItsInputsNothingElse) {
  Bytes cells;
  Writer writer(cells);
  writer.Number(1);
  const Cell sensor = nodes_[0]->cells().sensors()[0];
  const Word half = semantics::FromFloat(0.5);
  nodes_[0]->cells().Encode(sensor, 1, nodes_[0]->state(), std::span(&half, 1), writer);
  const runtime::rounds::Alternative writes_sensor{0, false, cells};
  EXPECT_TRUE(nodes_[0]->Accepts(1, cells, {}));
  Bytes none;
  Writer(none).Number(0);
  EXPECT_TRUE(nodes_[0]->Accepts(1, none, {}));
  EXPECT_FALSE(nodes_[0]->Accepts(1, none, std::span(&writes_sensor, 1)));
  const runtime::rounds::Alternative unknown{77, false, none};
  EXPECT_FALSE(nodes_[0]->Accepts(1, none, std::span(&unknown, 1)));
}

TEST_F(NodeTest, ValuesThatAreNoneAreRefused) {
  const Cells& cells = nodes_[0]->cells();
  Bytes nan;
  Writer writer(nan);
  const Word no_number = semantics::FromFloat(std::numeric_limits<double>::quiet_NaN());
  cells.Encode(cells.sensors()[0], 0, nodes_[0]->state(), std::span(&no_number, 1), writer);
  Reader reader(nan);
  std::vector<Word> words;
  cells.Decode(0, nodes_[0]->state(), reader, words);
  EXPECT_FALSE(reader.ok());
  Bytes nowhere;
  Writer far(nowhere);
  far.Number(3);
  far.Number(12345);
  Reader missing(nowhere);
  cells.Decode(0, nodes_[0]->state(), missing, words);
  EXPECT_FALSE(missing.ok());
}

TEST_F(NodeTest, TellsWhoDidWhatInTheRoundThatWasAppliedLast) {
  Round(0);
  EXPECT_TRUE(nodes_[0]->applied().said.empty());
  Round(1);  // robot 1 gets the lock
  for (uint32_t r = 0; r < 3; ++r) {
    const Applied& applied = nodes_[r]->applied();
    ASSERT_EQ(applied.events.size(), 3U);
    EXPECT_EQ(applied.events[1], 0U);
    EXPECT_FALSE(applied.events[0] || applied.events[2]);
    // What the others offered, and did not get, was neither said nor written.
    EXPECT_EQ(applied.said.size(), r == 1 ? 1U : 0U);
    EXPECT_EQ(applied.written.empty(), r != 1);
  }
  EXPECT_EQ(nodes_[1]->applied().said[0], "added 1");
  ASSERT_TRUE(nodes_[1]->Load(Store(0)));
  EXPECT_TRUE(nodes_[1]->applied().events.empty());
}

TEST_F(NodeTest, WhoeverChoosesMaySkip) {
  for (const auto& node : nodes_)
    node->SetChoose([](uint64_t round, size_t robot, std::span<const semantics::Effect> effects) {
      return round == 0 || robot == 2 ? size_t{0} : effects.size();
    });
  Round(0);
  Round(1);
  EXPECT_EQ(Show(0, "queue"), "[2]");
}

TEST(Node, SaysWhyAnEventIsLeftOut) {
  Compiled program("local:\n    int n = 0\n    int m = 0\nDivide:\n    eff:\n        m = 1 / n\n");
  const auto team = program.Team(1);
  Node node(*team, 0, nullptr, 1);
  Bytes payload;
  node.Contribute(0, payload);
  EXPECT_FALSE(node.failed());
  payload.clear();
  node.Contribute(1, payload);
  ASSERT_TRUE(node.failed());
  EXPECT_EQ(node.failed()->event, 0U);
  EXPECT_EQ(node.failed()->fault, semantics::Fault::kDivision);
  EXPECT_TRUE(Read(payload).alternatives.empty());
}

constexpr const char* kFalling = R"(
using Motion:
    sensors:
        float x
    actuators:
        float v
using Lamp:
    actuators:
        int color
local:
    int n = 0
Go:
    eff:
        n += 1
        Motion.v = 10 + n
        Lamp.color = n
fallback Motion:
    v = x / 2
)";

// A robot that agrees with itself.
class FallbackTest : public testing::Test {
 protected:
  Bytes Contribute(uint64_t round) {
    Bytes payload;
    node_.Contribute(round, payload);
    Read(payload);
    return payload;
  }
  void Apply(uint64_t round, const Bytes& payload) {
    const std::vector<uint32_t> robots{0};
    const std::vector<Contribution> contributions{Read(payload)};
    ASSERT_TRUE(node_.Accepts(0, contributions[0].inputs, contributions[0].alternatives));
    node_.Apply(round, TurnsOf(round, robots, contributions));
  }
  size_t Variable(const std::string& name) const {
    for (size_t v = 0; v < team_->model().variables.size(); ++v) {
      if (team_->model().variables[v].name == name) return v;
    }
    return 0;
  }
  std::string Show(const std::string& name, const std::vector<Word>& state) {
    return team_->ShowVariable(state, Variable(name), 0);
  }
  // The names of the actuators that get something new.
  std::string Act() {
    std::string names;
    for (const Cell cell : node_.Act())
      names += (names.empty() ? "" : " ") + team_->model().variables[cell.variable].name;
    return names;
  }

  Compiled program_{kFalling};
  std::unique_ptr<semantics::Team> team_ = program_.Team(1);
  Steady sensors_;
  Node node_{*team_, 0, &sensors_, 1};
};

TEST_F(FallbackTest, TheTeamLearnsWhatAFallbackSet) {
  Apply(0, Contribute(0));
  EXPECT_EQ(Act(), "Motion.v Lamp.color");
  Apply(1, Contribute(1));
  EXPECT_EQ(Show("Motion.v", node_.state()), "11");
  EXPECT_EQ(Act(), "Motion.v Lamp.color");
  EXPECT_EQ(node_.FallBack(1).size(), 1U);
  EXPECT_EQ(Show("Motion.v", node_.real()), "0.25");
  EXPECT_EQ(Show("Motion.v", node_.state()), "11");  // what the team knows
  node_.SetChoose(
      [](uint64_t, size_t, std::span<const semantics::Effect> effects) { return effects.size(); });
  Apply(2, Contribute(2));
  EXPECT_EQ(Show("Motion.v", node_.state()), "0.25");
  EXPECT_EQ(Act(), "");
  node_.SetChoose(nullptr);
  Apply(3, Contribute(3));
  EXPECT_EQ(Show("Motion.v", node_.state()), "12");
  EXPECT_EQ(Act(), "Motion.v Lamp.color");
  EXPECT_EQ(Act(), "");
}

TEST_F(FallbackTest, WhatWasSaidBeforeReachesNoActuatorWithAFallback) {
  Apply(0, Contribute(0));
  Act();
  const Bytes said = Contribute(1);
  node_.FallBack(1);
  Apply(1, said);
  EXPECT_EQ(Show("n", node_.state()), "1");
  EXPECT_EQ(Show("Motion.v", node_.state()), "11");
  EXPECT_EQ(Act(), "Lamp.color");
  // What is true is told with the next frame; then events count again.
  Apply(2, Contribute(2));
  EXPECT_EQ(Show("Motion.v", node_.state()), "12");
  EXPECT_EQ(Act(), "Motion.v Lamp.color");
}

TEST_F(FallbackTest, ARoundOnWhichNobodyActedIsToldAndLost) {
  Apply(0, Contribute(0));
  Act();
  node_.FallBack(0);
  Apply(1, Contribute(1));  // final too late to act
  EXPECT_EQ(Show("Motion.v", node_.state()), "11");
  node_.SetChoose(
      [](uint64_t, size_t, std::span<const semantics::Effect> effects) { return effects.size(); });
  Apply(2, Contribute(2));
  EXPECT_EQ(Show("Motion.v", node_.state()), "0.25");
  EXPECT_EQ(Act(), "Lamp.color");  // without a fallback it comes late
}

TEST_F(FallbackTest, AnEventThatComesWithTheNewsOverwritesIt) {
  Apply(0, Contribute(0));
  Act();
  node_.FallBack(0);
  Apply(1, Contribute(1));
  EXPECT_EQ(Show("Motion.v", node_.state()), "11");
  EXPECT_EQ(Act(), "Motion.v Lamp.color");
}

TEST_F(FallbackTest, AStoreOfOthersDoesNotUndoIt) {
  Apply(0, Contribute(0));
  Act();
  Apply(1, Contribute(1));
  Act();
  Bytes store;
  node_.Save(store);
  node_.FallBack(1);
  ASSERT_TRUE(node_.Load(store));
  EXPECT_EQ(Act(), "Lamp.color");
  node_.Reset(team_->blank(), 1);  // who has not begun does what the team says
  ASSERT_TRUE(node_.Load(store));
  EXPECT_EQ(Act(), "Motion.v Lamp.color");
}

TEST_F(FallbackTest, FramesMayTellOfNoOtherActuator) {
  const auto accepts = [&](const char* name) {
    Bytes cells;
    Writer writer(cells);
    writer.Number(1);
    const Word zero = 0;
    node_.cells().Encode({static_cast<uint32_t>(Variable(name)), 0}, 0, node_.state(), std::span(&zero, 1),
                         writer);
    return node_.Accepts(0, cells, {});
  };
  EXPECT_TRUE(accepts("Motion.v"));
  EXPECT_FALSE(accepts("Lamp.color"));
  EXPECT_FALSE(accepts("n"));
}

// Its sensors cannot be relied on.
class Blind : public Steady {
 public:
  bool Usable(size_t, uint64_t) override { return false; }
};

TEST(BlindNode, SkipsAndLeavesItsSensorsAsTheyWere) {
  Compiled program(kProgram);
  const auto team = program.Team(1);
  Blind blind;
  Node node(*team, 0, &blind, 1);
  const auto round = [&](uint64_t r) {
    Bytes payload;
    node.Contribute(r, payload);
    const Contribution contribution = Read(payload);
    EXPECT_TRUE(node.Accepts(0, contribution.inputs, contribution.alternatives));
    node.Apply(r, TurnsOf(r, {0}, {contribution}));
    return contribution.alternatives.size();
  };
  round(0);  // nobody skips `init`, and what the sensors said last counts
  EXPECT_FALSE(node.blind());
  const std::vector<Word> before = node.state();
  EXPECT_EQ(round(1), 0U);
  EXPECT_TRUE(node.blind());
  EXPECT_EQ(node.state(), before);
  EXPECT_EQ(node.waits(), std::vector<uint32_t>{0});  // all events are left out
  Steady steady;
  node.SetSensors(&steady);
  EXPECT_EQ(round(2), 1U);
  EXPECT_FALSE(node.blind());
  EXPECT_TRUE(node.waits().empty());
}

TEST(SkippingNode, SaysSo) {
  Compiled program(kProgram);
  const auto team = program.Team(1);
  Steady steady;
  Node node(*team, 0, &steady, 1);
  node.SetChoose([](uint64_t, size_t, std::span<const semantics::Effect> effects) { return effects.size(); });
  Bytes payload;
  node.Contribute(1, payload);
  EXPECT_TRUE(node.skips());
  node.SetChoose({});
  payload.clear();
  node.Contribute(1, payload);
  EXPECT_FALSE(node.skips());
}

}  // namespace
}  // namespace rondo::koord::node
