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

namespace rondo::choreo {
namespace {

// Random choreographies, most of which are not well-formed.
class Texts {
 public:
  explicit Texts(uint64_t seed) : rng_(seed) {}

  std::string Whole() {
    std::string text =
        "robot R {\n state x : length in [-9 m, 9 m]\n motion Idle() interruptible [0 s, inf) {}\n motion "
        "Go() noninterruptible [1 s, 1 s] {}\n motion Slow() noninterruptible [1 s, 2 s] {}\n motion "
        "Rest() interruptible [0 s, 2 s] {}\n motion Mid() interruptible [1 s, 2 s] {}\n}\n"
        "world W { a: R b: R c: R }\nchoreography C in W {\n";
    if (Pick(4) == 0) text += "option equal_durations\n";
    return text + Steps("abc", 3) + "}\n";
  }

 private:
  size_t Pick(size_t n) { return static_cast<size_t>(rng_() % n); }

  std::string Message(const std::string& robots) {
    const size_t from = Pick(robots.size());
    const size_t to = (from + 1 + Pick(robots.size() - 1)) % robots.size();
    return std::string(1, robots[from]) + " -> " + robots[to] + ": l" + std::to_string(Pick(3)) + "()\n";
  }

  std::string Motion(const std::string& robots) {
    const size_t going = Pick(robots.size() + 1);
    std::string text = "{ ";
    for (size_t r = 0; r < robots.size(); ++r)
      text += std::string(r == 0 ? "" : ", ") + robots[r] + ": " +
              (r == going     ? "Go()"
               : Pick(4) == 0 ? Motion()
                              : "Idle()");
    return text + " }\n";
  }

  std::string Motion() {
    static constexpr std::array<const char*, 6> kMotions = {"Idle()", "Idle()", "Go()",
                                                            "Slow()", "Rest()", "Mid()"};
    return kMotions[Pick(kMotions.size())];
  }

  std::string Steps(const std::string& robots, int depth) {
    std::string text;
    const size_t count = 1 + Pick(3);
    for (size_t i = 0; i < count; ++i) text += Step(robots, depth);
    return text;
  }

  std::string Step(const std::string& robots, int depth) {
    if (robots.size() == 1) return robots + ": " + Motion() + "\n";
    switch (depth == 0 ? Pick(2) : Pick(7)) {
      case 0:
      case 1:
        return Message(robots);
      case 2:
        return Motion(robots);
      case 3: {
        const char chooser = robots[Pick(robots.size())];
        std::string text = std::string("choose at ") + chooser + " {\n";
        for (int b = 0; b < 2; ++b) {
          const char other = robots[(robots.find(chooser) + 1 + Pick(robots.size() - 1)) % robots.size()];
          text += std::string("when ") + chooser + ".x > 0 m {\n" + chooser + " -> " + other + ": k" +
                  std::to_string(b) + "()\n" + Steps(robots, depth - 1) + "}\n";
        }
        return text + "}\n";
      }
      case 4: {
        const size_t lone = Pick(robots.size());
        const char last = robots[lone];
        const std::string rest = robots.substr(0, lone) + robots.substr(lone + 1);
        return "parallel {\nthread {\n" + Steps(rest, depth - 1) + "}\nthread {\n" +
               Steps(std::string(1, last), depth - 1) + "}\n}\n";
      }
      case 5:
        return "rec X" + std::to_string(depth) + " {\n" + Steps(robots, depth - 1) + Leave(robots, depth) +
               "}\n";
      default:
        return Message(robots) + Motion(robots);
    }
  }

  // Either round again or on; the others are told by one who knows.
  std::string Leave(const std::string& robots, int depth) {
    const char chooser = robots[Pick(robots.size())];
    std::string again, on;
    for (const char r : robots) {
      if (r == chooser) continue;
      again += std::string(1, chooser) + " -> " + r + ": again()\n";
      on += std::string(1, chooser) + " -> " + r + ": on()\n";
    }
    return std::string("choose at ") + chooser + " {\nwhen " + chooser + ".x > 0 m {\n" + again +
           "continue X" + std::to_string(depth) + " }\nwhen " + chooser + ".x <= 0 m {\n" + on + "}\n}\n";
  }

  std::mt19937_64 rng_;
};

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
    const std::string text = Texts(seed).Whole();
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
    const std::string text = Texts(seed).Whole();
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
