#include "reach/validated/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reach/problem/bounds.h"
#include "reach/validated/series/bound.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

constexpr int kMostHalvings = 6;  // of the time of a step, for a claim
constexpr int kSlices = 16;       // of the time of a step, for a query
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

std::optional<std::vector<Interval>> Runner::Ask(const std::vector<Query>& queries) {
  claims_ = false;
  queries_ = &queries;
  answers_.assign(queries.size(), Interval::Empty());
  if (!Follow(Begin())) return std::nullopt;
  return answers_;
}

// What is asked for during a step, which happens at some time of [from, to].
void Runner::Answer(Flow& flow, const Stage& stage, double from, double to) {
  Stepper& stepper = flow.stepper();
  const bool sharp = from == flow.begin() && to == flow.time();
  for (const StageQuery& q : stage.queries) {
    const Query& query = (*queries_)[q.query];
    if (query.from > to || query.to < from) continue;
    const double begin = sharp ? std::clamp(query.from - from, 0.0, stepper.h()) : 0;
    const double end = sharp ? std::clamp(query.to - from, begin, stepper.h()) : stepper.h();
    // Slices: polynomials are enclosed more sharply over short times.
    const int slices = end > begin ? kSlices : 1;
    for (int k = 0; k < slices; ++k) {
      const double from_here = begin + (end - begin) * k / slices;
      const double to_here = k + 1 == slices ? end : begin + (end - begin) * (k + 1) / slices;
      answers_[q.query] =
          interval::Hull(answers_[q.query], stepper.Observed(q.output, from_here, to_here, true));
    }
  }
}

bool Runner::Fail(double time, std::string reason, verdict::Shortfall shortfall) {
  attempt_.shortfall = shortfall;
  attempt_.reason = std::move(reason);
  attempt_.time = time;
  return false;
}

bool Runner::Stopped(double time) { return Fail(time, "stopped", verdict::Shortfall::kInterrupted); }

bool Runner::NotEstablished(double time, size_t claim) {
  attempt_.claim = claim;
  return Fail(time, fmt::format("`{}` is not established", stages_.problem().claims[claim].name));
}

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

void Runner::Keep(const Stage& stage, double from, double to, const interval::Box& during) {
  if (!options_.keep_tube || !claims_) return;
  interval::Box box(during.begin(), during.begin() + static_cast<std::ptrdiff_t>(box_.size()));
  for (size_t i = 0; i < box.size(); ++i) {
    if (stage.discrete[i]) box[i] = *stage.discrete[i];
  }
  attempt_.leaf.tube.push_back({from, to, std::move(box)});
}

// Are the errors out of proportion? Then what follows is not worth its time: smaller parts will be. What
// inputs do is the same in smaller parts: beside it, errors are compared with all of the initial set.
bool Runner::TooWide(const Flow& flow, double share) const {
  if (monomials_->symbols() == 0) return false;
  const bool driven = !stages_.problem().inputs.empty();
  constexpr double kDriven = 10;
  double worst = 0;
  for (size_t i = 0; i < box_.size(); ++i) {
    const double radius = RangeOf(*monomials_, flow.set().Polynomial(i)).Width() * 0.5;
    const double start = driven ? kDriven * whole_[i].Width() : box_[i].Width() * 0.5;
    const double error = flow.set().Error(i);
    if (symbol_of_[i] >= 0) worst = std::fmax(worst, error / std::fmax(radius, start));
  }
  return worst > share && flow.steps() > 10;
}

// Terms that start at most at zero and have not risen since, though rounding cannot tell them from zero.
void Runner::Fall(const Stage& stage, Stepper& stepper) {
  for (size_t i = 0; i < stage.claims.size(); ++i) {
    for (size_t atom = 0; atom < falls_[i].size(); ++atom) {
      if (falls_[i][atom]) falls_[i][atom] = stepper.StaysBelow(stage.claims[i].first + atom);
    }
  }
}

// Claims that hold at one instant only, and at the start all that begin there.
bool Runner::Instants(const Stage& stage, const FlowSet& set, Map& observe, double time, bool start) {
  if (!claims_) return true;
  bool applied = false;
  for (const StageClaim& claim : stage.claims) {
    if (claim.from != time || (!claim.instant && !start)) continue;
    if (!applied && !observe.Apply(set))
      return Fail(time, "a claim, or the condition of an event, is not defined on the whole set");
    applied = true;
    const verdict::Truth truth = claim.formula.Check([&](size_t atom) {
      const Interval range = observe.Range(claim.first + atom);
      return (start && claim.starts_below[atom]) || claim.implied[atom] ? AtMostZero(range) : range;
    });
    if (truth != verdict::Truth::kTrue) return NotEstablished(time, claim.claim);
  }
  return true;
}

// The claims during a step, which happens at some time of [from, to].
bool Runner::During(Flow& flow, const Stage& stage, double from, double to) {
  if (queries_ != nullptr) Answer(flow, stage, from, to);
  if (!claims_) return true;
  Stepper& stepper = flow.stepper();
  const bool falling = std::ranges::any_of(
      falls_, [](const std::vector<bool>& f) { return std::ranges::find(f, true) != f.end(); });
  if (falling) Fall(stage, stepper);
  const auto below = [&](size_t claim, size_t atom, Interval range) {
    const bool known = (falling && falls_[claim][atom]) || stage.claims[claim].implied[atom];
    return known ? AtMostZero(range) : range;
  };
  // Most claims are clear from the box of the step.
  interval::Box box = stepper.during();
  box.insert(box.end(), stage.dynamics.inputs.begin(), stage.dynamics.inputs.end());
  const std::vector<Interval> values = ValuesOn(stage.observed, box);
  for (size_t i = 0; i < stage.claims.size(); ++i) {
    const StageClaim& claim = stage.claims[i];
    if (claim.instant || claim.from >= to || claim.to <= from) continue;
    const auto check = [&](double begin, double end, bool tight) {
      return claim.formula.Check([&](size_t atom) {
        return below(i, atom, stepper.Observed(claim.first + atom, begin, end, tight));
      });
    };
    const double h = stepper.h();
    const auto on_box = [&](size_t atom) {
      return below(i, atom, values[stage.observed.outputs[claim.first + atom]]);
    };
    if (claim.formula.Check(on_box) == verdict::Truth::kTrue) continue;
    if (check(0, h, false) == verdict::Truth::kTrue) continue;
    // By polynomials, over shorter times where it is close.
    const std::function<bool(double, double, int)> established = [&](double begin, double end, int halvings) {
      if (check(begin, end, true) == verdict::Truth::kTrue) return true;
      const double middle = begin + (end - begin) / 2;
      return halvings > 0 && established(begin, middle, halvings - 1) &&
             established(middle, end, halvings - 1);
    };
    if (!established(0, h, kMostHalvings)) return NotEstablished(to, claim.claim);
  }
  return true;
}

// Where the polynomials are most curved; if nowhere, where they are widest.
void Runner::ChooseSplit(const FlowSet& set) {
  const size_t n = box_.size();
  std::vector<double> curved(n), linear(n);
  for (size_t i = 0; i < n; ++i) {
    const auto p = set.Polynomial(i);
    const double width = RangeOf(*monomials_, p).Width() + 1e-300;
    for (size_t m = 1; m < set.count; ++m) {
      const auto e = monomials_->Exponents(m);
      for (size_t v = 0; v < n; ++v) {
        if (symbol_of_[v] < 0 || e[static_cast<size_t>(symbol_of_[v])] == 0) continue;
        (monomials_->DegreeOf(m) > 1 ? curved : linear)[v] += std::fabs(p[m]) / width;
      }
    }
  }
  double widest = 0;
  const auto share = [&](size_t v) { return box_[v].Width() / std::max(whole_[v].Width(), 1e-300); };
  for (size_t v = 0; v < n; ++v) {
    if (symbol_of_[v] >= 0) widest = std::max(widest, share(v));
  }
  double best = -1;
  for (size_t v = 0; v < n; ++v) {
    if (symbol_of_[v] < 0 || IsCopy(v) || share(v) < 0.03 * widest) continue;
    const double weight = curved[v] + 0.01 * linear[v] + 1e-6 * share(v);
    if (weight > best) {
      best = weight;
      attempt_.split = v;
    }
  }
  attempt_.worst.resize(n);
  // Towards the side on which the state that failed last moves most: a guess, for trajectories.
  for (size_t v = 0; v < n; ++v) {
    double slope = 0;
    if (symbol_of_[v] >= 0) {
      for (size_t i = 0; i < n; ++i)
        slope += set.Polynomial(i)[monomials_->Symbol(static_cast<size_t>(symbol_of_[v]))];
    }
    // Just inside: bounds are rounded outwards.
    const double inset = 1e-9 * box_[v].Width();
    attempt_.worst[v] = slope > 0 ? box_[v].hi - inset : slope < 0 ? box_[v].lo + inset : box_[v].Middle();
  }
}

}  // namespace rondo::reach
