#include "contracts/statistical.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "contracts/load.h"
#include "contracts/program_report.h"

namespace rondo::contracts {
namespace {

// From 0 to 1, two seconds on: to 2 to 3.
std::string Point(const std::string& limit) {
  return "robot P {\n  state x: number in [-10, 10]\n  dynamics { x' = 1 / 1 s }\n"
         "  motion Go() noninterruptible [2 s, 2 s] { modifies x pre x >= 0 and x <= 1 during x <= " +
         limit + " }\n}\n";
}

Statistical Sampled(const std::string& limit, const StatisticalOptions& options) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) /
      ("statistical-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
       std::to_string(::getpid()) + ".rondo");
  std::ofstream(file) << Point(limit);
  workspace::Session session;
  LoadedContracts loaded;
  EXPECT_TRUE(LoadContracts({file.string()}, "", nullptr, true, session, loaded));
  std::filesystem::remove(file);
  EXPECT_EQ(loaded.results.size(), 1U);
  return loaded.results.empty() ? Statistical() : Sample(loaded.results[0], options, base::StopToken());
}

StatisticalOptions Few() {
  StatisticalOptions options;
  options.runs = 800;
  options.confidence = 0.99;
  options.jobs = 1;
  return options;
}

TEST(StatisticalContracts, WhatNeverFailsHasTheBoundOfRunsWithoutAFailure) {
  const Statistical s = Sampled("4", Few());
  ASSERT_EQ(s.trouble, "");
  EXPECT_EQ(s.failures, 0U);
  EXPECT_GE(s.runs, 800U);
  EXPECT_NEAR(s.epsilon, 1 - std::pow(0.01, 1.0 / static_cast<double>(s.runs)), 1e-6);
  EXPECT_EQ(s.corner_failures, 0U);
  EXPECT_TRUE(s.worst.empty());
}

TEST(StatisticalContracts, TheBoundIsNotBelowTheProbabilityOfAFailure) {
  const Statistical s = Sampled("2.5", Few());  // half of all starts
  EXPECT_GT(s.failures, 0U);
  EXPECT_GE(s.epsilon, 0.5);
  ASSERT_FALSE(s.worst.empty());
  EXPECT_GE(s.worst[0], 0.5);
}

TEST(StatisticalContracts, CornersShowWhatRunsMiss) {
  const Statistical s = Sampled("2.999999", Few());
  EXPECT_EQ(s.corners, 2U);
  EXPECT_EQ(s.corner_failures, 1U);
}

TEST(StatisticalContracts, OneSeedGivesOneResult) {
  StatisticalOptions options = Few();
  const Statistical one = Sampled("2.5", options);
  options.jobs = 2;
  const Statistical two = Sampled("2.5", options);
  EXPECT_EQ(one.failures, two.failures);
  EXPECT_EQ(one.runs, two.runs);
  EXPECT_EQ(one.worst, two.worst);
}

TEST(StatisticalContracts, WhatIsImpossibleHasNoAnswer) {
  ContractResult contract;
  contract.impossible = "no dynamics";
  const Statistical s = Sample(contract, Few(), base::StopToken());
  EXPECT_EQ(s.trouble, "no dynamics");
  EXPECT_EQ(ToJson(contract, s, Few())["verdict"], "unknown");
  EXPECT_EQ(s.epsilon, 1);
}

koord::Report TwoRows() {
  koord::Report report;
  report.rows.push_back({"first",
                         {},
                         {{"initially", {}, verdict::Verdict::kProved, "", {"other"}, 0.25, false},
                          {"Step", 1, verdict::Verdict::kRefuted, "", {}, 0.5, false}},
                         verdict::Verdict::kRefuted,
                         "",
                         {}});
  report.rows.push_back({"second", {}, {}, verdict::Verdict::kProved, "", {}});
  report.basis.assumed = {"sensor"};
  return report;
}

TEST(ProgramReports, AreJsonWithEveryObligation) {
  const nlohmann::json json = ToJson(TwoRows(), diag::SourceSet());
  ASSERT_EQ(json["invariants"].size(), 2U);
  EXPECT_EQ(json["invariants"][0]["name"], "first");
  EXPECT_EQ(json["invariants"][0]["verdict"], "refuted");
  ASSERT_EQ(json["invariants"][0]["obligations"].size(), 2U);
  EXPECT_EQ(json["invariants"][0]["obligations"][0]["used"], nlohmann::json{"other"});
  EXPECT_EQ(json["invariants"][0]["obligations"][1]["case"], "Step");
  EXPECT_EQ(json["invariants"][1]["verdict"], "proved");
  EXPECT_EQ(json["rests_on"]["assumed"], nlohmann::json{"sensor"});
}

TEST(ProgramReports, AreALineForEachInvariant) {
  const std::string table = ProveTable(TwoRows());
  EXPECT_EQ(std::ranges::count(table, '\n'), 2);
  EXPECT_LT(table.find("first"), table.find("second"));
}

TEST(ProgramReports, TheSummaryTellsWhatTheVerdictRestsOn) {
  const std::string text = ProveSummary(TwoRows(), {});
  EXPECT_NE(text.find("refuted: first"), std::string::npos);
  EXPECT_NE(text.find("second"), std::string::npos);
  EXPECT_NE(text.find("assumed: sensor"), std::string::npos);
}

}  // namespace
}  // namespace rondo::contracts
