#include "reach/simulation/simulator.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <cmath>

#include "reach/simulation/batch.h"
#include "reach/simulation/statistical.h"

namespace rondo::reach {
namespace {

// x' = v, v' = -x.
class Runs : public testing::Test {
 protected:
  Runs() {
    problem_.arena = &arena_;
    problem_.states = {x_, v_};
    problem_.rates = {v_, arena_.Neg(x_)};
    problem_.initial = {{-1, 1}, {-1, 1}};
    problem_.assume = arena_.True();
    problem_.horizon = Rational(2);
  }
  TermId Num(const char* text) { return arena_.Number(arena_.Real(), *Rational::Parse(text)); }
  TermId Var(const char* name) { return arena_.Variable(arena_.Declare(name, {}, arena_.Real())); }
  Trace TraceOf(std::vector<double> start, double dt, size_t steps, size_t substeps = 1) {
    auto simulator = SimulatorOf(problem_, substeps);
    EXPECT_TRUE(simulator.ok());
    auto trace = simulator.value()->Run(start, dt, steps);
    EXPECT_TRUE(trace.ok());
    return std::move(trace).value();
  }
  // Which of these starts fail the claims.
  std::vector<bool> Failures(const std::vector<std::vector<double>>& starts) {
    auto made = BatchJudge::Of(problem_);
    EXPECT_TRUE(made.ok());
    BatchJudge judge = std::move(made).value();
    std::array<bool, BatchJudge::kLanes> failed{};
    judge.Run(starts, 0.02, 100, std::span(failed).first(starts.size()));
    std::vector<bool> result(failed.begin(), failed.end());
    result.resize(starts.size());
    return result;
  }
  void Claim(TermId formula) { problem_.claims = {{"claim", formula, Rational(0), Rational(2)}}; }

  expr::Arena arena_;
  TermId x_ = Var("x"), v_ = Var("v");
  Problem problem_;
};

TEST_F(Runs, OfTheOscillatorAreCosines) {
  const Trace trace = TraceOf({1, 0}, 0.05, 40);
  ASSERT_EQ(trace.size(), 82u);
  for (size_t k = 0; k <= 40; ++k) {
    EXPECT_NEAR(trace[2 * k], std::cos(0.05 * static_cast<double>(k)), 1e-6);
    EXPECT_NEAR(trace[2 * k + 1], -std::sin(0.05 * static_cast<double>(k)), 1e-6);
  }
}

TEST_F(Runs, AreOfFourthOrder) {
  const auto error = [&](size_t substeps) {
    return std::fabs(TraceOf({1, 0}, 1, 2, substeps)[4] - std::cos(2.0));
  };
  EXPECT_NEAR(std::log2(error(8) / error(16)), 4, 0.5);
}

TEST_F(Runs, BeginWithTheStart) {
  const Trace trace = TraceOf({0.25, -3}, 0.1, 0);
  EXPECT_EQ(trace, (Trace{0.25, -3}));
}

TEST_F(Runs, TakeInputsInTheMiddle) {
  problem_.inputs = {{Var("w"), {1, 3}}};
  problem_.rates = {problem_.inputs[0].term, Num("0")};
  EXPECT_NEAR(TraceOf({0, 0}, 0.5, 2)[4], 2, 1e-12);
}

TEST_F(Runs, AreSampledByTheController) {
  problem_.rates = {v_, Num("0")};
  problem_.controller = Controller{*Rational::Parse("0.5"), {std::nullopt, arena_.Neg(x_)}};
  const Trace trace = TraceOf({1, 5}, 0.75, 2);
  // x halves every half second, along straight lines.
  EXPECT_NEAR(trace[2], 0.375, 1e-12);
  EXPECT_NEAR(trace[4], 0.125, 1e-12);
}

TEST_F(Runs, ThatAreNotFiniteAreErrors) {
  problem_.rates = {arena_.Mul(x_, arena_.Mul(x_, x_)), Num("0")};
  auto simulator = SimulatorOf(problem_);
  ASSERT_TRUE(simulator.ok());
  EXPECT_FALSE(simulator.value()->Run(std::vector<double>{1e6, 0}, 0.1, 20).ok());
}

TEST_F(Runs, AreNotMadeOfModelsWithEvents) {
  problem_.events = {{arena_.Le(x_, Num("0")), {std::nullopt, Num("1")}}};
  EXPECT_FALSE(SimulatorOf(problem_).ok());
}

TEST_F(Runs, InABatchFailExactlyWhereTheClaimDoes) {
  // Along the circle through (a, 0), x never leaves [-a, a].
  Claim(arena_.And(arena_.Le(x_, Num("0.5")), arena_.Le(Num("-0.5"), x_)));
  EXPECT_EQ(Failures({{0.25, 0}, {0.75, 0}, {0, 0.25}, {0, 0.75}}),
            (std::vector<bool>{false, true, false, true}));
}

TEST_F(Runs, InABatchLookAtClaimsInTheirTimeOnly) {
  problem_.claims = {{"late", arena_.Le(x_, Num("0.5")), Rational(1), Rational(2)}};
  // The cosine is 0.54 after a second.
  EXPECT_EQ(Failures({{0.9, 0}, {1, 0}}), (std::vector<bool>{false, true}));
}

TEST_F(Runs, InABatchDoNotFailIfTheStartIsNotAssumed) {
  Claim(arena_.Le(x_, Num("0.5")));
  problem_.assume = arena_.Le(v_, Num("0"));
  EXPECT_EQ(Failures({{1, 1}, {1, 0}}), (std::vector<bool>{false, true}));
}

TEST_F(Runs, InABatchFailWhereATermHasNoValue) {
  Claim(arena_.Le(arena_.Apply(expr::Elementary::kSqrt, {arena_.Add(x_, Num("0.5"))}), Num("2")));
  // 1.5 cos t is below -1/2 after two seconds.
  EXPECT_EQ(Failures({{0.25, 0}, {1.5, 0}}), (std::vector<bool>{false, true}));
}

TEST_F(Runs, InABatchFailIfTheyAreNotFinite) {
  Claim(arena_.True());
  problem_.rates = {arena_.Mul(x_, arena_.Mul(x_, x_)), Num("0")};
  EXPECT_EQ(Failures({{0.1, 0}, {1e6, 0}}), (std::vector<bool>{false, true}));
}

TEST(Libraries, ThatAreNotThereAreErrors) {
  const auto library = LibrarySimulator("/nowhere/robot.so", 2);
  ASSERT_FALSE(library.ok());
  EXPECT_NE(library.error().message.find("/nowhere/robot.so"), std::string::npos);
}

TEST(Libraries, NeedTheFunction) {
  EXPECT_FALSE(LibrarySimulator("/lib/x86_64-linux-gnu/libm.so.6", 2).ok());
}

TEST(Programs, ThatSayTooLittleAreErrors) {
  ::signal(SIGPIPE, SIG_IGN);
  auto simulator = ProcessSimulator("while read line; do echo 1; done", 2);
  ASSERT_TRUE(simulator.ok());
  const auto trace = simulator.value()->Run(std::vector<double>{1, 2}, 0.5, 0);
  ASSERT_FALSE(trace.ok());
  EXPECT_NE(trace.error().message.find("line 1"), std::string::npos);
}

TEST(Programs, AreToldAllDigitsOfTheStart) {
  ::signal(SIGPIPE, SIG_IGN);
  auto simulator = ProcessSimulator("while read steps dt x; do echo $x; done", 1);
  ASSERT_TRUE(simulator.ok());
  const auto trace = simulator.value()->Run(std::vector<double>{0.1 + 0.2}, 0.5, 0);
  ASSERT_TRUE(trace.ok());
  EXPECT_EQ(trace.value(), Trace{0.1 + 0.2});
}

TEST(Tubes, HoldTracesThatStayInsideAtAllInstants) {
  const SampledTube tube{1, {{{0, 2}}, {{1, 3}}}};
  EXPECT_TRUE(Inside(tube, {0.5, 1.5, 2.5}));
  EXPECT_FALSE(Inside(tube, {0.5, 1.5, 3.5}));
  EXPECT_FALSE(Inside(tube, {-0.5, 1.5, 2.5}));
}

}  // namespace
}  // namespace rondo::reach
