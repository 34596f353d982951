#include "runs/run_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/file.h"
#include "fixtures/temporary_folder.h"
#include "runs/exploration.h"
#include "runs/replay.h"
#include "runs/witness_search.h"
#include "workspace/koord_files.h"

namespace rondo::runs {
namespace {

namespace fs = std::filesystem;

// Each robot counts to three.
std::string Bounded(int most) {
  return "local:\n    int n = 0\nStep:\n    pre: n < 3\n    eff:\n        n = n + 1\n"
         "invariant small: forall i in ID: n[i] <= " +
         std::to_string(most) + "\n";
}

/// Runs that are kept in a folder of their own.
class RunFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache != nullptr) cache_ = cache;
    ::setenv("XDG_CACHE_HOME", (folder_.path() / "cache").c_str(), 1);
  }
  void TearDown() override {
    cache_ ? ::setenv("XDG_CACHE_HOME", cache_->c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
  }
  std::string Write(const std::string& name, const std::string& text) const {
    return folder_.Write(name, text);
  }
  // A run of two robots that breaks the bound, as its file.
  RunFile Broken() const {
    workspace::Session session;
    const auto koord = workspace::LoadKoordTexts("p", Bounded(1), "", session);
    diag::Diagnostics said;
    const Explored found = Explore(koord->model, 2, {}, said);
    return {Write("p.koord", Bounded(1)), "", 2, found.property, "explore", found.run};
  }
  std::string Saved(const RunFile& run) const {
    const std::string path = folder_.Path("run.json");
    EXPECT_TRUE(SaveRun(path, run).ok());
    return base::ReadFile(path).value();
  }
  static Replayed Again(const std::string& bytes) {
    workspace::Session session;
    return Replay(bytes, session, {});
  }

  fixtures::TemporaryFolder folder_;
  std::optional<std::string> cache_;
};

TEST_F(RunFiles, AreReadBackAsTheyWereWritten) {
  RunFile run = Broken();
  run.params = {{"most", {1, 2}}};
  run.choices = {{"x", {true}}};
  const auto read = ReadRun(Saved(run));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value().program, run.program);
  EXPECT_EQ(read.value().spec, "");
  EXPECT_EQ(read.value().robots, 2U);
  EXPECT_EQ(read.value().property, run.property);
  EXPECT_EQ(read.value().engine, "explore");
  EXPECT_EQ(read.value().steps, run.steps);
  EXPECT_EQ(read.value().params, run.params);
  EXPECT_EQ(read.value().choices, run.choices);
}

TEST_F(RunFiles, EachTruncationIsAnError) {
  const std::string text = Saved(Broken());
  for (size_t size = 0; size + 2 < text.size(); ++size)
    EXPECT_FALSE(ReadRun(text.substr(0, size)).ok()) << size;
}

TEST_F(RunFiles, WithoutATeamOrStepsARunIsNotComplete) {
  const nlohmann::json good = nlohmann::json::parse(Saved(Broken()));
  EXPECT_TRUE(ReadRun(good.dump()).ok());
  const auto with = [&](const char* key, const nlohmann::json& value) {
    nlohmann::json json = good;
    json[key] = value;
    return ReadRun(json.dump()).ok();
  };
  for (const nlohmann::json& robots :
       {nlohmann::json(0), nlohmann::json(65), nlohmann::json(-1), nlohmann::json("2"), nlohmann::json(1.5)})
    EXPECT_FALSE(with("robots", robots)) << robots;
  EXPECT_TRUE(with("robots", 64));
  EXPECT_FALSE(with("steps", nlohmann::json::object()));
  EXPECT_FALSE(with("format", "rondo-run/2"));
  EXPECT_FALSE(ReadRun("[]").ok());
}

TEST_F(RunFiles, ARunThatBreaksAnInvariantReplays) {
  const Replayed again = Again(Saved(Broken()));
  EXPECT_TRUE(again.same) << again.text;
}

TEST_F(RunFiles, ARunWithAnotherNumberDoesNotReplay) {
  RunFile run = Broken();
  std::string steps = run.steps.dump();
  const size_t at = steps.rfind('2');
  ASSERT_NE(at, std::string::npos);
  steps[at] = '3';
  run.steps = nlohmann::json::parse(steps);
  EXPECT_FALSE(Again(Saved(run)).same);
}

TEST_F(RunFiles, ARunWithoutItsLastStepDoesNotReplay) {
  RunFile run = Broken();
  run.steps.erase(run.steps.size() - 1);
  EXPECT_FALSE(Again(Saved(run)).same);
}

TEST_F(RunFiles, ARunOfAnotherTeamOrPropertyDoesNotReplay) {
  RunFile run = Broken();
  run.robots = 3;
  EXPECT_FALSE(Again(Saved(run)).same);
  run.robots = 2;
  run.property = "invariant other";
  EXPECT_FALSE(Again(Saved(run)).same);
  run.property = "deadlock";
  EXPECT_FALSE(Again(Saved(run)).same);
}

TEST_F(RunFiles, ARunDoesNotReplayOnceTheProgramIsMended) {
  const std::string text = Saved(Broken());
  Write("p.koord", Bounded(2));
  EXPECT_FALSE(Again(text).same);
  fs::remove(folder_.path() / "p.koord");
  EXPECT_FALSE(Again(text).same);
}

TEST_F(RunFiles, WhatIsNoRecordDoesNotReplay) {
  for (const std::string text : {"", "{}", "\x89MCAP", "\x89MCAP0\r\n", "[1, 2"})
    EXPECT_FALSE(Again(text).same) << text;
}

TEST_F(RunFiles, DamagedRunsAreRefusedOrReplayedButNeverCrash) {
  const std::string good = Saved(Broken());
  for (size_t i = 0; i < good.size(); i += 1 + good.size() / 150) {
    std::string bad = good;
    bad[i] = bad[i] == '0' ? '9' : '0';
    Again(bad);
  }
}

// What a prover that decides nothing would report.
koord::Report Open(const std::string& name) {
  koord::Report report;
  report.rows.push_back({name, {}, {}, verdict::Verdict::kUnknown, "", {}});
  report.rows.push_back({"definedness", {}, {}, verdict::Verdict::kProved, "", {}});
  return report;
}

TEST_F(RunFiles, AWitnessOfAPlantedFaultIsFoundKeptAndReplayed) {
  workspace::Session session;
  const std::string file = Write("p.koord", Bounded(1));
  const auto koord = workspace::LoadKoord({file, "", true}, session);
  ASSERT_NE(koord, nullptr);
  koord::Report report = Open("small");
  diag::Diagnostics said;
  const auto reached = SearchWitnesses(koord->model, report, {std::nullopt, 1, file, "", {}}, said);
  ASSERT_EQ(reached.size(), 1U);
  EXPECT_TRUE(reached[0].found);
  EXPECT_EQ(report.rows[0].verdict, verdict::Verdict::kRefuted);
  EXPECT_EQ(report.rows[1].verdict, verdict::Verdict::kProved);
  ASSERT_FALSE(reached[0].run.empty());
  EXPECT_TRUE(Again(base::ReadFile(reached[0].run).value()).same);
}

TEST_F(RunFiles, WhereNothingIsWrongNoWitnessIsFound) {
  workspace::Session session;
  const auto koord = workspace::LoadKoordTexts("p", Bounded(3), "", session);
  koord::Report report = Open("small");
  diag::Diagnostics said;
  const auto reached = SearchWitnesses(koord->model, report, {2, std::nullopt, "p.koord", "", {}}, said);
  ASSERT_EQ(reached.size(), 1U);
  EXPECT_FALSE(reached[0].found);
  EXPECT_EQ(report.rows[0].verdict, verdict::Verdict::kUnknown);
  EXPECT_TRUE(said.all().empty());
}

TEST_F(RunFiles, WhatIsProvedIsNotSearched) {
  workspace::Session session;
  const auto koord = workspace::LoadKoordTexts("p", Bounded(1), "", session);
  koord::Report report = Open("small");
  report.rows[0].verdict = verdict::Verdict::kProved;
  diag::Diagnostics said;
  EXPECT_TRUE(SearchWitnesses(koord->model, report, {3, 1, "p.koord", "", {}}, said).empty());
}

}  // namespace
}  // namespace rondo::runs
