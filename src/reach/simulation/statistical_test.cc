#include "reach/simulation/statistical.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <random>

#include "reach/simulation/batch.h"

namespace rondo::reach {
namespace {

TEST(Bounds, ClopperAndPearson) {
  EXPECT_EQ(RunsNeeded(0.01, 0.999), 688u);
  EXPECT_EQ(RunsNeeded(0.001, 0.999), 6905u);
  EXPECT_EQ(RunsNeeded(0.001, 0.999999), 13809u);
  EXPECT_NEAR(ClopperPearson(0, 688, 0.999), 0.01, 1e-4);
  // The sum of the binomial tail is what the confidence leaves.
  const double p = ClopperPearson(3, 100, 0.95);
  double tail = 0;
  for (int k = 0; k <= 3; ++k) {
    tail += std::exp(std::lgamma(101) - std::lgamma(k + 1) - std::lgamma(101 - k)) * std::pow(p, k) *
            std::pow(1 - p, 100 - k);
  }
  EXPECT_NEAR(tail, 0.05, 1e-9);
  EXPECT_EQ(ClopperPearson(5, 5, 0.9), 1);
}

class Samples : public testing::Test {
 protected:
  Samples() {
    x_ = arena_.Variable(arena_.Declare("x", {}, arena_.Real()));
    v_ = arena_.Variable(arena_.Declare("v", {}, arena_.Real()));
    problem_.arena = &arena_;
    problem_.states = {x_, v_};
    problem_.rates = {v_, arena_.Neg(x_)};
    problem_.initial = {{-1, 1}, {-1, 1}};
    problem_.assume = arena_.True();
    problem_.horizon = Rational(3);
  }
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }

  expr::Arena arena_;
  TermId x_, v_;
  Problem problem_;
};

TEST_F(Samples, BothWaysToSimulateAgree) {
  problem_.claims = {{"x", arena_.Lt(x_, Num("1.2")), Rational(0), problem_.horizon}};
  auto judge = BatchJudge::Of(problem_);
  auto simulator = SimulatorOf(problem_);
  ASSERT_TRUE(judge.ok() && simulator.ok());
  auto batch = std::move(judge).value();
  auto single = std::move(simulator).value();
  std::mt19937_64 random(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::vector<double>> starts(8, std::vector<double>(2));
    for (auto& s : starts) {
      for (double& c : s) c = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
    }
    bool failed[8];
    batch.Run(starts, 0.01, 300, failed);
    for (size_t i = 0; i < 8; ++i) {
      const auto trace = single->Run(starts[i], 0.01, 300);
      ASSERT_TRUE(trace.ok());
      double most = -9;
      for (size_t k = 0; k <= 300; ++k) most = std::max(most, trace.value()[2 * k]);
      EXPECT_EQ(failed[i], most > 1.2);
    }
  }
}

// The stated bound holds in at least the stated share of repetitions: the true probability is 1/4.
TEST(Coverage, IsAsStated) {
  const interval::Box box{{0, 1}};
  const Judge judge = [](std::span<const std::vector<double>> starts, std::span<bool> failed) {
    for (size_t i = 0; i < starts.size(); ++i) failed[i] = starts[i][0] < 0.25;
    return base::Result<bool>(true);
  };
  int covered = 0;
  for (uint64_t seed = 1; seed <= 200; ++seed) {
    const auto c = Calibrate(std::span(&judge, 1), box, 100, 8, 0.95, seed, base::StopToken());
    ASSERT_TRUE(c.ok());
    covered += c.value().epsilon >= 0.25 ? 1 : 0;
  }
  EXPECT_GE(covered, 184);  // 190 expected; three standard deviations are 9
  EXPECT_LT(covered, 200);
}

TEST_F(Samples, CalibrationDoesNotDependOnThreads) {
  problem_.claims = {{"x", arena_.Lt(x_, Num("1.2")), Rational(0), problem_.horizon}};
  const auto run = [&](size_t threads) {
    std::vector<Judge> judges;
    for (size_t t = 0; t < threads; ++t) {
      auto judge = std::make_shared<BatchJudge>(BatchJudge::Of(problem_).value());
      judges.emplace_back([judge](std::span<const std::vector<double>> starts, std::span<bool> failed) {
        judge->Run(starts, 0.05, 60, failed);
        return base::Result<bool>(true);
      });
    }
    return Calibrate(judges, problem_.initial, 500, 8, 0.99, 9, base::StopToken()).value();
  };
  const Calibration one = run(1);
  const Calibration two = run(2);
  EXPECT_GT(one.failures, 0u);
  EXPECT_EQ(one.failures, two.failures);
  EXPECT_EQ(one.worst, two.worst);
}

TEST_F(Samples, CarefulTubesHoldCornersThatVerseMisses) {
  // x' = -x^3 with a large box: the centre is a bad guide.
  problem_.rates = {arena_.Neg(arena_.Mul(x_, arena_.Mul(x_, x_))), Num("0")};
  auto simulator = SimulatorOf(problem_).value().release();
  const std::unique_ptr<Simulator> owned(simulator);
  LearnOptions options;
  options.steps = 100;
  const auto careful = Learn(*owned, problem_.initial, options);
  options.learning = Learning::kCompat;
  const auto compat = Learn(*owned, problem_.initial, options);
  ASSERT_TRUE(careful.ok() && compat.ok());
  const auto corner = owned->Run(std::vector<double>{1, 1}, options.dt, options.steps);
  EXPECT_TRUE(Inside(careful.value(), corner.value()));
  // A linear system: sensitivities are exact, and every run is inside.
  problem_.rates = {v_, arena_.Neg(x_)};
  const auto linear = SimulatorOf(problem_).value().release();
  const std::unique_ptr<Simulator> second(linear);
  options.learning = Learning::kCareful;
  const auto tube = Learn(*second, problem_.initial, options);
  std::mt19937_64 random(8);
  for (int k = 0; k < 100; ++k) {
    const std::vector<double> start{static_cast<double>(random() >> 11) * 0x1p-52 - 1,
                                    static_cast<double>(random() >> 11) * 0x1p-52 - 1};
    EXPECT_TRUE(Inside(tube.value(), second->Run(start, options.dt, options.steps).value()));
  }
}

TEST(Processes, SpeakLinesOfNumbers) {
  ::signal(SIGPIPE, SIG_IGN);
  // Twice as much in each step.
  auto made = ProcessSimulator(
      "while read n dt x; do echo $x; i=0; while [ $i -lt $n ]; do x=$((x * 2)); echo $x; i=$((i + 1)); "
      "done; done",
      1);
  ASSERT_TRUE(made.ok());
  const auto trace = made.value()->Run(std::vector<double>{2}, 0.5, 3);
  ASSERT_TRUE(trace.ok()) << trace.error().message;
  EXPECT_EQ(trace.value(), (Trace{2, 4, 8, 16}));
  auto silent = ProcessSimulator("exit 0", 1);
  ASSERT_TRUE(silent.ok());
  EXPECT_FALSE(silent.value()->Run(std::vector<double>{2}, 0.5, 3).ok());
  auto words = ProcessSimulator("echo hello", 1);
  EXPECT_FALSE(words.value()->Run(std::vector<double>{2}, 0.5, 3).ok());
}

}  // namespace
}  // namespace rondo::reach
