#include "koord/semantics/responses.h"

#include <gtest/gtest.h>

#include "koord/check/check.h"
#include "koord/syntax/parser.h"

namespace rondo::koord::semantics {
namespace {

// Two robots; `P` and `Q` are what a robot says.
class ResponsesTest : public testing::Test {
 protected:
  ResponsesTest() {
    const diag::FileId file = sources_.Add(
        "test.koord",
        "allread:\n    bool p[N_sys] = false\nlocal:\n    bool q = false\nGo:\n    eff:\n        q = true\n"
        "response soon: p[pid] within 2 rounds q\nresponse at_once: q within 1 rounds not p[pid]\n");
    Parse(sources_, file, program_, diagnostics_);
    model_ = Check(program_, diagnostics_);
    TeamOptions options;
    options.robots = 2;
    team_ = Team::Make(model_, options, diagnostics_);
    EXPECT_FALSE(diagnostics_.has_errors());
    state_ = team_->blank();
  }
  void Set(const char* name, size_t robot, bool value) {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].name == name) state_[team_->layout().Address(v, robot)] = value ? 1 : 0;
    }
  }

  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
  Program program_;
  Model model_;
  std::unique_ptr<Team> team_;
  std::vector<Word> state_;
};

TEST_F(ResponsesTest, EachRobotMayWaitForSoManyRounds) {
  Responses responses(*team_);
  std::vector<Word> waits(responses.words());
  size_t robot = 9;
  EXPECT_EQ(responses.Observe(state_, waits), -1);
  EXPECT_EQ(waits, std::vector<Word>(responses.words()));
  Set("p", 1, true);
  EXPECT_EQ(responses.Observe(state_, waits), -1);         // it begins to wait
  Set("p", 1, false);                                      // and goes on
  EXPECT_EQ(responses.Observe(state_, waits), -1);         // a round later
  EXPECT_EQ(responses.Observe(state_, waits, &robot), 0);  // two
  EXPECT_EQ(robot, 1U);
  Set("q", 1, true);
  EXPECT_EQ(responses.Observe(state_, waits), -1);
  Set("q", 1, false);
  Set("q", 1, true);
  Set("p", 1, false);
  Set("q", 1, false);
  EXPECT_EQ(responses.Observe(state_, waits), -1);
  EXPECT_EQ(waits, std::vector<Word>(responses.words()));
}

TEST_F(ResponsesTest, WhatFollowsAtOnceNeedsNoWait) {
  Responses responses(*team_);
  std::vector<Word> waits(responses.words());
  Set("p", 0, true);
  Set("q", 0, true);
  EXPECT_EQ(responses.Observe(state_, waits), -1);
  EXPECT_EQ(responses.Observe(state_, waits), 1);  // q, and a round later still p
}

}  // namespace
}  // namespace rondo::koord::semantics
