// Events that part of a set may meet: several modes are possible at once.
#include <fmt/format.h>

#include <algorithm>

#include "reach/problem/bounds.h"
#include "reach/validated/runner.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

constexpr size_t kMostPossible = 64;
constexpr size_t kMostRounds = 32;

// Does the condition hold, and by more than a touch? What holds for an instant only may do nothing.
bool Strictly(const Guard& guard, const Map& observe) {
  return guard.formula.Check([&](size_t atom) {
    const Interval range = observe.Range(guard.first + atom);
    return range.hi == 0 ? Interval{range.lo, 0x1p-1000} : range;
  }) == verdict::Truth::kTrue;
}

}  // namespace

verdict::Truth Runner::During(const Guard& guard, Flow& flow) const {
  Stepper& stepper = flow.stepper();
  const auto check = [&](bool tight) {
    return guard.formula.Check(
        [&](size_t atom) { return stepper.Observed(guard.first + atom, 0, stepper.h(), tight); });
  };
  const verdict::Truth truth = check(false);
  return truth == verdict::Truth::kOpen ? check(true) : truth;
}

// Is it certain that no event happens during this step? What is not known any more is forgotten.
bool Runner::Quiet(Flow& flow, const Stage& stage, State& state) const {
  Stepper& stepper = flow.stepper();
  interval::Box box = stepper.during();
  box.insert(box.end(), stage.dynamics.inputs.begin(), stage.dynamics.inputs.end());
  const std::vector<Interval> values = ValuesOn(stage.observed, box);
  for (Possible& p : state.possible) {
    std::set<TermId> rising;
    for (const Guard& guard : stage.guards) {
      if (stage.modes[guard.mode] != p.mode) continue;
      const bool known = guard.IsComparison() && p.rising.contains(guard.formula.terms[0]) &&
                         stepper.ObservedSecond(guard.first).lo > 0;
      if (known) rising.insert(guard.formula.terms[0]);
      const auto on_box = [&](size_t atom) { return values[stage.observed.outputs[guard.first + atom]]; };
      if (known || guard.formula.Check(on_box) == verdict::Truth::kFalse) continue;
      if (During(guard, flow) != verdict::Truth::kFalse) return false;
    }
    p.rising = std::move(rising);
  }
  return true;
}

// One round of what happens at an instant. False if that cannot be told.
bool Runner::Happened(State& state, const Stage& stage, Map& observe) {
  if (stage.guards.empty()) return true;
  if (++state.rounds > kMostRounds || !observe.Apply(state.set)) return false;
  std::vector<Possible> next;
  const auto add = [&](Possible p) {
    if (std::ranges::find(next, p) == next.end()) next.push_back(std::move(p));
  };
  for (const Possible& p : state.possible) {
    bool stays = true;
    for (const Guard& guard : stage.guards) {
      if (stage.modes[guard.mode] != p.mode) continue;
      const verdict::Truth truth =
          guard.formula.Check([&](size_t atom) { return observe.Range(guard.first + atom); });
      if (truth != verdict::Truth::kFalse) add({guard.after, {}});
      stays = stays && !Strictly(guard, observe);
    }
    if (stays) add(p);
  }
  if (next.size() > kMostPossible) return false;
  std::ranges::sort(next, {}, &Possible::mode);
  if (next == state.possible) {
    state.rounds = 0;
  } else {
    state.possible = std::move(next);
  }
  return true;
}

// All that is possible after the step, given what is possible before it (`all`). False if that is too much.
//
// A comparison `h <= 0` that is false just after a mode begins becomes true by h falling to zero. So it stays
// false where h does not fall. That h does not fall is known from its rate, or, where its second derivative
// is positive, from its having risen once. When a mode begins because h has fallen, `-h <= 0` is false just
// after that, if one of the two is strict.
bool Runner::Successors(const Stage& stage, Flow& flow, std::vector<Possible>& all) const {
  Stepper& stepper = flow.stepper();
  struct Entry {
    Possible possible;
    std::optional<TermId> by;  ///< the comparison by which the mode began, from false to true
    bool strict = false;       ///< that one
    bool early = true;         ///< did it begin before the step?
  };
  std::vector<Entry> open;
  for (const Possible& p : all) open.push_back({p, std::nullopt, false, true});
  for (size_t at = 0; at < open.size() && open.size() <= kMostPossible; ++at) {
    for (const Guard& guard : stage.guards) {
      const Entry entry = open[at];
      if (stage.modes[guard.mode] != entry.possible.mode) continue;
      if (During(guard, flow) == verdict::Truth::kFalse) continue;
      Possible next{guard.after, {}};
      std::optional<TermId> by;
      bool by_strict = false;
      if (guard.IsComparison()) {
        const TermId term = guard.formula.terms[0];
        const Interval rate = stepper.ObservedRate(guard.first);
        const bool continuous = std::isfinite(rate.lo) && std::isfinite(rate.hi);
        const bool strict = guard.formula.nodes[guard.formula.root].strict;
        const bool was_false =
            continuous &&
            (entry.early || (entry.by && (strict || entry.strict) && stages_.AreOpposite(*entry.by, term)));
        if (was_false && (rate.lo >= 0 || entry.possible.rising.contains(term))) continue;
        if (was_false) by = term;
        by_strict = strict;
        next.rising = entry.possible.rising;
        next.rising.erase(term);
        // It fell; does its negation rise from now on? Its rate does not jump, whatever the mode is.
        if (was_false && stepper.ObservedSecond(guard.first).hi < 0) {
          for (const Guard& other : stage.guards) {
            if (other.IsComparison() && stages_.AreOpposite(other.formula.terms[0], term))
              next.rising.insert(other.formula.terms[0]);
          }
        }
      }
      const bool known = std::ranges::any_of(open, [&](const Entry& e) {
        return e.possible == next && !e.early && e.by == by && e.strict == by_strict;
      });
      if (!known) open.push_back({next, by, by_strict, false});
    }
  }
  for (const Entry& entry : open) {
    if (std::ranges::find(all, entry.possible) == all.end()) all.push_back(entry.possible);
  }
  return open.size() <= kMostPossible;
}

// A step during which it is not certain which events happen.
Runner::Next Runner::Window(const Flow& before, State& state, double until) {
  const auto failed = [&](std::string reason) {
    Fail(state.time, std::move(reason));
    return Next::kFailed;
  };
  std::vector<Possible> closure = state.possible;
  for (size_t attempt = 0; attempt < kMostRounds; ++attempt) {
    State wider = state;
    wider.possible = closure;
    auto made = stages_.For(ModesOf(wider));
    if (!made.ok()) return failed(made.error().message);
    const Stage& stage = *made.value();
    SetDiscrete(stage, wider.set);
    Flow flow(stage.dynamics, monomials_, OptionsFor(before.next_step()), stages_.horizon());
    flow.Start(wider.set, state.time);
    if (!flow.Step(until)) return failed("the set cannot be followed through an event");
    std::vector<Possible> all = state.possible;
    // What is known lasts as long as second derivatives are positive.
    for (Possible& p : all) {
      std::erase_if(p.rising, [&](TermId term) {
        return std::ranges::none_of(stage.guards, [&](const Guard& g) {
          return g.IsComparison() && g.formula.terms[0] == term &&
                 flow.stepper().ObservedSecond(g.first).lo > 0;
        });
      });
    }
    if (!Successors(stage, flow, all)) return failed("too many modes are possible");
    const bool closed = std::ranges::all_of(all, [&](const Possible& p) {
      return std::ranges::find(closure, p.mode, &Possible::mode) != closure.end();
    });
    if (!closed) {
      for (const Possible& p : all) {
        if (std::ranges::find(closure, p.mode, &Possible::mode) == closure.end()) closure.push_back(p);
      }
      continue;
    }
    attempt_.leaf.steps.push_back(
        {.kind = StepRecord::Kind::kOpen, .length = flow.stepper().h(), .degree = flow.set().degree});
    Keep(stage, flow.begin(), flow.time(), flow.stepper().during());
    falls_.clear();
    for (const StageClaim& claim : stage.claims) falls_.emplace_back(claim.starts_below.size(), false);
    if (!During(flow, stage, flow.begin(), flow.time())) {
      state.set = flow.set();
      return Next::kFailed;
    }
    if (TooWide(flow)) return failed("the enclosure has become too wide");
    // A mode whose event has certainly happened is left by now.
    Map observe(stage.observed, stage.dynamics.states, stage.dynamics.inputs, monomials_);
    if (!observe.Apply(flow.set())) return failed("the condition of an event is not defined");
    std::erase_if(all, [&](const Possible& p) {
      return std::ranges::any_of(stage.guards, [&](const Guard& g) {
        return stage.modes[g.mode] == p.mode && Strictly(g, observe);
      });
    });
    if (all.empty()) return failed("events follow one another without end");
    state.set = flow.set();
    flow.Settle(state.set);
    state.time = flow.time();
    state.step = flow.next_step();
    state.possible = std::move(all);
    if (!Instants(stage, state.set, observe, state.time, false)) return Next::kFailed;
    return Next::kChanged;
  }
  return failed("too many events in one step");
}

}  // namespace rondo::reach
