#include "runs/execution_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "contracts/contract_file.h"
#include "fixtures/temporary_folder.h"
#include "runs/replay.h"

namespace rondo::runs {
namespace {

namespace fs = std::filesystem;

// x grows by u each second, which is between 0 and 1: after t seconds from 1, it is 1 + t at most.
std::string Point(const std::string& limit) {
  return "robot P {\n  state x: number in [-10, 10]\n  input u: number in [0, 1]\n  dynamics { x' = u / 1 s }\n"
         "  motion Go() noninterruptible [2 s, 2 s] {\n    modifies x\n    pre x >= 0 and x <= 1\n"
         "    during x <= " +
         limit + "\n    control { }\n  }\n}\n";
}

/// A trajectory that breaks `x <= 2`, in a folder of its own.
class ExecutionFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_.Write("p.rondo", Point("2"));
    // The start has one value for each state of the problem: x and, where there is one, the clock.
    workspace::Session session;
    contracts::LoadedContracts loaded;
    const auto found = contracts::FindContract({{Program()}, "", "P: Go()"}, session, loaded);
    ASSERT_TRUE(found.ok());
    const reach::Problem& problem = found.value()->made.problem;
    file_ = {{Program()}, "", "P: Go()", "during", {{}, {}, 3}, 1.5};
    for (const interval::Interval& side : problem.initial) file_.execution.start.push_back(side.hi);
    file_.execution.inputs = {std::vector<double>(problem.inputs.size(), 1.0)};
  }
  std::string Program() const { return folder_.Path("p.rondo"); }
  std::string Saved(const ExecutionFile& file) const {
    const std::string path = folder_.Path("run.json");
    EXPECT_TRUE(SaveExecution(path, file).ok());
    return base::ReadFile(path).value();
  }
  static bool Replays(const ExecutionFile& file) {
    workspace::Session session;
    return ReplayExecution(file, session).ok();
  }

  fixtures::TemporaryFolder folder_;
  ExecutionFile file_;
};

TEST_F(ExecutionFiles, AreReadBackAsTheyWereWritten) {
  const std::string text = Saved(file_);
  EXPECT_TRUE(IsExecution(text));
  const auto read = ReadExecution(text);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value().files, file_.files);
  EXPECT_EQ(read.value().contract, file_.contract);
  EXPECT_EQ(read.value().claim, file_.claim);
  EXPECT_EQ(read.value().time, file_.time);
  EXPECT_EQ(read.value().execution.start, file_.execution.start);
  EXPECT_EQ(read.value().execution.inputs, file_.execution.inputs);
  EXPECT_EQ(read.value().execution.input_period, file_.execution.input_period);
}

TEST_F(ExecutionFiles, EachTruncationIsAnError) {
  const std::string text = Saved(file_);
  for (size_t size = 0; size + 2 < text.size(); ++size) {
    EXPECT_FALSE(IsExecution(text.substr(0, size))) << size;
    EXPECT_FALSE(ReadExecution(text.substr(0, size)).ok()) << size;
  }
}

TEST_F(ExecutionFiles, WithoutAPartTheRunIsNotComplete) {
  const nlohmann::json good = nlohmann::json::parse(Saved(file_));
  for (const char* key : {"files", "spec", "contract", "breaks", "time", "start", "inputs", "input_period"}) {
    nlohmann::json bad = good;
    bad.erase(key);
    EXPECT_FALSE(ReadExecution(bad.dump()).ok()) << key;
    bad[key] = true;
    EXPECT_FALSE(ReadExecution(bad.dump()).ok()) << key;
  }
}

TEST_F(ExecutionFiles, APeriodOfInputsIsPositive) {
  nlohmann::json bad = nlohmann::json::parse(Saved(file_));
  for (const double period : {0.0, -1.0}) {
    bad["input_period"] = period;
    EXPECT_FALSE(ReadExecution(bad.dump()).ok()) << period;
  }
}

TEST_F(ExecutionFiles, ATrajectoryThatBreaksItsContractReplays) {
  EXPECT_TRUE(Replays(file_));
  workspace::Session session;
  EXPECT_TRUE(Replay(Saved(file_), session, {}).same);
}

TEST_F(ExecutionFiles, AStartThatDoesNotBreakItDoesNotReplay) {
  file_.execution.start[0] = 0;  // to 1.5 by then
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, AStartOutsideOfTheContractDoesNotReplay) {
  file_.execution.start[0] = 1.5;
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, InputsOutsideOfTheirBoundsDoNotReplay) {
  ASSERT_FALSE(file_.execution.inputs[0].empty());
  file_.execution.inputs[0][0] = 1.5;
  EXPECT_FALSE(Replays(file_));
  file_.execution.inputs[0][0] = 0;  // it stays where it is
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, ATimeBeforeTheViolationDoesNotReplay) {
  file_.time = 0.5;  // there x is 1.5
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, ATimeBeyondTheContractDoesNotReplay) {
  file_.time = 2.5;
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, TooManyOrTooFewNumbersDoNotReplay) {
  ExecutionFile more = file_;
  more.execution.start.push_back(0);
  EXPECT_FALSE(Replays(more));
  file_.execution.start.clear();
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, AnotherClaimOrContractDoesNotReplay) {
  ExecutionFile other = file_;
  other.claim = "nothing";
  EXPECT_FALSE(Replays(other));
  file_.contract = "P: Stay()";
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, AMendedContractDoesNotReplay) {
  folder_.Write("p.rondo", Point("3.5"));
  EXPECT_FALSE(Replays(file_));
}

TEST_F(ExecutionFiles, AFileThatIsGoneDoesNotReplay) {
  fs::remove(folder_.path() / "p.rondo");
  workspace::Session session;
  EXPECT_FALSE(ReplayExecution(file_, session).ok());
  ASSERT_EQ(session.diagnostics.all().size(), 1U);
  EXPECT_EQ(session.diagnostics.all()[0].kind, diag::Kind::kFileUnreadable);
}

}  // namespace
}  // namespace rondo::runs
