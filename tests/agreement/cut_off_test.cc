// Random small programs with controllers and fallbacks: what is proved of robots that are cut off is never violated in
// runs that are made moment by moment. Nothing of the prover's rounds is used: at each moment sensors move as
// controllers promise since actuators changed last, events reach actuators when they do, and fallbacks take over.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "koord/check/check.h"
#include "koord/prove/prove.h"
#include "koord/semantics/program_transition.h"
#include "koord/syntax/parser.h"
#include "solve/z3/z3_solver.h"

namespace rondo::koord {
namespace {

using semantics::Effect;
using semantics::Team;
using semantics::Word;

constexpr int kSkips = -1;

class Texts {
 public:
  Texts(uint64_t seed, int highest) : rng_(seed), highest_(highest) {}

  std::string Whole() {
    std::string text =
        "using M:\n    sensors:\n        int at\n    actuators:\n        int to\n"
        "allread:\n    int x[N_sys] = 0\nlocal:\n    bool sent = false\n";
    for (size_t e = 0; e < 1 + Pick(2); ++e) {
      text += "E" + std::to_string(e) + ":\n    pre" + (Pick(5) == 0 ? " urgent" : "") + ": " + Guard() +
              "\n    eff:\n";
      for (size_t s = 0; s < 1 + Pick(3); ++s) text += "        " + Write() + "\n";
    }
    if (Pick(6) != 0) text += "fallback M:\n    " + Fallback() + "\n";
    text += "assume initially: M.at == 0 and M.to == 0\n";
    text += "assume M.room always 0 <= M.at and M.at <= " + std::to_string(highest_) + "\n";
    for (const char* promise : kPromises) {
      if (Pick(3) != 0) text += std::string("assume M.") + promise + "\n";
    }
    std::set<std::string> invariants;
    for (size_t i = 0; i < 1 + Pick(2); ++i) invariants.insert(kInvariants[Pick(std::size(kInvariants))]);
    for (const std::string& i : invariants) text += "invariant: forall i in ID: " + i + "\n";
    return text;
  }

 private:
  size_t Pick(size_t n) { return rng_() % n; }
  std::string Number() { return std::to_string(Pick(static_cast<size_t>(highest_) + 1)); }
  std::string Guard() {
    constexpr const char* kGuards[] = {"true", "not sent", "M.at < 2", "x[pid] == M.at", "M.at > 0", "sent"};
    return kGuards[Pick(std::size(kGuards))];
  }
  std::string Write() {
    switch (Pick(6)) {
      case 0:
        return "M.to = " + Number();
      case 1:
        return "M.to = M.at";
      case 2:
        return "M.to = min(M.at + 1, " + std::to_string(highest_) + ")";
      case 3:
        return "x[pid] = M.at";
      case 4:
        return "M.to = x[(pid + 1) % N_sys]";
      default:
        return Pick(2) == 0 ? "sent = true" : "sent = false";
    }
  }
  std::string Fallback() {
    constexpr const char* kFallbacks[] = {"to = at", "to = 0", "to = max(at - 1, 0)",
                                          "if at < 2:\n        to = 0\n    else:\n        to = 2",
                                          "to = pid"};
    return kFallbacks[Pick(std::size(kFallbacks))];
  }
  static constexpr const char* kPromises[] = {
      "rises when M.at <= M.to always old(M.at) <= M.at and M.at <= M.to",
      "falls when M.at >= M.to always M.to <= M.at and M.at <= old(M.at)",
      "slow when M.at >= 0 always abs(M.at - old(M.at)) <= 1",
      "rests when M.to == M.at always M.at == old(M.at)", "calm when M.to == 0 always M.at <= old(M.at)"};
  static constexpr const char* kInvariants[] = {"M[i].at <= 1",
                                                "M[i].to <= 1",
                                                "M[i].to <= M[i].at",
                                                "M[i].at <= M[i].to",
                                                "x[i] <= M[i].at",
                                                "x[i] <= 1",
                                                "sent[i] implies M[i].to > 0",
                                                "sent[i] implies M[i].at > 0",
                                                "forall j in ID: i != j implies M[i].at + M[j].at <= 3",
                                                "not sent[i] implies M[i].at == 0"};
  std::mt19937_64 rng_;
  int highest_;
};

// Makes every run in which robots are cut off, for sensors that are small numbers.
class Moments {
 public:
  Moments(Team& team, int highest, bool acts_at_once, bool runs_urgent)
      : team_(team),
        transition_(team),
        highest_(highest),
        acts_at_once_(acts_at_once),
        runs_urgent_(runs_urgent) {
    for (size_t v = 0; v < team.model().variables.size(); ++v) {
      if (team.model().variables[v].name == "M.at") at_ = v;
      if (team.model().variables[v].name == "M.to") to_ = v;
    }
  }

  // Is an invariant violated at some moment of some run?
  bool Violates() {
    std::vector<Word> first = team_.blank();
    starts_.insert(first);
    std::vector<std::vector<Word>> todo{first};
    while (!todo.empty() && !violated_) {
      const std::vector<Word> start = todo.back();
      todo.pop_back();
      next_.clear();
      if (!Check(start)) return true;
      Round(start);
      for (const auto& s : next_) {
        if (starts_.insert(s).second) todo.push_back(s);
      }
    }
    return violated_;
  }
  size_t starts() const { return starts_.size(); }

 private:
  // A moment of a round, with what each robot still has to do, and the state since which its actuators are the same.
  struct Moment {
    std::vector<Word> state;
    std::vector<Word> since;
    std::vector<int> pending;  // by robot: what its actuator gets some time; `kSkips`: nothing
    std::vector<bool> changed;
    auto operator<=>(const Moment&) const = default;
  };

  uint32_t At(size_t robot) const { return team_.layout().Address(at_, robot); }
  uint32_t To(size_t robot) const { return team_.layout().Address(to_, robot); }

  bool Check(std::vector<Word> state) {
    team_.machine().SetMemory(state.data());
    for (const auto& invariant : team_.invariants()) {
      if (!team_.Holds(invariant)) violated_ = true;
    }
    return !violated_;
  }

  void Round(const std::vector<Word>& start) {
    transition_.Prepare(start);
    std::vector<std::vector<Effect>> effects;
    for (size_t r = 0; r < team_.robots(); ++r) {
      const auto of = transition_.Of(r);
      effects.emplace_back(of.begin(), of.end());
    }
    Moment moment{start, start, std::vector<int>(team_.robots(), kSkips), std::vector<bool>(team_.robots())};
    Choose(0, effects, moment);
  }

  void Choose(size_t r, const std::vector<std::vector<Effect>>& effects, const Moment& moment) {
    if (r == team_.robots()) {
      Moment begins = moment;
      begins.since = begins.state;
      seen_.clear();
      return Go(begins, 2);
    }
    const bool urgent = std::ranges::any_of(effects[r], [](const Effect& e) { return e.urgent; });
    if (!urgent || !runs_urgent_) Choose(r + 1, effects, moment);
    for (const Effect& e : effects[r]) {
      Moment at_once = moment;
      int wants = kSkips;
      for (const Effect::Write& w : e.own) {
        if (w.at == To(r)) wants = static_cast<int>(w.value);
        at_once.state[w.at] = w.value;
      }
      Choose(r + 1, effects, at_once);
      if (wants == kSkips || (urgent && runs_urgent_)) continue;
      Moment later = at_once;
      later.state[To(r)] = moment.state[To(r)];
      later.pending[r] = wants;
      Choose(r + 1, effects, later);
    }
  }

  // Everything that can happen from here on, in a number of moments.
  void Go(const Moment& moment, int left) {
    if (violated_ || !seen_.insert({moment, left}).second || !Check(moment.state)) return;
    next_.insert(moment.state);
    for (size_t r = 0; r < team_.robots(); ++r) {
      if (moment.changed[r]) continue;
      // What it set out to do reaches its actuator, or its fallback does.
      if (moment.pending[r] != kSkips && !acts_at_once_)
        Change(moment, r, static_cast<Word>(moment.pending[r]), left);
      if (team_.fallbacks().empty()) continue;
      std::vector<Word> seen = moment.state;
      team_.machine().SetMemory(seen.data());
      if (!team_.machine().Run(team_.fallbacks()[0].body, r, false)) continue;
      Change(moment, r, seen[To(r)], left);
    }
    if (left > 0) Move(0, moment, moment, left);
  }

  void Change(const Moment& moment, size_t r, Word to, int left) {
    Moment changed = moment;
    changed.state[To(r)] = to;
    changed.pending[r] = kSkips;
    changed.changed[r] = true;
    changed.since[At(r)] = changed.state[At(r)];
    changed.since[To(r)] = to;
    Go(changed, left);
  }

  // Sensors move, each robot's as its controllers promise.
  void Move(size_t r, const Moment& from, const Moment& moment, int left) {
    if (r == team_.robots()) return Go(moment, left - 1);
    for (int at = 0; at <= highest_ && !violated_; ++at) {
      Moment moved = moment;
      moved.state[At(r)] = static_cast<Word>(at);
      if (Keeps(r, moved)) Move(r + 1, from, moved, left);
    }
  }

  bool Keeps(size_t r, Moment& moment) {
    auto& machine = team_.machine();
    machine.SetMemory(moment.state.data(), moment.since.data());
    for (const auto& fact : team_.port_facts()) {
      if (!machine.RunFormula(fact.entry, r)) return false;
    }
    return std::ranges::all_of(team_.promises(), [&](const auto& promise) {
      machine.SetMemory(moment.since.data());
      if (promise.when != 0 && !machine.RunFormula(promise.when, r)) return true;
      machine.SetMemory(moment.state.data(), moment.since.data());
      return machine.RunFormula(promise.always, r);
    });
  }

  Team& team_;
  semantics::ProgramTransition transition_;
  int highest_;
  bool acts_at_once_, runs_urgent_;
  size_t at_ = 0, to_ = 0;
  bool violated_ = false;
  std::set<std::vector<Word>> starts_, next_;
  std::set<std::pair<Moment, int>> seen_;
};

TEST(CutOff, WhatIsProvedHoldsAtEveryMoment) {
  const char* wanted = std::getenv("RONDO_SEEDS");
  const uint64_t seeds = wanted == nullptr ? 80 : std::strtoull(wanted, nullptr, 10);
  const solve::z3::Z3Solver z3;
  size_t proved = 0, violated = 0, limited = 0;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    const size_t robots = 1 + seed % 2;
    const int highest = robots == 1 ? 4 : 2;
    const std::string text = Texts(seed, highest).Whole();
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    Program program;
    Parse(sources, sources.Add("random.koord", text), program, diagnostics);
    const Model model = Check(program, diagnostics);
    ASSERT_FALSE(diagnostics.has_errors()) << diagnostics.all()[0].message << "\n" << text;
    ProveOptions options;
    options.solver = &z3;
    options.robots = static_cast<int64_t>(robots);
    options.timeout = std::chrono::seconds(5);
    const Report report = Prove(model, options, diagnostics);
    const auto assumes = [&](const char* part) {
      return std::ranges::any_of(report.basis.assumed,
                                 [&](const std::string& a) { return a.find(part) != std::string::npos; });
    };
    EXPECT_FALSE(report.disagreement) << "seed " << seed << "\n"
                                      << text;  // a counterexample that does not replay
    const bool none = assumes("there is no `fallback`");
    const bool at_once = none || assumes("act as a round begins");
    const auto team = Team::Make(model, {robots, {}, {}, {}}, diagnostics);
    ASSERT_NE(team, nullptr) << text;
    if (none) continue;  // then nothing is claimed of robots that are cut off
    const bool all = report.AllProved();
    Moments moments(*team, highest, all && at_once, all && assumes("urgent"));
    const bool bad = moments.Violates();
    EXPECT_FALSE(all && bad) << "seed " << seed << "\n" << text;
    proved += all ? 1 : 0;
    limited += all && (at_once || assumes("urgent")) ? 1 : 0;
    violated += bad ? 1 : 0;
  }
  // Both happen, or nothing was tried.
  EXPECT_GE(proved, seeds / 20);
  EXPECT_GE(violated, seeds / 5);
  std::printf("%zu proved (%zu with limits), %zu violated\n", proved, limited, violated);
}

}  // namespace
}  // namespace rondo::koord
