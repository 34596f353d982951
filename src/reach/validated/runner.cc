#include "reach/validated/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reach/problem/bounds.h"
#include "reach/validated/series/bound.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

constexpr size_t kMostForks = 64;
constexpr size_t kMostSplits = 63;  // at events, of one part
constexpr size_t kMostDeep = 7;     // of one start

// A side that is a point but for rounding needs no symbol.
bool IsThin(Interval side) {
  return side.Width() <= 1e-13 * std::fmax(std::fabs(side.lo), std::fabs(side.hi));
}

}  // namespace

Runner::Runner(Stages& stages, const ProverOptions& options, const FlowOptions& flow,
               const interval::Box& box, const interval::Box& whole, const base::StopToken& stop)
    : stages_(stages),
      options_(options),
      flow_(flow),
      box_(box),
      whole_(whole),
      stop_(stop),
      horizon_(stages.horizon()) {
  int symbols = 0;
  for (size_t i = 0; i < box.size(); ++i) symbol_of_.push_back(IsCopy(i) || IsThin(box[i]) ? -1 : symbols++);
  for (size_t i = 0; i < box.size(); ++i) {
    if (IsCopy(i)) symbol_of_[i] = symbol_of_[*stages_.problem().copy_of[i]];
  }
  monomials_ = std::make_shared<Monomials>(static_cast<size_t>(symbols));
  attempt_.leaf.initial = box_;
  attempt_.leaf.final.assign(box_.size(), Interval::Empty());
}

bool Runner::IsCopy(size_t i) const {
  const auto& copies = stages_.problem().copy_of;
  return i < copies.size() && copies[i].has_value();
}

Runner::State Runner::Begin() const {
  State state;
  state.set = FromBox(box_, *monomials_, symbol_of_);
  state.step = flow_.first_step;
  state.possible.push_back({stages_.modes().start(), {}});
  return state;
}

Attempt Runner::Run() {
  if (CheckBox(stages_.assumed_terms(), stages_.assumed(), box_) == verdict::Truth::kFalse) {
    attempt_.proved = attempt_.vacuous = true;
    return std::move(attempt_);
  }
  attempt_.proved = Follow(Begin());
  if (!attempt_.proved) ChooseSplit(last_);
  return std::move(attempt_);
}

bool Runner::Breaks(size_t claim, double time) {
  claims_ = false;
  broken_ = claim;
  horizon_ = time;
  return Follow(Begin());
}

bool Runner::Fail(double time, std::string reason, verdict::Shortfall shortfall) {
  attempt_.shortfall = shortfall;
  attempt_.reason = std::move(reason);
  attempt_.time = time;
  return false;
}

bool Runner::Stopped(double time) { return Fail(time, "stopped", verdict::Shortfall::kInterrupted); }

FlowOptions Runner::OptionsFor(double first_step) const {
  FlowOptions options = flow_;
  if (stages_.period() > 0) options.most_step = std::min(options.most_step, stages_.period());
  options.first_step = std::min(first_step, stages_.horizon());
  return options;
}

std::vector<Mode> Runner::ModesOf(const State& state) const {
  std::set<Mode> modes;
  for (const Possible& p : state.possible) modes.insert(p.mode);
  return {modes.begin(), modes.end()};
}

bool Runner::Follow(State state) {
  while (true) {
    auto made = stages_.For(ModesOf(state));
    if (!made.ok()) return Fail(state.time, made.error().message);
    const std::shared_ptr<const Stage>& stage = made.value();
    SetDiscrete(*stage, state.set);
    falls_.clear();
    for (const StageClaim& claim : stage->claims) {
      falls_.push_back(claim.starts_below);
      if (state.time > 0) falls_.back().assign(claim.starts_below.size(), false);
    }
    const Next next = Along(state, *stage);
    last_ = state.set;
    if (next == Next::kFork) return Fork(state);
    if (next == Next::kFailed) return false;
    if (next == Next::kDone || next == Next::kNo) return true;  // the horizon
  }
}

// Discrete states are part of the set only so that all states have one order: programs know their values.
void Runner::SetDiscrete(const Stage& stage, FlowSet& set) const {
  for (size_t i = 0; i < box_.size(); ++i) {
    if (!stage.discrete[i]) continue;
    auto p = set.Polynomial(i);
    std::fill(p.begin(), p.end(), 0.0);
    p[0] = stage.discrete[i]->Middle();
    set.generators.row(static_cast<Eigen::Index>(i)).setZero();
    set.slack[i] = stage.discrete[i]->IsPoint() ? 0 : Above(stage.discrete[i]->Width());
  }
}

// Each mode on its own, from here on.
bool Runner::Fork(const State& state) {
  for (const Mode& mode : ModesOf(state)) {
    if (++forks_ > kMostForks) return Fail(state.time, "too many modes are possible");
    attempt_.leaf.steps.push_back({.kind = StepRecord::Kind::kOpen});
    State branch = state;
    branch.possible = {{mode, {}}};
    if (!Follow(std::move(branch))) return false;
  }
  return true;
}

// In one stage, to its end or to the horizon (kNo). `state` is where it ends.
Runner::Next Runner::Along(State& state, const Stage& stage) {
  const auto capacity = flow_.generators_per_state * static_cast<Eigen::Index>(stage.dynamics.states);
  Flow flow(stage.dynamics, monomials_, OptionsFor(state.step), stages_.horizon());
  flow.Start(state.set, state.time);
  Map observe(stage.observed, stage.dynamics.states, stage.dynamics.inputs, monomials_);
  std::optional<Map> control;
  if (stages_.period() > 0)
    control.emplace(stage.updates, stage.dynamics.states, stage.dynamics.inputs, monomials_);
  const auto leave = [&](Next next) {
    if (next == Next::kFailed || next == Next::kNo) state.set = flow.set();
    return next;
  };
  const auto failed = [&](std::string reason) {
    Fail(flow.time(), std::move(reason));
    return leave(Next::kFailed);
  };
  if (state.possible.size() > 1 && stage.ambiguous && observe.Apply(flow.set())) {
    const bool calm = std::ranges::all_of(stage.guards, [&](const Guard& g) {
      return g.formula.Check([&](size_t atom) { return observe.Range(g.first + atom); }) ==
             verdict::Truth::kFalse;
    });
    if (calm) return Next::kFork;
  }
  while (flow.time() < horizon_) {
    earlier_.reset();  // no event window reaches over an instant at which something is checked
    const bool due = state.sample < stages_.samples() &&
                     flow.time() >= stages_.period() * static_cast<double>(state.sample);
    if (due) {
      FlowSet next;
      if (!control->Apply(flow.set())) return failed("the controller is not defined on the whole set");
      control->Finish(flow.set(), next, capacity);
      flow.set() = std::move(next);
      for (Possible& p : state.possible) p.rising.clear();  // rates may jump
      ++state.sample;
      state.look = true;
    }
    if (state.look) {
      state.set = flow.set();
      state.time = flow.time();
      const std::vector<Possible> before = state.possible;
      if (!Happened(state, stage, observe)) return failed("it cannot be told which events happen");
      if (state.possible != before) return Next::kChanged;
      state.look = false;
      if (!state.begun && !Instants(stage, flow.set(), observe, 0, true)) return leave(Next::kFailed);
      state.begun = true;
    }
    const auto& instants = stages_.instants();
    const auto event = std::ranges::upper_bound(instants, flow.time());
    double until = std::min(horizon_, event == instants.end() ? horizon_ : *event);
    if (state.sample < stages_.samples())
      until = std::min(until, stages_.period() * static_cast<double>(state.sample));
    while (flow.time() < until) {
      const Next next = StepOn(flow, state, stage, until);
      if (next == Next::kChanged || next == Next::kDone) return next;
      if (next == Next::kFailed) return leave(next);
    }
    if (claims_ && !Instants(stage, flow.set(), observe, flow.time(), false)) return leave(Next::kFailed);
  }
  const interval::Box now = flow.Now();
  for (size_t i = 0; i < box_.size(); ++i) {
    attempt_.leaf.final[i] = interval::Hull(attempt_.leaf.final[i], now[i]);
    if (stage.discrete[i])
      attempt_.leaf.final[i] = interval::Hull(attempt_.leaf.final[i], *stage.discrete[i]);
  }
  if (broken_) {
    if (!observe.Apply(flow.set())) return failed("a claim is not defined");
    for (const StageClaim& claim : stage.claims) {
      if (claim.claim == *broken_ && claim.formula.Check([&](size_t atom) {
            return observe.Range(claim.first + atom);
          }) != verdict::Truth::kFalse)
        return failed("it may hold");
    }
  }
  return leave(Next::kNo);
}

// One step, or an event.
Runner::Next Runner::StepOn(Flow& flow, State& state, const Stage& stage, double until) {
  const auto failed = [&](std::string reason) {
    Fail(flow.time(), std::move(reason));
    return Next::kFailed;
  };
  if (stop_.StopRequested()) {
    Stopped(flow.time());
    return Next::kFailed;
  }
  const bool events = !stage.guards.empty();
  if (events) {
    if (state.time < flow.time()) earlier_ = state;
    state.set = flow.set();
    state.time = flow.time();
  }
  if (!flow.Step(until)) return failed("the set cannot be followed further");
  if (events) {
    flow.Settle(state.set);
    state.step = flow.stepper().h();
    if (!Quiet(flow, stage, state)) return Meet(flow, state, stage, until);
  }
  const Stepper& stepper = flow.stepper();
  attempt_.leaf.steps.push_back({.length = stepper.h(), .degree = flow.set().degree});
  Keep(stage, flow.begin(), flow.time(), stepper.during());
  state.step = flow.next_step();
  if (!During(flow, stage, flow.begin(), flow.time())) return Next::kFailed;
  if (TooWide(flow)) return failed("the enclosure has become too wide");
  return Next::kNo;
}

// Some event may happen in the step that begins at `state`.
Runner::Next Runner::Meet(const Flow& flow, State& state, const Stage& stage, double until) {
  std::optional<size_t> symbol;
  Next next = Cross(state, stage, until, symbol);
  if (next == Next::kNo && !symbol && earlier_ && state.possible.size() == 1) {
    // Some starts met it too soon to tell from where the step began.
    State from = std::move(*earlier_);
    from.possible = state.possible;
    const StepRecord last = attempt_.leaf.steps.back();
    attempt_.leaf.steps.pop_back();
    next = Cross(from, stage, until, symbol);
    if (next == Next::kChanged || symbol) {
      state = std::move(from);
    } else {
      attempt_.leaf.steps.push_back(last);
    }
  }
  if (next == Next::kChanged || stop_.StopRequested()) return next;
  if (symbol && splits_ < kMostSplits && state.halvings < kMostDeep) return SplitAt(state, *symbol);
  return next == Next::kNo ? Window(flow, state, until) : next;
}

// Those who meet an event sooner, and those who meet it later, each on their own.
Runner::Next Runner::SplitAt(const State& state, size_t symbol) {
  ++splits_;
  attempt_.leaf.steps.push_back({.kind = StepRecord::Kind::kSplit, .symbol = symbol});
  for (const bool upper : {false, true}) {
    State half = state;
    half.set = Half(state.set, *monomials_, symbol, upper);
    ++half.halvings;
    if (!Follow(std::move(half))) return Next::kFailed;
  }
  return Next::kDone;
}

}  // namespace rondo::reach
