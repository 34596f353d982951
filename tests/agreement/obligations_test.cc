// The obligations of the published case studies, mended, for the interval solver: what is decided is as it
// should be, and faults are seen.
#include "choreo/obligations/obligations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/file.h"
#include "checked.h"
#include "solve/icp/icp_solver.h"

namespace rondo::choreo {
namespace {

// An example with all that it imports, as one text.
std::string Example(const std::string& name) {
  const std::filesystem::path root = "examples/choreo";
  std::string text = base::ReadFile(root / (name + ".rondo")).value();
  std::string result;
  size_t at = 0;
  while (at < text.size()) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with("import \"")) {
      result += line + "\n";
      continue;
    }
    result += base::ReadFile(root / line.substr(8, line.size() - 9)).value();
  }
  return result;
}

struct Tally {
  std::map<std::string, int> right, wrong, open;
  std::vector<std::string> failures;
};

Tally Decide(const std::string& text, int milliseconds) {
  Checked checked(text);
  EXPECT_TRUE(checked.good());
  Tally tally;
  if (!checked.good()) return tally;
  const Obligations obligations = ObligationsOf(checked.graphs[0], checked.arena);
  for (const Missing& m : obligations.missing) tally.failures.push_back("missing: " + m.what);
  const solve::icp::IcpSolver solver;
  for (const Obligation& o : obligations.all) {
    solve::Query query;
    query.arena = &checked.arena;
    query.assertions = {{o.formula, ""}};
    solve::Budget budget;
    budget.time = std::chrono::milliseconds(milliseconds);
    budget.core = false;
    const solve::Answer answer = solver.Check(query, budget, {});
    const bool unsat = std::holds_alternative<solve::Unsat>(answer);
    const bool sat = std::holds_alternative<solve::Sat>(answer);
    const std::string kind(KindName(o.kind));
    if (o.satisfiable ? sat : unsat) {
      ++tally.right[kind];
    } else if (unsat || sat) {
      ++tally.wrong[kind];
      tally.failures.push_back(kind + ": " + o.title);
    } else {
      ++tally.open[kind];
    }
  }
  return tally;
}

std::string Replace(std::string text, const std::string& from, const std::string& to) {
  size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

constexpr int kSoon = 300;

TEST(Obligations, OfTheLanesAreDecided) {
  const Tally tally = Decide(Example("lanes4"), 5000);
  EXPECT_TRUE(tally.failures.empty()) << tally.failures[0];
  // A body and its hull are given in one frame that turns and goes anywhere: nothing bounds the points yet.
  for (const auto& [kind, count] : tally.open) EXPECT_EQ(kind, "hull") << count;
  for (const char* kind : {"initial", "precondition", "body", "region", "fork", "contract"})
    EXPECT_GE(tally.right.at(kind), 4) << kind;
}

TEST(Obligations, NoneOfFetchIsRefuted) {
  const Tally tally = Decide(Example("fetch"), kSoon);
  EXPECT_TRUE(tally.failures.empty()) << tally.failures[0];
  for (const char* kind : {"assumption", "guarantee", "thread", "total-choice", "precondition"})
    EXPECT_GE(tally.right.at(kind), 1) << kind;
}

TEST(Obligations, FaultsAreSeen) {
  const std::string lanes = Example("lanes4");
  EXPECT_GE(Decide(Replace(lanes, "y < 325 mm", "y < 200 mm"), kSoon).wrong["region"], 1);
  EXPECT_GE(Decide(Replace(lanes, "y < 325 mm", "y < 400 mm"), kSoon).wrong["fork"], 1);
  EXPECT_GE(
      Decide(Replace(lanes, "cart0: MoveCart(0.5 m", "cart0: MoveCart(0.7 m"), kSoon).wrong["precondition"],
      1);
  EXPECT_GE(Decide(Replace(lanes, "at (0, 650 mm, 0)", "at (0, 300 mm, 0)"), kSoon).wrong["initial"], 1);
  EXPECT_GE(
      Decide(Replace(lanes, "inner = 150 mm, outer = 250 mm, bed", "inner = 500 mm, outer = 600 mm, bed"),
             kSoon)
          .wrong["region"],
      1);
  EXPECT_GE(
      Decide(Replace(lanes, "during on_segment((x, y), (x0, y0), (x0, y0) + d * dir(heading), tolerance)",
                     "during x > 1 m and x < 1 m"),
             kSoon)
          .wrong["contract"],
      1);
  EXPECT_GE(
      Decide(Replace(lanes, "hull cylinder(base, 300 mm", "hull cylinder(base, 250 mm"), kSoon).wrong["hull"],
      1);
  const std::string producer = Example("producer");
  EXPECT_GE(Decide(Replace(producer, "when sensor.colour <= 0.5", "when sensor.colour < 0.5"), kSoon)
                .wrong["total-choice"],
            1);
}

// What a sensor said once is no fact any more when time has passed.
TEST(Obligations, InputsChange) {
  const std::string text = R"(
robot R { input gap: length in [0, 2 m]  body sphere(self, 1 cm)  motion Idle() interruptible [0, inf) {}
          motion Go() noninterruptible [1 s, 1 s] { pre gap > 1 m } }
world W { r: R }
choreography C in W { choose at r { when r.gap > 1 m { r: Go() } when r.gap <= 1 m { r: Idle() r: Go() } } }
)";
  EXPECT_EQ(Decide(text, kSoon).wrong["precondition"], 1);
  const std::string later = Replace(text, "{ r: Go() }", "{ r: Idle() r: Go() }");
  EXPECT_EQ(Decide(later, kSoon).wrong["precondition"], 1);
  EXPECT_EQ(Decide(later, kSoon).right["precondition"], 0);
}

// Without bodies and regions nothing can be said, and that is said.
TEST(Obligations, WhatIsMissingIsNamed) {
  Checked checked(Example("shuttle"));
  ASSERT_TRUE(checked.good());
  const Obligations obligations = ObligationsOf(checked.graphs[0], checked.arena);
  const auto lacks = [&](const std::string& what) {
    return std::ranges::any_of(obligations.missing, [&](const Missing& m) { return m.what == what; });
  };
  EXPECT_TRUE(lacks("the body of `Cart`"));
  EXPECT_TRUE(lacks("a region for `red`"));
}

}  // namespace
}  // namespace rondo::choreo
