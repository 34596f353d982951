#include "sim/campaign/campaign.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/file.h"
#include "koord/node/compiled_test.h"
#include "sim/campaign/any_functions.h"

namespace rondo::sim::campaign {
namespace {

using history::Wrong;
using runtime::rounds::OnLoss;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr uint64_t kRuns = 150;
#else
constexpr uint64_t kRuns = 3000;
#endif

uint64_t Runs() {
  const char* cases = std::getenv("RONDO_CASES");
  return cases == nullptr ? kRuns : std::strtoull(cases, nullptr, 10) / 10;
}

class CampaignTest : public testing::Test {
 protected:
  CampaignTest() : program_(base::ReadFile("src/sim/campaign/testdata/fleet.koord").value()) {}
  std::unique_ptr<koord::semantics::Team> Team(size_t robots) {
    auto team = program_.Team(robots);
    functions_.push_back(std::make_unique<AnyFunctions>(*team));
    team->machine().SetHost(functions_.back().get());
    return team;
  }
  Fleet::MakeTeam Make() {
    return [this](size_t robots) { return Team(robots); };
  }
  // A run without faults.
  Outcome Calm(size_t robots, OnLoss on_loss = OnLoss::kWait) {
    Scenario scenario;
    scenario.robots = robots;
    scenario.on_loss = on_loss;
    scenario.rounds = 12;
    return fleet_.Run(scenario);
  }
  std::vector<history::Finding> Judged(const history::Record& record) {
    const auto team = Team(record.robots);
    return history::Judge(*team).Check(record);
  }

  koord::node::Compiled program_;
  std::vector<std::unique_ptr<AnyFunctions>> functions_;
  Fleet fleet_{Make()};
};

TEST_F(CampaignTest, FindsNothing) {
  CampaignOptions options;
  options.runs = Runs();
  const CampaignReport report = Search(fleet_, Make(), options);
  EXPECT_FALSE(report.failure.has_value()) << Story(*report.failure);
  EXPECT_EQ(report.runs, options.runs);
  EXPECT_GT(report.rounds, 10 * options.runs);
}

// With a session that everybody begins anew, 12 rounds of 100 ms take so long and no longer.
TEST_F(CampaignTest, ACalmFleetKeepsTheTime) {
  for (size_t robots = 1; robots <= 5; ++robots) {
    const Outcome outcome = Calm(robots);
    EXPECT_GE(outcome.rounds, 12U);
    EXPECT_LT(outcome.time, 1'500'000'000) << robots;
    EXPECT_EQ(Judged(outcome.record).size(), 0U) << robots;
    EXPECT_TRUE(outcome.stuck.empty()) << outcome.stuck;
  }
}

TEST_F(CampaignTest, APartitionHaltsWaitsOrEvicts) {
  for (const OnLoss on_loss : {OnLoss::kHalt, OnLoss::kWait, OnLoss::kEvict}) {
    Scenario scenario;
    scenario.robots = 3;
    scenario.on_loss = on_loss;
    scenario.rounds = 40;
    scenario.faults = {{FaultKind::kAlone, 1'000'000'000, 2'000'000'000, 2, 0, 0}};
    const Outcome outcome = fleet_.Run(scenario);
    EXPECT_EQ(Judged(outcome.record).size(), 0U);
    EXPECT_EQ(outcome.stuck, "");
    size_t fallbacks = 0, acted_meanwhile = 0;
    for (const history::Entry& e : outcome.record.entries) {
      fallbacks += e.kind == history::Kind::kFellBack ? 1 : 0;
      acted_meanwhile +=
          e.kind == history::Kind::kActed && e.time > 1'600'000'000 && e.time < 3'000'000'000 ? 1 : 0;
    }
    EXPECT_GE(fallbacks, on_loss == OnLoss::kEvict ? 1U : 3U);
    if (on_loss == OnLoss::kEvict)
      EXPECT_GT(acted_meanwhile, 0U);
    else
      EXPECT_EQ(acted_meanwhile, 0U);
    if (on_loss == OnLoss::kHalt)
      EXPECT_LT(outcome.rounds, 15U);
    else
      EXPECT_GE(outcome.rounds, 40U);
  }
}

// Who waits for a function lets rounds go on without it, also where its event is urgent.
TEST_F(CampaignTest, ASlowPlannerIsASkip) {
  Scenario scenario;
  scenario.robots = 3;
  scenario.rounds = 30;
  scenario.faults = {{FaultKind::kPlanner, 0, 2'900'000'000, 1, 0, 0.25}};
  const Outcome slow = fleet_.Run(scenario);
  EXPECT_EQ(Judged(slow.record).size(), 0U);
  EXPECT_EQ(slow.stuck, "");
  EXPECT_LT(slow.time, 3'400'000'000);
  size_t waits = 0;
  for (const history::Entry& e : slow.record.entries) waits += e.waits.empty() ? 0 : 1;
  EXPECT_GT(waits, 3U);
  // Without that word, the judge asks why it did nothing.
  history::Record silent = slow.record;
  for (history::Entry& e : silent.entries) e.waits.clear();
  EXPECT_GT(Judged(silent).size(), 0U);
}

TEST_F(CampaignTest, ASlowRobotSlowsTheFleet) {
  Scenario scenario;
  scenario.robots = 4;
  scenario.faults = {{FaultKind::kSlow, 500'000'000, 1'500'000'000, 2, 0, 0.02}};
  const Outcome outcome = fleet_.Run(scenario);
  EXPECT_EQ(Judged(outcome.record).size(), 0U);
  EXPECT_EQ(outcome.stuck, "");
}

// Nothing that is decided depends on clocks that can be set.
TEST_F(CampaignTest, ClocksOnTheWallMaySayWhatTheyLike) {
  Scenario scenario;
  scenario.faults = {{FaultKind::kCrash, 700'000'000, 500'000'000, 1, 0, 0},
                     {FaultKind::kClock, 0, 2'000'000'000, 0, 0, 0}};
  const Outcome one = fleet_.Run(scenario);
  scenario.faults[1].amount = -3600;
  const Outcome other = fleet_.Run(scenario);
  EXPECT_EQ(one.digest, other.digest);
  bool differs = false;
  for (size_t i = 0; i < one.record.entries.size(); ++i)
    differs = differs || one.record.entries[i].stamp != other.record.entries[i].stamp;
  EXPECT_TRUE(differs);
}

// A robot that can keep nothing must not make the attempts of others come to nothing.
TEST_F(CampaignTest, AFullDiskKeepsNobodyFromGoingOnWhenItIsMended) {
  Scenario scenario;
  scenario.seed = 1'002'141;
  scenario.disks = true;
  scenario.faults = {{FaultKind::kCrash, 762'857'278, 17'309'178, 1, 0, 0},
                     {FaultKind::kDiskFull, 1'626'556'921, 1'430'109'071, 1, 0, 0},
                     {FaultKind::kForget, 1'385'121'860, 455'235'868, 0, 0, 0}};
  const Outcome outcome = fleet_.Run(scenario);
  EXPECT_EQ(outcome.stuck, "");
  EXPECT_EQ(Judged(outcome.record).size(), 0U);
}

// What it says in a round tells how its actuators are since.
TEST_F(CampaignTest, WhoFallsBackSaysWhatItDoesAfterThat) {
  Scenario scenario;
  scenario.seed = 1706;
  scenario.robots = 5;
  scenario.rounds = 20;
  scenario.on_loss = OnLoss::kEvict;
  scenario.disks = true;
  scenario.faults = {{FaultKind::kCut, 176'610'285, 133'061'478, 1, 0, 0},
                     {FaultKind::kCorrupt, 678'126'963, 1'885'853'500, 0, 0, 0.49},
                     {FaultKind::kSlow, 1'537'554'343, 762'331'143, 2, 0, 0.0076},
                     {FaultKind::kDuplicate, 465'489'448, 56'603'575, 0, 0, 0.44}};
  EXPECT_EQ(Judged(fleet_.Run(scenario).record).size(), 0U);
}

// The judge knows nothing of the protocol; it sees what is planted into a good record.
TEST_F(CampaignTest, TheJudgeSeesWhatIsPlanted) {
  const Outcome good = Calm(3);
  ASSERT_EQ(Judged(good.record).size(), 0U);
  const auto planted = [&](const std::function<void(history::Record&, history::Entry&)>& plant,
                           history::Kind kind, uint64_t round) {
    history::Record record = good.record;
    for (history::Entry& entry : record.entries) {
      if (entry.kind != kind || entry.round != round) continue;
      plant(record, entry);
      break;
    }
    std::set<Wrong> wrong;
    for (const auto& finding : Judged(record)) wrong.insert(finding.wrong);
    return wrong;
  };
  using history::Entry;
  using history::Kind;
  using history::Record;
  EXPECT_TRUE(planted([](Record& r, Entry& e) { r.images[e.what].back() ^= 1; }, Kind::kStored, 5)
                  .contains(Wrong::kNoRound));
  EXPECT_TRUE(planted([](Record&, Entry& e) { e.what = 0; }, Kind::kStored, 5).size() > 0);
  EXPECT_TRUE(planted(
                  [](Record& r, Entry& e) {
                    for (Entry& other : r.entries) {
                      if (other.kind == Kind::kStored && other.round == e.round) other.kind = Kind::kStarted;
                    }
                  },
                  Kind::kActed, 5)
                  .contains(Wrong::kTooEarly));
  EXPECT_TRUE(
      planted([](Record&, Entry& e) { e.time = e.until + 1; }, Kind::kActed, 5).contains(Wrong::kTooLate));
  EXPECT_TRUE(
      planted([](Record&, Entry& e) { e.until += 100'000'000; }, Kind::kActed, 5).contains(Wrong::kTooLate));
  EXPECT_TRUE(
      planted([](Record&, Entry& e) { ++e.incarnation; }, Kind::kActed, 5).contains(Wrong::kTwoTeams));
  EXPECT_TRUE(
      planted([](Record&, Entry& e) { e.round = 3; }, Kind::kContributed, 8).contains(Wrong::kWithdrawn));
  EXPECT_TRUE(planted([](Record& r, Entry& e) { r.members[e.what].pop_back(); }, Kind::kAdopted, 0)
                  .contains(Wrong::kDiverged));
  EXPECT_TRUE(
      planted([](Record&, Entry& e) { e.robot = 77; }, Kind::kStored, 5).contains(Wrong::kUnreadable));
  EXPECT_TRUE(planted([](Record& r, Entry& e) { r.images[e.what].pop_back(); }, Kind::kStored, 5)
                  .contains(Wrong::kUnreadable));
}

TEST_F(CampaignTest, TheSameScenarioIsTheSameRun) {
  for (uint64_t seed = 1; seed < 20; ++seed) {
    const Scenario scenario = Draw(seed, 2, 5);
    const Outcome one = fleet_.Run(scenario);
    Fleet other(Make());
    EXPECT_EQ(one.digest, other.Run(scenario).digest) << seed;
  }
  EXPECT_NE(fleet_.Run(Draw(1, 3, 3)).digest, fleet_.Run(Draw(2, 3, 3)).digest);
}

}  // namespace
}  // namespace rondo::sim::campaign
