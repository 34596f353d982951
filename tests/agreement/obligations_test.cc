// The obligations of the published case studies, mended, for the interval solver: what is decided is as it
// should be, and faults are seen.
#include "choreo/obligations/obligations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>

#include "base/file.h"
#include "checked.h"
#include "choreo/infer/regions.h"
#include "choreo/prove/sampler.h"
#include "robot/contact/contact.h"
#include "verdict/verdict.h"

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

Limits Soon(int milliseconds) {
  Limits limits;
  limits.time = std::chrono::milliseconds(milliseconds);
  limits.certificates = false;
  return limits;
}

Tally Count(const std::string& text, int milliseconds) {
  Checked checked(text);
  EXPECT_TRUE(checked.good());
  Tally tally;
  if (!checked.good()) return tally;
  const Obligations obligations = ObligationsOf(checked.graphs[0], checked.arena);
  for (const Missing& m : obligations.missing) tally.failures.push_back("missing: " + m.what);
  for (const Obligation& o : obligations.all) {
    if (!IsRequired(o.kind)) continue;
    const Decision d = Decide(o, *checked.graphs[0].world, checked.arena, {}, Soon(milliseconds), {});
    const std::string kind(KindName(o.kind));
    (d.verdict == verdict::Verdict::kProved    ? tally.right
     : d.verdict == verdict::Verdict::kRefuted ? tally.wrong
                                               : tally.open)[kind] += 1;
    if (d.verdict == verdict::Verdict::kRefuted) tally.failures.push_back(kind + ": " + o.title);
  }
  return tally;
}

std::string Replace(std::string text, const std::string& from, const std::string& to) {
  size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  for (; at != std::string::npos; at = text.find(from, at + to.size())) text.replace(at, from.size(), to);
  return text;
}

constexpr int kSoon = 1000;

TEST(Obligations, OfTheLanesAreDecided) {
  const Tally tally = Count(Example("lanes4"), 20'000);
  EXPECT_TRUE(tally.failures.empty()) << tally.failures[0];
  EXPECT_TRUE(tally.open.empty()) << tally.open.begin()->first;
  for (const char* kind : {"initial", "precondition", "region", "fork", "contract", "hull"})
    EXPECT_GE(tally.right.at(kind), 4) << kind;
}

TEST(Obligations, OfFetchAreDecided) {
  const Tally tally = Count(Example("fetch"), 20'000);
  EXPECT_TRUE(tally.failures.empty()) << tally.failures[0];
  EXPECT_TRUE(tally.open.empty()) << tally.open.begin()->first;
  for (const char* kind : {"assumption", "guarantee", "thread", "total-choice", "precondition"})
    EXPECT_GE(tally.right.at(kind), 1) << kind;
}

TEST(Obligations, FaultsAreSeen) {
  const std::string lanes = Example("lanes4");
  EXPECT_GE(Count(Replace(lanes, "y < 325 mm", "y < 200 mm"), kSoon).wrong["region"], 1);
  EXPECT_GE(Count(Replace(lanes, "y < 325 mm", "y < 400 mm"), kSoon).wrong["fork"], 1);
  EXPECT_GE(
      Count(Replace(lanes, "cart0: MoveCart(0.5 m", "cart0: MoveCart(0.7 m"), kSoon).wrong["precondition"],
      1);
  EXPECT_GE(Count(Replace(lanes, "at (0, 650 mm, 0)", "at (0, 300 mm, 0)"), kSoon).wrong["initial"], 1);
  EXPECT_GE(
      Count(Replace(lanes, "inner = 150 mm, outer = 250 mm, bed", "inner = 500 mm, outer = 600 mm, bed"),
            kSoon)
          .wrong["region"],
      1);
  EXPECT_GE(
      Count(Replace(lanes, "during on_segment((x, y), (x0, y0), (x0, y0) + d * dir(heading), tolerance)",
                    "during x > 1 m and x < 1 m"),
            kSoon)
          .wrong["contract"],
      1);
  EXPECT_GE(
      Count(Replace(lanes, "hull cylinder(base, 300 mm", "hull cylinder(base, 250 mm"), kSoon).wrong["hull"],
      1);
  const std::string producer = Example("producer");
  EXPECT_GE(Count(Replace(producer, "when sensor.colour <= 0.5", "when sensor.colour < 0.5"), kSoon)
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
  EXPECT_GE(Count(text, kSoon).wrong["precondition"], 1);
  const std::string later = Replace(text, "{ r: Go() }", "{ r: Idle() r: Go() }");
  EXPECT_GE(Count(later, kSoon).wrong["precondition"], 1);
  EXPECT_EQ(Count(later, kSoon).right["precondition"], 0);
}

// What was found by trying to fool it: each of these was proved once.
TEST(Obligations, NothingIsProvedByMistake) {
  const std::string ball = R"(
robot B { state x: length in [-5 m, 5 m]  input g: length in [-5 m, 5 m]
  body sphere(self * translate(x, 0, 0), 20 cm)
  motion Idle() interruptible [0 s, inf) {}
  motion Any() noninterruptible [2 s, 2 s] { modifies x }
  motion Stay() noninterruptible [2 s, 2 s] {}
  motion Copy() noninterruptible [2 s, 2 s] { modifies x post x == g }
  motion Need() interruptible [0 s, inf) { pre x == g }
  motion Far() noninterruptible [2 s, 2 s] { modifies x during x >= 3 m }
  motion Roll(f: length, t: length) noninterruptible [2 s, 2 s] {
    modifies x  pre near(x, f, 1 cm)  during between(x, f, t, 1 cm)  post x == t } }
)";
  const auto wrong = [&](const std::string& rest, const std::string& kind) {
    const Tally tally = Count(ball + rest, kSoon);
    const auto it = tally.wrong.find(kind);
    return it != tally.wrong.end() && it->second > 0;
  };
  // Undefined terms hold nowhere.
  EXPECT_TRUE(wrong(R"(world W { a: B b: B } choreography C in W { initially a.x == -3 m and b.x == -1 m
    parallel { thread region sqrt(x / 1 m) < 1 { a: Roll(-3 m, -1 m) a: Idle() }
               thread region sqrt(x / 1 m) > 2 { b: Roll(-1 m, -3 m) } } b -> a: go() })",
                    "region"));
  EXPECT_TRUE(wrong(R"(world W { a: B b: B at (0, 3 m, 0) } choreography C in W { choose at a {
    when asin(a.x / 1 m) > 0 { a -> b: l() } when asin(a.x / 1 m) <= 0 { a -> b: r() } } })",
                    "total-choice"));
  // A body that is nowhere.
  EXPECT_TRUE(wrong(R"(robot N { body sphere(self, 1 m * sqrt(-1)) motion Idle() interruptible [0 s, inf) {} }
    world W { a: N b: N } choreography C in W { { a: Idle(), b: Idle() } })",
                    "body"));
  // What nothing can promise.
  EXPECT_TRUE(wrong(R"(world W { a: B b: B } choreography C in W { initially a.x >= -3 m and b.x == -4 m
    a -> b: tell(p: length | p == a.x and p >= 1 m) { b: Roll(-4 m, 0), a: Idle() } })",
                    "message"));
  // What is known of robots of other threads is true for a moment.
  EXPECT_TRUE(wrong(R"(world W { b: B at (0, 3 m, 0) a: B(g = b.x) } choreography C in W {
    parallel { thread region y < 1 m { a: Copy() a: Stay() a: Need() } thread region y > 1 m { b: Any() b: Idle() } } })",
                    "precondition"));
  // A motion that nobody could begin here.
  EXPECT_TRUE(wrong(R"(world W { b: B obstacle wall: box(world, (1 m, -9 m, -9 m), (2 m, 9 m, 9 m)) }
    choreography C in W { initially b.x == 0 b: Far() })",
                    "keeping"));
}

// Of many robots only those are compared that are near each other, and they are.
TEST(Obligations, BroadPhaseLeavesNeighbours) {
  std::string world = "world W {", steps, state;
  for (int i = 0; i < 8; ++i) {
    world += "r" + std::to_string(i) + ": B at (" + std::to_string(i) + " m, 0, 0) ";
    steps += (i > 0 ? ", r" : "r") + std::to_string(i) + ": Idle()";
    state += (i > 0 ? " and r" : "r") + std::to_string(i) + ".x == " + (i == 5 ? "-0.7 m" : "0");
  }
  const std::string robot =
      "robot B { state x: length in [-5 m, 5 m] body sphere(self * translate(x, 0, 0), 20 cm) "
      "motion Idle() interruptible [0 s, inf) {} }\n";
  const Tally tally =
      Count(robot + world + "}\nchoreography C in W { initially " + state + " { " + steps + " } }", kSoon);
  EXPECT_EQ(tally.wrong.at("initial"), 1);  // r4 and r5
  EXPECT_EQ(tally.wrong.at("collision"), 1);
  EXPECT_TRUE(tally.open.empty());
}

// For what was proved, states at random within the contracts show nothing else.
TEST(Obligations, SamplesFindNoContact) {
  for (const char* name : {"handover", "twist", "underpass", "sorting", "shuttle", "first"}) {
    Checked checked(Example(name));
    ASSERT_TRUE(checked.good()) << name;
    InferOptions infer;
    InferRegions(checked.graphs[0], checked.arena, infer);
    const Obligations obligations = ObligationsOf(checked.graphs[0], checked.arena);
    std::mt19937_64 random(5);
    const char* more = std::getenv("RONDO_CASES");
    const int rounds = more != nullptr ? std::atoi(more) / 1000 : 15;
    int contacts = 0, drawn = 0;
    for (const Obligation& o : obligations.all) {
      if (!o.meeting || o.meeting->shapes.size() != 2) continue;
      const Sampler sampler(checked.arena, o.meeting->configuration);
      for (int k = 0; k < rounds; ++k) {
        const auto state = sampler.Draw(random, 30);
        if (!state) continue;
        ++drawn;
        const auto contact =
            robot::FindContact(checked.arena, o.meeting->shapes[0], o.meeting->shapes[1], *state);
        contacts += contact && contact->touches ? 1 : 0;
      }
    }
    EXPECT_EQ(contacts, 0) << name;
    EXPECT_GT(drawn, 20) << name;
  }
}

// Without bodies and regions nothing can be said, and that is said.
TEST(Obligations, WhatIsMissingIsNamed) {
  Checked checked(R"(
robot R { motion Idle() interruptible [0, inf) {} }
world W { a: R b: R }
choreography C in W { parallel { thread { a: Idle() } thread { b: Idle() } } }
)");
  ASSERT_TRUE(checked.good());
  const Obligations obligations = ObligationsOf(checked.graphs[0], checked.arena);
  const auto lacks = [&](const std::string& what) {
    return std::ranges::any_of(obligations.missing, [&](const Missing& m) { return m.what == what; });
  };
  EXPECT_TRUE(lacks("the body of `R`"));
  EXPECT_TRUE(lacks("a region for `a`"));
}

}  // namespace
}  // namespace rondo::choreo
