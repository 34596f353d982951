#include "sim/campaign/scenario_file.h"

#include <gtest/gtest.h>

namespace rondo::sim::campaign {
namespace {

class ScenarioFileTest : public testing::Test {
 protected:
  std::vector<Scenario> Read(const std::string& text) {
    diagnostics_ = {};
    return ReadScenarios(sources_, sources_.Add("x.toml", text), diagnostics_);
  }
  std::string Complaint(const std::string& text) {
    Read(text);
    return diagnostics_.all().empty() ? "" : diagnostics_.all()[0].message;
  }
  diag::SourceSet sources_;
  diag::Diagnostics diagnostics_;
};

TEST_F(ScenarioFileTest, WhatIsWrittenReadsBackAsTheSame) {
  for (uint64_t seed = 1; seed < 300; ++seed) {
    const Scenario s = Draw(seed, 1, 7);
    const std::string text = WriteScenario(s, "a comment\nof two lines");
    const auto read = Read(text);
    ASSERT_TRUE(diagnostics_.all().empty()) << diagnostics_.all()[0].message << "\n" << text;
    ASSERT_EQ(read.size(), 1U);
    EXPECT_EQ(WriteScenario(read[0], "a comment\nof two lines"), text);
    EXPECT_EQ(read[0].seed, s.seed);
    EXPECT_EQ(read[0].on_loss, s.on_loss);
    ASSERT_EQ(read[0].faults.size(), s.faults.size());
    for (size_t i = 0; i < s.faults.size(); ++i) {
      EXPECT_EQ(read[0].faults[i].at, s.faults[i].at);
      EXPECT_EQ(read[0].faults[i].amount, s.faults[i].amount);
    }
  }
}

TEST_F(ScenarioFileTest, EveryMistakeIsNamed) {
  EXPECT_EQ(Complaint(""), "there is no scenario");
  EXPECT_EQ(Complaint("[scenario]\n"), "write `[[scenario]]` for each");
  EXPECT_EQ(Complaint("[[scenario]]\nrobot = 3\n"), "a scenario has no `robot`");
  EXPECT_EQ(Complaint("[[scenario]]\nrobots = 0\n"), "`robots` must lie between 1 and 64");
  EXPECT_EQ(Complaint("[[scenario]]\nrobots = 2.5\n"), "`robots` must be a whole number");
  EXPECT_EQ(Complaint("[[scenario]]\non_loss = \"panic\"\n"), "`on_loss` cannot be this");
  EXPECT_EQ(Complaint("[[scenario]]\nrobots = 2\non_loss = \"evict\"\n"),
            "two robots have no majority without each other, so none can be evicted");
  EXPECT_EQ(Complaint("[[scenario]]\n[[scenario.fault]]\n"), "the fault has no `kind`");
  EXPECT_EQ(Complaint("[[scenario]]\n[[scenario.fault]]\nkind = \"los\"\n"), "`kind` cannot be this");
  EXPECT_EQ(Complaint("[[scenario]]\n[[scenario.fault]]\nkind = \"crash\"\nrobot = 3\n"),
            "`robot` must lie between 0 and 2");
  EXPECT_EQ(Complaint("[[scenario]]\ndisks = 1\n"), "`disks` must be `true` or `false`");
  EXPECT_EQ(Complaint("[[scenario]]\ndelta = 1\n"),
            "`patience` must be at least two rounds (`delta`): robots are silent between rounds");
}

}  // namespace
}  // namespace rondo::sim::campaign
