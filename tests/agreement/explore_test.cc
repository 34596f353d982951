// Random small Koord programs: what is proved is never violated by exhaustive exploration, every
// counterexample of the prover is a round of the executable semantics, and the reductions of the explorer
// lose nothing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "explore/search.h"
#include "koord/prove/prove.h"
#include "koord/semantics/round_execution.h"
#include "koord/semantics/system.h"
#include "koord_texts.h"
#include "solve/smtlib/smtlib_solver.h"
#include "solve/z3/z3_solver.h"

namespace rondo::koord {
namespace {

using semantics::System;
using semantics::Team;

struct Outcome {
  explore::SearchResult search;
  std::set<std::vector<semantics::Word>> states;
  bool usable = false;
};

Outcome ExploreAll(const Model& model, size_t robots, semantics::SystemOptions options, bool states) {
  Outcome outcome;
  diag::Diagnostics diagnostics;
  const auto team = Team::Make(model, {robots, {}, {}, {}}, diagnostics);
  if (team == nullptr) return outcome;
  System system(*team, options, diagnostics);
  explore::SearchOptions search;
  search.states = 20'000;
  outcome.search = explore::Search(system, search);
  outcome.usable = !diagnostics.has_errors();
  if (!states || outcome.search.ending != explore::Ending::kComplete) return outcome;
  // Once more, by hand, to see them.
  std::vector<explore::KeptState> queue;
  const explore::Visit visit = [&](explore::State state) {
    if (outcome.states.insert(system.Unpack(state)).second) queue.emplace_back(state.begin(), state.end());
    return true;
  };
  system.Initial(visit);
  for (size_t i = 0; i < queue.size(); ++i) {
    const auto state = queue[i];
    system.Successors(state, visit);
  }
  return outcome;
}

// States up to and including the broken one.
size_t Length(const Outcome& outcome) {
  return outcome.search.path.size() + (outcome.search.broken.at_visited ? 0 : 1);
}

uint64_t Cases(uint64_t usual) {
  const char* wanted = std::getenv("RONDO_CASES");
  return wanted == nullptr ? usual : std::max<uint64_t>(usual, std::strtoull(wanted, nullptr, 10) / 100);
}

TEST(ExploreAgreement, WhatIsProvedIsNeverViolated) {
  const solve::z3::Z3Solver z3;
  const solve::smtlib::SmtLibSolver cvc5("cvc5");
  size_t proved = 0;
  size_t violated = 0;
  size_t replayed = 0;
  for (uint64_t seed = 1; seed <= Cases(36); ++seed) {
    const std::string text = Texts(seed).Whole();
    Loaded loaded(text);
    ASSERT_TRUE(loaded.good()) << "seed " << seed << "\n" << text;
    ProveOptions options;
    options.solver = &z3;
    // A second solver, for all in long runs and for some in short ones.
    if (seed <= 10 || Cases(36) > 150) options.cross_check = &cvc5;
    options.jobs = 1;
    options.timeout = std::chrono::milliseconds(1000);
    // Every third program for a team of fixed size, which is proved in other ways, too.
    if (seed % 3 == 0)
      options.robots = 1 + static_cast<int64_t>(seed % 2) + static_cast<int64_t>(seed % 5 == 0);
    diag::Diagnostics diagnostics;
    const Report report = Prove(loaded.model, options, diagnostics);
    // A counterexample that the executable semantics cannot replay is a disagreement.
    ASSERT_FALSE(report.disagreement) << "seed " << seed << "\n" << text;
    for (const Row& row : report.rows) replayed += row.witness.has_value() ? 1 : 0;
    for (size_t n = 1; n <= 4; ++n) {
      if (options.robots && n != static_cast<size_t>(*options.robots)) continue;
      const Outcome found = ExploreAll(loaded.model, n, {}, false);
      ASSERT_TRUE(found.usable) << text;
      if (found.search.ending != explore::Ending::kBroken) continue;
      ++violated;
      const auto property = static_cast<size_t>(found.search.broken.property);
      ASSERT_LT(property, report.rows.size());  // the last row is that operations are defined
      EXPECT_NE(report.rows[property].verdict, verdict::Verdict::kProved)
          << "seed " << seed << ", N = " << n << ", " << report.rows[property].name << "\n"
          << text;
      break;
    }
    for (const Row& row : report.rows) proved += row.verdict == verdict::Verdict::kProved ? 1 : 0;
  }
  EXPECT_GT(proved, 8U);
  EXPECT_GT(violated, 1U);
  EXPECT_GT(replayed, 8U);
}

TEST(ExploreAgreement, ReductionsLoseNothing) {
  size_t complete = 0;
  size_t symmetric = 0;
  for (uint64_t seed = 10'001; seed <= 10'000 + Cases(60); ++seed) {
    const std::string text = Texts(seed).Whole();
    Loaded loaded(text);
    ASSERT_TRUE(loaded.good());
    for (size_t n = 1; n <= 3; ++n) {
      const Outcome all = ExploreAll(loaded.model, n, {false, false, {}}, true);
      const Outcome reduced = ExploreAll(loaded.model, n, {true, false, {}}, true);
      const Outcome renamed = ExploreAll(loaded.model, n, {true, true, {}}, true);
      const bool cut = all.search.ending == explore::Ending::kStates;
      if (cut) continue;
      ASSERT_EQ(all.search.ending, reduced.search.ending) << "seed " << seed << ", N = " << n << "\n" << text;
      ASSERT_EQ(all.search.ending, renamed.search.ending) << "seed " << seed << ", N = " << n << "\n" << text;
      if (all.search.ending != explore::Ending::kComplete) {
        // The shortest run is as short.
        EXPECT_EQ(Length(all), Length(reduced)) << "seed " << seed << "\n" << text;
        EXPECT_EQ(Length(all), Length(renamed)) << "seed " << seed << "\n" << text;
        continue;
      }
      ++complete;
      EXPECT_EQ(all.states, reduced.states) << "seed " << seed << ", N = " << n << "\n" << text;
      if (renamed.states.size() < all.states.size()) ++symmetric;
      for (const auto& state : renamed.states) EXPECT_TRUE(all.states.contains(state)) << text;
    }
  }
  EXPECT_GT(complete, 40U);
  EXPECT_GT(symmetric, 5U);
}

TEST(ExploreAgreement, ASimulatedRoundIsOneOfTheRoundsThatAreExplored) {
  size_t rounds = 0;
  for (uint64_t seed = 20'001; seed <= 20'000 + Cases(200); ++seed) {
    const std::string text = Texts(seed).Whole();
    Loaded loaded(text);
    ASSERT_TRUE(loaded.good());
    diag::Diagnostics diagnostics;
    const auto team = Team::Make(loaded.model, {3, {}, {}, {}}, diagnostics);
    ASSERT_NE(team, nullptr);
    System system(*team, {}, diagnostics);
    std::vector<semantics::Word> state;
    system.Initial([&](explore::State packed) {
      state = system.Unpack(packed);
      return false;
    });
    if (state.empty()) continue;
    std::mt19937_64 random(seed);
    for (int k = 0; k < 10; ++k) {
      const std::vector<semantics::Word> before = state;
      semantics::RoundExecution round(*team);
      round.Begin(state);
      std::vector<size_t> order{0, 1, 2};
      std::shuffle(order.begin(), order.end(), random);
      bool failed = false;
      team->machine().SetChooser([&](uint64_t possibilities) { return random() % possibilities; });
      for (const size_t r : order) {
        const auto enabled = round.Enabled(r);
        if (enabled.empty() || random() % 4 == 0) continue;
        failed = failed ||
                 round.Run(r, enabled[random() % enabled.size()]) == semantics::RoundExecution::Ran::kFailed;
      }
      if (failed) break;
      round.Finish();
      semantics::ProgramTransition transition(*team);
      transition.Prepare(before);
      bool found = false;
      transition.Enumerate([&](std::span<const semantics::Word> after, bool) {
        found = std::equal(after.begin(), after.end(), state.begin());
        return !found;
      });
      ASSERT_TRUE(found) << "seed " << seed << "\n" << text;
      ++rounds;
    }
  }
  EXPECT_GT(rounds, 500U);
}

}  // namespace
}  // namespace rondo::koord
