#include "history/explain.h"

#include <gtest/gtest.h>

#include "history/record.h"
#include "koord/node/compiled_test.h"

namespace rondo::history {
namespace {

using koord::semantics::ToInt;

constexpr const char* kProgram = R"(
using Motion:
    sensors:
        int level
allwrite:
    int a = 0
    int b = 0
allread:
    int cell[N_sys]

Both:
    pre: Motion.level == 0
    eff:
        a = pid + 1
        b = pid + 1
Lock:
    pre: Motion.level == 1
    eff:
        atomic:
            cell[pid] = 1
Must:
    pre urgent: Motion.level == 2
    eff:
        cell[pid] = 2
MustLock:
    pre urgent: Motion.level == 3
    eff:
        atomic:
            cell[pid] = 3
)";

class ExplainTest : public testing::Test {
 protected:
  ExplainTest() : team_(program_.Team(3)), explainer_(*team_), before_(team_->blank()) {}
  uint32_t Address(const std::string& name, size_t robot = 0) const {
    for (size_t v = 0; v < team_->model().variables.size(); ++v) {
      if (team_->model().variables[v].name == name) return team_->layout().Address(v, robot);
    }
    ADD_FAILURE() << name;
    return 0;
  }
  // The state at the end: levels of the sensors, a, b, cells.
  bool Explains(std::vector<Word> levels, Word a, Word b, std::vector<Word> cells,
                std::vector<bool> may_skip = {false, false, false}) {
    std::vector<Word> after = before_;
    for (size_t r = 0; r < 3; ++r) {
      after[Address("Motion.level", r)] = levels[r];
      after[Address("cell", r)] = cells[r];
    }
    after[Address("a")] = a;
    after[Address("b")] = b;
    return explainer_.Explain(before_, after, false, may_skip).has_value();
  }

  koord::node::Compiled program_{kProgram};
  std::unique_ptr<koord::semantics::Team> team_;
  Explainer explainer_;
  std::vector<Word> before_;
};

TEST_F(ExplainTest, OneOrderExplainsAllVariables) {
  EXPECT_TRUE(Explains({0, 0, 0}, 2, 2, {0, 0, 0}));
  EXPECT_TRUE(Explains({0, 0, 0}, 0, 0, {0, 0, 0}));  // everybody skips
  EXPECT_FALSE(Explains({0, 0, 0}, 1, 2, {0, 0, 0}));
  EXPECT_FALSE(Explains({0, 0, 0}, 4, 4, {0, 0, 0}));  // nobody writes that
  EXPECT_FALSE(Explains({9, 0, 0}, 1, 1, {0, 0, 0}));  // robot 0 saw something else
}

TEST_F(ExplainTest, ALockHasOneHolder) {
  EXPECT_TRUE(Explains({1, 1, 1}, 0, 0, {0, 1, 0}));
  EXPECT_FALSE(Explains({1, 1, 1}, 0, 0, {1, 1, 0}));
}

TEST_F(ExplainTest, WhatIsUrgentIsDone) {
  EXPECT_TRUE(Explains({2, 2, 9}, 0, 0, {2, 2, 0}));
  EXPECT_FALSE(Explains({2, 2, 9}, 0, 0, {2, 0, 0}));
  EXPECT_TRUE(Explains({2, 2, 9}, 0, 0, {2, 0, 0}, {false, true, false}));  // it took no part
}

TEST_F(ExplainTest, AnUrgentLockThatAnotherHoldsExcuses) {
  EXPECT_TRUE(Explains({3, 3, 3}, 0, 0, {0, 0, 3}));
  EXPECT_FALSE(Explains({3, 3, 3}, 0, 0, {0, 0, 0}));
}

TEST_F(ExplainTest, NobodyWritesForOthers) {
  EXPECT_FALSE(Explains({9, 1, 9}, 0, 0, {1, 0, 0}));
  EXPECT_FALSE(Explains({9, 9, 9}, 0, 0, {0, 0, 5}));
}

TEST(Image, AStateComesBackInAnotherHeap) {
  koord::node::Compiled program(
      "allwrite:\n    List<List<int>> rows\n    string name = \"x\"\nlocal:\n    bool done = false\n\nDo:\n    eff:\n"
      "        rows.append([1, 2])\n        rows.append([3])\n        name = \"hello\"\n        done = true\n");
  const auto one = program.Team(2);
  const auto two = program.Team(2);
  two->heap().InternText("something else");
  std::vector<Word> state = one->blank();
  one->machine().SetMemory(state.data());
  ASSERT_TRUE(one->machine().Run(one->events()[0].body, 1, false));
  const Image image = ImageOf(*one, state);
  const std::vector<Word> back = StateOf(*two, image);
  ASSERT_FALSE(back.empty());
  EXPECT_EQ(ImageOf(*two, back), image);
  for (size_t v = 0; v < 3; ++v) EXPECT_EQ(one->ShowVariable(state, v, 1), two->ShowVariable(back, v, 1));
  for (size_t length = 0; length < image.size(); ++length)
    EXPECT_TRUE(StateOf(*two, std::span(image).first(length)).empty()) << length;
}

TEST(Explain, WhatAFallbackSetBecomesPartOfTheState) {
  koord::node::Compiled program(
      "using M:\n    sensors:\n        int at\n    actuators:\n        int to\n"
      "using Lamp:\n    actuators:\n        int color\n"
      "Go:\n    pre: M.at == 1\n    eff:\n        M.to = 5\n"
      "fallback M:\n    to = at\n");
  const auto team = program.Team(1);
  Explainer explainer(*team);
  std::vector<Word> before = team->blank();
  const auto address = [&](const std::string& name) {
    for (size_t v = 0; v < team->model().variables.size(); ++v) {
      if (team->model().variables[v].name == name) return team->layout().Address(v, 0);
    }
    ADD_FAILURE() << name;
    return 0U;
  };
  const auto explains = [&](Word at, Word to, Word color, const std::vector<std::vector<Word>>& fallen) {
    std::vector<Word> after = before;
    after[address("M.at")] = at;
    after[address("M.to")] = to;
    after[address("Lamp.color")] = color;
    return explainer.Explain(before, after, false, {false}, fallen).has_value();
  };
  std::vector<Word> fell = before;
  fell[address("M.to")] = 3;
  fell[address("Lamp.color")] = 3;
  EXPECT_FALSE(explains(0, 3, 0, {}));
  EXPECT_FALSE(explains(0, 3, 0, {{}}));
  EXPECT_TRUE(explains(0, 3, 0, {fell}));
  EXPECT_TRUE(explains(0, 0, 0, {fell}));   // not yet
  EXPECT_TRUE(explains(1, 5, 0, {fell}));   // an event writes over it
  EXPECT_FALSE(explains(0, 4, 0, {fell}));  // something else
  EXPECT_FALSE(explains(0, 3, 3, {fell}));  // Lamp has no fallback
}

}  // namespace
}  // namespace rondo::history
