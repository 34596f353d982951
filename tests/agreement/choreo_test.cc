// Random and all small choreographies: those that are accepted allow the same sequences of messages as a
// whole and as projections that run together, and never get stuck, whatever time motions take; so do
// processes that are typed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <random>

#include "checked.h"
#include "choreo/semantics/search.h"
#include "choreo/semantics/whole.h"
#include "choreo/syntax/format.h"
#include "random_choreographies.h"

namespace rondo::choreo {
namespace {

void ExpectAgreement(const Checked& checked, const std::string& text) {
  const Team team = checked.team();
  const SearchResult found = FindStuck(team, 20'000);
  ASSERT_FALSE(found.stuck) << "stuck behind" << Join(found.run) << "\n" << text;
  ASSERT_EQ(Join(DifferentTrace(Whole(checked.graphs[0]), team, 60)), "") << text;
}

// RONDO_CASES: how many, for a longer search.
uint64_t Seeds() {
  const char* text = std::getenv("RONDO_CASES");
  return text == nullptr ? 20'000 : std::strtoull(text, nullptr, 10);
}

TEST(Choreo, ProjectionsAgreeWithTheWhole) {
  int good = 0;
  int branching = 0;
  for (uint64_t seed = 0; seed < Seeds(); ++seed) {
    const std::string text = RandomChoreography(seed).Whole();
    const Checked checked(text);
    if (!checked.good()) continue;
    ++good;
    branching += text.find("choose") != std::string::npos ? 1 : 0;
    ExpectAgreement(checked, text);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(good, 300);
  EXPECT_GT(branching, 30);
}

// Every sequence of up to four of these steps of two robots, and of up to three of three robots.
TEST(Choreo, AllSmallOnes) {
  const std::string robots =
      "robot R {\n state x : length in [-9 m, 9 m]\n motion Idle() interruptible [0 s, inf) {}\n motion Go() "
      "noninterruptible [1 s, 1 s] {}\n motion Slow() noninterruptible [1 s, 2 s] {}\n}\n";
  const std::vector<std::string> two = {
      "a -> b: l()",
      "b -> a: l()",
      "{ a: Go(), b: Idle() }",
      "{ a: Idle(), b: Idle() }",
      "parallel { thread { a: Go() } thread { b: Idle() } }",
      "parallel { thread { a: Idle() } thread { b: Slow() b: Idle() } }",
      "parallel { thread { a: Go() a: Go() } thread { b: Go() } }",
      "parallel { thread { loop { a: Go() } } thread { b: Idle() } }",
      "choose at a { when a.x > 0 m { a -> b: l() } when a.x <= 0 m { a -> b: r() b -> a: r() } }",
      "while b.x > 0 m { b -> a: l() { a: Go(), b: Idle() } }",
      "loop { a -> b: l() { a: Idle(), b: Go() } b -> a: l() }"};
  const std::vector<std::string> three = {
      "a -> b: l()",
      "b -> c: l()",
      "c -> a: l()",
      "{ a: Go(), b: Idle(), c: Idle() }",
      "{ a: Idle(), b: Idle(), c: Idle() }",
      "parallel { thread { a: Idle() } thread { { b: Go(), c: Idle() } b -> c: l() } }",
      "parallel { thread { a: Go() } thread { b: Idle() } thread { c: Idle() } }",
      "choose at a { when a.x > 0 m { a -> b: l() { a: Idle(), b: Idle(), c: Go() } c -> a: k() } when a.x "
      "<= 0 m { a -> "
      "b: r() a -> c: x() } }"};
  int good = 0;
  const auto all = [&](const std::string& world, const std::vector<std::string>& steps, size_t length) {
    for (const char* option : {"", "option equal_durations\n"}) {
      std::vector<size_t> choice(1);
      while (choice.size() <= length) {
        std::string text = robots + world + "choreography C in W {\n" + option;
        for (const size_t c : choice) text += steps[c] + "\n";
        text += "}\n";
        const Checked checked(text);
        if (checked.good()) {
          ++good;
          ExpectAgreement(checked, text);
          if (testing::Test::HasFatalFailure()) return;
        }
        size_t i = 0;
        while (i < choice.size() && ++choice[i] == steps.size()) choice[i++] = 0;
        if (i == choice.size()) choice.push_back(0);
      }
    }
  };
  all("world W { a: R b: R }\n", two, 4);
  all("world W { a: R b: R c: R }\n", three, 3);
  EXPECT_GT(good, 1000);
}

TEST(Choreo, FormattingKeepsTheTokens) {
  for (uint64_t seed = 0; seed < 500; ++seed) {
    const std::string text = RandomChoreography(seed).Whole();
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    const diag::FileId first = sources.Add("random", text);
    const lang::TokenStream tokens = Tokens(sources, first, diagnostics);
    const std::string once = Format(sources, first, tokens);
    const diag::FileId second = sources.Add("again", once);
    const lang::TokenStream again = Tokens(sources, second, diagnostics);
    ASSERT_EQ(Format(sources, second, again), once) << text;
    const auto same = [](const lang::Token& a, const lang::Token& b) { return a.text == b.text; };
    ASSERT_TRUE(std::ranges::equal(tokens.tokens, again.tokens, same)) << text << once;
  }
}

}  // namespace
}  // namespace rondo::choreo
