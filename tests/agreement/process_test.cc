// Processes that are typed run together without getting stuck, and say nothing that the choreography does not
// say; processes with a random fault are rejected, or are no worse.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "checked.h"
#include "choreo/semantics/search.h"
#include "choreo/semantics/whole.h"

namespace rondo::choreo {
namespace {

const std::string kChoreography = R"(
robot R {
  state x : length in [-9 m, 9 m]
  motion Idle() interruptible [0 s, inf) {}
  motion Go(d : length = 1 m, T = 1 s) noninterruptible [T, T] { modifies x }
}
world W { a: R  b: R  c: R }
choreography C in W {
  { a: Go(), b: Idle(), c: Idle() }
  a -> b: done(1 m)
  b -> c: done(1 m)
  while b.x > 0 m {
    b -> a: more()
    b -> c: more()
    parallel { thread { { a: Go(2 m), c: Idle() } a -> c: half() } thread { b: Idle() } }
    a -> b: half()
    b -> c: go()
    { a: Idle(), b: Go(), c: Idle() }
  }
  b -> a: enough()
  b -> c: enough()
  { a: Idle(), b: Idle(), c: Go(3 m) }
  c -> a: end()
  c -> b: end()
}
)";

// One act in each line, so that lines can be taken out, doubled and exchanged.
const std::array<std::vector<std::string>, 3> kProcesses = {{
    {"process a in C {", "Go()", "send b.done(1 m)", "rec X {", "receive from b while Idle() {", "more => {",
     "Go(2 m)", "send c.half()", "send b.half()", "continue X", "}", "enough => {",
     "receive from c while Idle() { end => exit }", "}", "}", "}", "}"},
    {"process b in C {", "receive from a while Idle() { done(d) => send c.done(d) }", "while b.x > 0 m {",
     "send a.more()", "send c.more()", "receive from a while Idle() { half => {} }", "send c.go()", "Go()",
     "}", "send a.enough()", "send c.enough()", "receive from c while Idle() { end => exit }", "}"},
    {"process c in C {", "receive from b while Idle() { done(d) => {} }", "rec X {",
     "receive from b while Idle() {", "more => {", "receive from a while Idle() { half => {} }",
     "receive from b { go => {} }", "continue X", "}", "enough => {", "Go(3 m)", "send a.end()",
     "send b.end()", "}", "}", "}", "}"},
}};

std::string TextOf(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

struct Outcome {
  bool parsed = false;
  bool typed = false;
  size_t open = 0;
  SearchResult found;
  bool says_more = false;
};

Outcome Try(const std::string& text) {
  Outcome run;
  Checked checked(text);
  if (!checked.good()) return run;
  run.parsed = true;
  std::vector<Typed> typed;
  typed.push_back({&checked.graphs[0], checked.types});
  run.open = CheckProcesses(checked.module, typed, *checked.declarations).size();
  run.typed = !checked.diagnostics.has_errors();
  std::vector<Machine> machines(checked.types.size());
  for (const Item& item : checked.module.items) {
    const auto* process = std::get_if<ProcessDef>(&item);
    if (process == nullptr) continue;
    const auto flow = BuildFlow(*process, checked.graphs[0], *checked.declarations);
    if (!flow) return run;
    machines[flow->robot.index()] = MachineOf(checked.graphs[0], *flow, *checked.declarations);
  }
  for (const Machine& m : machines) {
    if (m.states.empty()) return run;
  }
  const Team team(std::move(machines));
  run.found = FindStuck(team, 20'000);
  const auto different = DifferentTrace(Whole(checked.graphs[0]), team, 40);
  run.says_more = !different.empty() && different.back() == "only the second";
  return run;
}

TEST(Process, WhatIsTypedRuns) {
  const Outcome run =
      Try(kChoreography + TextOf(kProcesses[0]) + TextOf(kProcesses[1]) + TextOf(kProcesses[2]));
  EXPECT_TRUE(run.typed);
  EXPECT_EQ(run.open, 0u);
  EXPECT_FALSE(run.found.stuck);
  EXPECT_FALSE(run.says_more);
  EXPECT_GT(run.found.states, 30u);
}

TEST(Process, MutantsAreRejectedOrHarmless) {
  std::mt19937_64 rng(7);
  const auto pick = [&](size_t n) { return static_cast<size_t>(rng() % n); };
  int rejected = 0, accepted = 0, stuck = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<std::vector<std::string>, 3> processes = kProcesses;
    std::vector<std::string>& lines = processes[pick(3)];
    const size_t at = 1 + pick(lines.size() - 1), other = 1 + pick(lines.size() - 1);
    switch (pick(5)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), lines[other]);
        break;
      case 2:
        std::swap(lines[at], lines[other]);
        break;
      default: {
        // Another robot, label, motion or amount.
        static constexpr std::array<std::array<const char*, 2>, 9> kWords = {{{"a", "b"},
                                                                              {"b", "c"},
                                                                              {"more", "half"},
                                                                              {"enough", "end"},
                                                                              {"done", "half"},
                                                                              {"2 m", "1 m"},
                                                                              {"1 m", "1 s"},
                                                                              {"Go", "Idle"},
                                                                              {"x > 0", "x < 0"}}};
        const auto& [from, to] = kWords[pick(kWords.size())];
        const size_t place = lines[at].find(from);
        if (place == std::string::npos) continue;
        lines[at].replace(place, std::string(from).size(), to);
      }
    }
    const std::string text =
        kChoreography + TextOf(processes[0]) + TextOf(processes[1]) + TextOf(processes[2]);
    const Outcome run = Try(text);
    if (!run.parsed) continue;
    (run.typed ? accepted : rejected) += 1;
    stuck += run.found.stuck ? 1 : 0;
    if (!run.typed || run.open > 0) continue;
    ASSERT_FALSE(run.found.stuck) << "behind" << Join(run.found.run) << "\n" << text;
    ASSERT_FALSE(run.says_more) << text;
  }
  EXPECT_GT(rejected, 500);
  EXPECT_GT(accepted, 5);
  EXPECT_GT(stuck, 100);
}

}  // namespace
}  // namespace rondo::choreo
