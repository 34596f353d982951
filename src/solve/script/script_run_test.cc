#include "solve/script/script_run.h"

#include <gtest/gtest.h>

namespace rondo::solve::script {
namespace {

/// A script, and what became of it.
struct Ran {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  lang::smtlib::Script script;
  ScriptOutcome outcome;

  explicit Ran(const std::string& text, const ScriptOptions& options = {},
               const base::StopToken& stop = base::StopToken()) {
    lang::smtlib::ReadScript(sources, sources.Add("script", text), script, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << text;
    if (!diagnostics.has_errors()) outcome = RunScript(script, options, stop);
  }
  std::vector<AnswerKind> Answers() const {
    std::vector<AnswerKind> answers;
    for (const CheckOutcome& c : outcome.checks) answers.push_back(c.answer);
    return answers;
  }
};

using Kind = AnswerKind;
using Answers = std::vector<AnswerKind>;
const std::string kX = "(declare-const x Real)\n";

TEST(ScriptRun, AnswersEachCheckInTurn) {
  const Ran ran(kX + "(assert (> x 1))(check-sat)(assert (< x 0))(check-sat)");
  EXPECT_EQ(ran.Answers(), (Answers{Kind::kSat, Kind::kUnsat}));
  EXPECT_NE(ran.outcome.text.find("sat\n"), std::string::npos);
  EXPECT_TRUE(ran.outcome.text.ends_with("unsat\n"));
}

TEST(ScriptRun, WithoutAssertionsEverythingIsAllowed) {
  EXPECT_EQ(Ran("(check-sat)").Answers(), Answers{Kind::kSat});
}

TEST(ScriptRun, PopForgetsWhatWasAssertedSincePush) {
  const Ran ran(kX + "(assert (> x 1))(push 1)(assert (< x 0))(check-sat)(pop 1)(check-sat)");
  EXPECT_EQ(ran.Answers(), (Answers{Kind::kUnsat, Kind::kSat}));
}

TEST(ScriptRun, SeveralLevelsArePushedAndPoppedAtOnce) {
  const Ran ran(
      kX + "(push 2)(assert (> x 1))(push 1)(assert (< x 0))(check-sat)(pop 3)(assert (< x 0))(check-sat)");
  EXPECT_EQ(ran.Answers(), (Answers{Kind::kUnsat, Kind::kSat}));
}

TEST(ScriptRun, PopKeepsTheOuterLevels) {
  const Ran ran(kX + "(push 1)(assert (> x 1))(push 1)(pop 1)(assert (< x 0))(check-sat)");
  EXPECT_EQ(ran.Answers(), Answers{Kind::kUnsat});
}

TEST(ScriptRun, ResettingAssertionsForgetsAllOfThem) {
  const Ran ran(kX + "(assert (> x 1))(push 1)(assert (< x 0))(reset-assertions)(check-sat)");
  EXPECT_EQ(ran.Answers(), Answers{Kind::kSat});
}

TEST(ScriptRun, WhatIsAssumedHoldsForOneCheckOnly) {
  const Ran ran("(declare-const b Bool)(assert b)(check-sat-assuming ((not b)))(check-sat)");
  EXPECT_EQ(ran.Answers(), (Answers{Kind::kUnsat, Kind::kSat}));
}

TEST(ScriptRun, EchoPrintsItsText) { EXPECT_EQ(Ran("(echo \"hello\")").outcome.text, "hello\n"); }

TEST(ScriptRun, AModelSatisfiesTheAssertions) {
  const Ran ran(kX + "(assert (= (* 2 x) (- 3)))(check-sat)(get-model)");
  EXPECT_NE(ran.outcome.text.find("(define-fun x () Real (- (/ 3 2)))"), std::string::npos)
      << ran.outcome.text;
}

TEST(ScriptRun, ValuesOfTermsAreComputed) {
  const Ran ran(kX + "(assert (= x 3))(check-sat)(get-value (x (+ x 1)))");
  EXPECT_NE(ran.outcome.text.find("(x 3)"), std::string::npos) << ran.outcome.text;
  EXPECT_NE(ran.outcome.text.find(" 4)"), std::string::npos) << ran.outcome.text;
}

TEST(ScriptRun, WithoutASolutionThereIsNoModel) {
  const Ran ran("(assert false)(check-sat)(get-model)");
  EXPECT_TRUE(ran.outcome.text.starts_with("unsat\n(error"));
  EXPECT_TRUE(ran.outcome.checks[0].model.empty());
}

TEST(ScriptRun, AModelCanBeWantedForEveryCheck) {
  ScriptOptions options;
  options.want_model = true;
  const Ran ran(kX + "(assert (= x 3))(check-sat)(get-model)(assert (= x 4))(check-sat)(get-model)", options);
  const size_t first = ran.outcome.text.find("define-fun");
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(ran.outcome.text.find("define-fun", first + 1), std::string::npos);
  EXPECT_EQ(ran.outcome.text.find("error"), std::string::npos);
}

TEST(ScriptRun, VariablesThatNothingConstrainsHaveSomeValue) {
  const Ran ran(kX + "(declare-const free Bool)(assert (= x 1))(check-sat)");
  ASSERT_EQ(ran.outcome.checks.size(), 1U);
  EXPECT_EQ(ran.outcome.checks[0].model.size(), 2U);
}

TEST(ScriptRun, AStoppedRunAsksNothing) {
  base::StopToken stop;
  stop = stop.WithDeadline(base::StopToken::Clock::now() - std::chrono::seconds(1));
  EXPECT_TRUE(Ran("(check-sat)", {}, stop).outcome.checks.empty());
}

TEST(ScriptRun, QuestionsAreThoseOfTheChecksAtTheirTime) {
  const Ran ran(kX + "(assert (> x 1))(check-sat)(push 1)(assert (< x 5))(check-sat)(pop 1)(check-sat)");
  const std::vector<std::string> questions = Questions(ran.script);
  ASSERT_EQ(questions.size(), 3U);
  EXPECT_EQ(questions[0], questions[2]);
  EXPECT_NE(questions[0], questions[1]);
}

TEST(ScriptRun, APrefixStandsBeforeEachLine) {
  EXPECT_EQ(Prefixed("a\nb\n", "; "), "; a\n; b\n");
  EXPECT_EQ(Prefixed("a\n\nb", "; "), "; a\n; \n; b\n");
  EXPECT_EQ(Prefixed("a\nb", ""), "a\nb");
  EXPECT_EQ(Prefixed("", "; "), "");
}

}  // namespace
}  // namespace rondo::solve::script
