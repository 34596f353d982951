#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "contracts/contract_file.h"
#include "contracts/decide.h"
#include "contracts/file_contracts_test.h"
#include "contracts/ranges.h"
#include "contracts/report.h"
#include "contracts/sweep.h"

namespace rondo::contracts {
namespace {

namespace fs = std::filesystem;
using verdict::Verdict;

// A point that moves by one each second for two seconds, from somewhere between 0 and 1: to 3 at most.
const std::string kPoint = R"(robot P {
  param gain = 1
  state x: number in [-10, 10]
  dynamics { x' = gain / 1 s }
  motion Below4() noninterruptible [2 s, 2 s] { modifies x pre x >= 0 and x <= 1 during x <= 4 }
  motion Below5() noninterruptible [2 s, 2 s] { modifies x pre x >= 0 and x <= 1 during x <= 5 }
  motion Below2() noninterruptible [2 s, 2 s] { modifies x pre x >= 0 and x <= 1 during x <= 2.5 }
  motion Longer() noninterruptible [3 s, 3 s] { modifies x pre x >= 0 and x <= 1 during x <= 5 }
  motion Later() noninterruptible [2 s, 2 s] { modifies x pre x >= 1 and x <= 2 during x <= 3.5 }
  motion FromZero() noninterruptible [2 s, 2 s] { modifies x pre x == 0 during x <= 2.1 }
}
)";

class PointContracts : public FileContracts {
 protected:
  PointContracts() : FileContracts(kPoint) {}
};

TEST_F(PointContracts, AreThoseOfAllMotionsWithoutAChoreography) {
  Load();
  EXPECT_EQ(loaded_.results.size(), 6U);
  EXPECT_TRUE(loaded_.left_out.empty());
}

TEST_F(PointContracts, AreNotBegunAtFirst) {
  Load();
  EXPECT_EQ(Word(loaded_.results[0]), "not begun");
  EXPECT_EQ(VerdictOf(loaded_.results[0]), Verdict::kUnknown);
}

TEST_F(PointContracts, WhatEveryTrajectoryKeepsIsProved) {
  EXPECT_EQ(VerdictOf(Decided("Below4()")), Verdict::kProved);
  EXPECT_EQ(VerdictOf(Decided("Longer()")), Verdict::kProved);
}

TEST_F(PointContracts, WhatSomeTrajectoryBreaksIsRefuted) {
  const ContractResult& result = Decided("Below2()");
  EXPECT_EQ(VerdictOf(result), Verdict::kRefuted);
  const auto& refuted = std::get<reach::Refuted>(*result.outcome);
  EXPECT_GT(refuted.execution.start[0], 0.5);  // from 0.5 it comes to 2.5
  EXPECT_GT(refuted.violation.miss, 0);
}

TEST_F(PointContracts, NothingIsBegunOnceItIsStopped) {
  ContractResult& result = Find("Below4()");
  const base::StopToken stop;
  stop.RequestStop();
  DecideContract(result, {}, stop);
  EXPECT_FALSE(result.outcome);
}

TEST_F(PointContracts, ARefutedOneIsReportedAndAProvedOneIsNot) {
  diag::Diagnostics said;
  ReportContract(Decided("Below4()"), said);
  EXPECT_TRUE(said.all().empty());
  ReportContract(Decided("Below2()"), said);
  ASSERT_EQ(said.all().size(), 1U);
  EXPECT_EQ(said.all()[0].kind, diag::Kind::kReachRefuted);
}

TEST_F(PointContracts, AreJsonWithVerdictAndEndOfTheTube) {
  const nlohmann::json json = ToJson(Decided("Below4()"));
  EXPECT_EQ(json["verdict"], "proved");
  EXPECT_LE(json["final"]["x"][0], 2);
  EXPECT_GE(json["final"]["x"][1], 3);
  EXPECT_EQ(ToJson(Decided("Below2()"))["verdict"], "refuted");
}

TEST_F(PointContracts, AreALineEachInTheTable) {
  Load();
  const std::string table = ContractTable(loaded_.results);
  EXPECT_EQ(std::ranges::count(table, '\n'), 7);
  EXPECT_NE(table.find("not begun"), std::string::npos);
}

TEST_F(PointContracts, AreFoundByName) {
  const auto found = FindContract({{file_}, "", "P: Below5()"}, session_, loaded_);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(found.value()->made.problem.name, "P: Below5()");
}

TEST_F(PointContracts, AnUnknownNameIsAnError) {
  EXPECT_FALSE(FindContract({{file_}, "", "P: Below6()"}, session_, loaded_).ok());
  EXPECT_TRUE(session_.diagnostics.all().empty());
}

TEST_F(PointContracts, AMissingFileIsAnErrorAndOneReport) {
  EXPECT_FALSE(FindContract({{folder_.Path("none.rondo")}, "", "P: Below5()"}, session_, loaded_).ok());
  ASSERT_EQ(session_.diagnostics.all().size(), 1U);
  EXPECT_EQ(session_.diagnostics.all()[0].kind, diag::Kind::kFileUnreadable);
}

TEST(ContractNames, AreReadBackFromJson) {
  const ContractName name{{"/a.rondo", "/b.rondo"}, "", "P: Go()"};
  const nlohmann::json json = ContractToJson("test/1", name);
  EXPECT_TRUE(HasFormat(json, "test/1"));
  EXPECT_FALSE(HasFormat(json, "test/2"));
  const auto back = ContractFromJson(json);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->files, name.files);
  EXPECT_EQ(back->contract, name.contract);
}

TEST(ContractNames, AreNotReadWherePartsAreMissing) {
  const nlohmann::json good = ContractToJson("test/1", {{"/a.rondo"}, "", "P: Go()"});
  for (const char* key : {"files", "spec", "contract"}) {
    nlohmann::json bad = good;
    bad.erase(key);
    EXPECT_FALSE(ContractFromJson(bad)) << key;
    bad[key] = 3;
    EXPECT_FALSE(ContractFromJson(bad)) << key;
  }
  nlohmann::json empty = good;
  empty["files"] = nlohmann::json::array();
  EXPECT_FALSE(ContractFromJson(empty));
  EXPECT_FALSE(ContractFromJson(nlohmann::json::array()));
  EXPECT_FALSE(HasFormat(nlohmann::json(), "test/1"));
}

TEST(RangeTexts, AreTwoNumbersInOrder) {
  const auto range = ReadRange("0.5..4");
  ASSERT_TRUE(range);
  EXPECT_EQ(range->first, expr::Rational(1) / expr::Rational(2));
  EXPECT_EQ(range->second, expr::Rational(4));
  EXPECT_TRUE(ReadRange("1..1"));
  for (const char* text : {"", "1", "..", "1..", "..1", "2..1", "a..b", "1..2..3", "1...2"})
    EXPECT_FALSE(ReadRange(text)) << text;
}

TEST_F(PointContracts, RangesContainWhatTrajectoriesReach) {
  const Ranges ranges = RangesOf(Decided("Below4()"), {"x", "2 * x - 1"}, std::nullopt, 1, base::StopToken());
  ASSERT_EQ(ranges.trouble, "");
  ASSERT_EQ(ranges.all.size(), 2U);
  for (const double x : {0.0, 1.0, 3.0}) {
    EXPECT_TRUE(ranges.all[0].values.Contains(x)) << x;
    EXPECT_TRUE(ranges.all[1].values.Contains(2 * x - 1)) << x;
  }
  EXPECT_LT(ranges.all[0].values.hi, 3.1);
  EXPECT_GT(ranges.all[0].values.lo, -0.1);
}

TEST_F(PointContracts, RangesAreOfTheTimeThatIsAskedFor) {
  const auto second = std::pair(expr::Rational(1), expr::Rational(9));
  const Ranges ranges = RangesOf(Decided("Below4()"), {"x"}, second, 1, base::StopToken());
  ASSERT_EQ(ranges.all.size(), 1U);
  EXPECT_EQ(ranges.all[0].from, 1);
  EXPECT_EQ(ranges.all[0].to, 2);  // it lasts no longer
  EXPECT_TRUE(ranges.all[0].values.Contains(1));
  EXPECT_GT(ranges.all[0].values.lo, 0.9);
}

TEST_F(PointContracts, RangesNeedAProofAndAQuantity) {
  const base::StopToken stop;
  EXPECT_NE(RangesOf(Find("Below4()"), {"x"}, std::nullopt, 1, stop).trouble, "");
  const ContractResult& proved = Decided("Below4()");
  EXPECT_NE(RangesOf(proved, {"nothing"}, std::nullopt, 1, stop).trouble, "");
  const auto late = std::pair(expr::Rational(3), expr::Rational(4));
  EXPECT_NE(RangesOf(proved, {"x"}, late, 1, stop).trouble, "");
}

DecideOptions OneThread() {
  DecideOptions options;
  options.jobs = 1;
  options.certify = false;
  return options;
}

TEST_F(PointContracts, ASweepCoversTheRangeWithoutGaps) {
  const robot::Loose loose{"gain", expr::Rational(0), expr::Rational(2)};
  Load(&loose);
  const Sweep sweep = SweepContract(Find("FromZero()"), "gain", 4, OneThread(), base::StopToken());
  ASSERT_EQ(sweep.trouble, "");
  ASSERT_FALSE(sweep.parts.empty());
  EXPECT_LE(sweep.parts.front().from, 0);
  EXPECT_GE(sweep.parts.back().to, 2);
  for (size_t i = 1; i < sweep.parts.size(); ++i) {
    EXPECT_EQ(sweep.parts[i - 1].to, sweep.parts[i].from);
    EXPECT_LT(sweep.parts[i].from, sweep.parts[i].to);
  }
}

TEST_F(PointContracts, ASweepFindsWhereTheContractBeginsToFail) {
  const robot::Loose loose{"gain", expr::Rational(0), expr::Rational(2)};
  Load(&loose);
  const Sweep sweep = SweepContract(Find("FromZero()"), "gain", 4, OneThread(), base::StopToken());
  EXPECT_EQ(VerdictOf(sweep), Verdict::kRefuted);
  for (const SweepPart& part : sweep.parts) {  // it holds up to 1.05
    if (part.verdict == Verdict::kProved) {
      EXPECT_LE(part.to, 1.05);
    }
    if (part.verdict == Verdict::kRefuted) {
      EXPECT_GT(part.counterexample, 1.05);
      EXPECT_GE(part.counterexample, part.from);
      EXPECT_LE(part.counterexample, part.to);
    }
  }
  ASSERT_EQ(sweep.parts.size(), 2U);
  EXPECT_EQ(sweep.parts[0].verdict, Verdict::kProved);
  EXPECT_NEAR(sweep.parts[0].to, 1, 1e-9);
}

TEST_F(PointContracts, ASweepNeedsTheParameter) {
  const Sweep sweep = SweepContract(Find("FromZero()"), "nothing", 4, OneThread(), base::StopToken());
  EXPECT_NE(sweep.trouble, "");
  EXPECT_EQ(VerdictOf(sweep), Verdict::kUnknown);
  EXPECT_TRUE(ToJson(sweep)["parts"].empty());
}

TEST(SweepVerdicts, AreTheWorstOfAllParts) {
  Sweep sweep;
  EXPECT_EQ(VerdictOf(sweep), Verdict::kUnknown);
  sweep.parts.push_back({0, 1, Verdict::kProved, 0, "", false});
  EXPECT_EQ(VerdictOf(sweep), Verdict::kProved);
  sweep.parts.push_back({1, 2, Verdict::kUnknown, 0, "", false});
  EXPECT_EQ(VerdictOf(sweep), Verdict::kUnknown);
  sweep.parts.push_back({2, 3, Verdict::kRefuted, 2.5, "during", false});
  EXPECT_EQ(VerdictOf(sweep), Verdict::kRefuted);
}

}  // namespace
}  // namespace rondo::contracts
