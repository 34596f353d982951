// Events that a whole set meets transversally.
#include <algorithm>
#include <cmath>

#include "reach/validated/around.h"
#include "reach/validated/runner.h"
#include "reach/validated/series/bound.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

using Polynomial = std::vector<double>;

constexpr size_t kMostProbes = 2000;

Polynomial Times(const Monomials& monomials, const Polynomial& a, const Polynomial& b) {
  Polynomial out(a.size(), 0.0);
  const auto begin = monomials.pair_begin();
  for (size_t k = 0; k < out.size(); ++k) {
    for (uint32_t p = begin[k]; p < begin[k + 1]; ++p)
      out[k] += a[monomials.left()[p]] * b[monomials.right()[p]];
  }
  return out;
}

// a / b, roughly: b is nearly constant.
Polynomial Divide(const Monomials& monomials, const Polynomial& a, const Polynomial& b, size_t degree) {
  const double c = b[0];
  Polynomial rest = b;
  for (double& x : rest) x /= -c;
  rest[0] = 0;
  Polynomial term = a;
  for (double& x : term) x /= c;
  Polynomial sum = term;
  for (size_t k = 0; k < degree; ++k) {
    term = Times(monomials, term, rest);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += term[i];
  }
  return sum;
}

}  // namespace

// A set in one mode meets one event. Its condition may be made of several comparisons, as long as all of them
// but one are decided wherever it is looked at.
//
// With a time q(s) for each start, the flow of q f over one unit of "time" leads each start to the boundary
// of the condition, but for a residual. The flow of f' in the mode after, for the same time T for all of
// them, lets them get over what the event has set off; then that of (W - q) f' leads all to the same instant,
// W + T after the beginning. The true instant of the event differs from q(s) by at most the residual over the
// least rate, and the true trajectory from the enclosed one by at most that times |f - f'|.
class Runner::Crossing {
 public:
  Crossing(Runner& runner, State& state, const Stage& stage) : r_(runner), state_(state), before_(stage) {}

  Next Run(double until) {
    if (!Probe(until)) return Next::kNo;
    auto scaled = r_.stages_.For(before_.modes, true);
    auto after = r_.stages_.For({guard_->after}, true);
    auto plain = r_.stages_.For({guard_->after});
    if (!scaled.ok() || !after.ok() || !plain.ok()) return Next::kNo;
    if (!FindTime(*scaled.value())) return Next::kNo;
    const size_t kept = r_.attempt_.leaf.tube.size();
    StepRecord record{.kind = StepRecord::Kind::kCross, .length = window_, .event = guard_->event};
    // Once more, looking at claims.
    end_ = begin_ + window_;
    FlowSet there;
    Next next = Move(*scaled.value(), Extended(state_.set, time_), 1, true, there);
    if (next == Next::kChanged) next = Switch(*scaled.value(), *after.value(), there);
    left_ = guard_->formula.terms[term_];
    guard_ = nullptr;
    const double together = std::min(window_, 0.99 * (until - end_));
    end_ += together;
    if (next == Next::kChanged && together > 0)
      next = Move(*plain.value(), FlowSet(there), together, true, there);
    if (next == Next::kChanged) {
      Polynomial rest = time_;
      for (double& x : rest) x = -x;
      rest[0] += window_;
      next = Move(*after.value(), Extended(there, rest), 1, true, there);
    }
    if (next != Next::kChanged) {
      r_.attempt_.leaf.tube.resize(kept);
      return next;
    }
    record.together = std::max(together, 0.0);
    record.degree = there.degree;
    for (size_t m = 0; m < time_.size(); ++m) {
      const auto exponents = r_.monomials_->Exponents(m);
      if (time_[m] != 0) record.time.emplace_back(std::vector(exponents.begin(), exponents.end()), time_[m]);
    }
    r_.attempt_.leaf.steps.push_back(std::move(record));
    state_.set = std::move(there);
    state_.time = end_;
    state_.possible = {{after.value()->modes[0], {}}};
    return next;
  }

  // The symbol that the time of the event depends on most, if all of the set meets it.
  std::optional<size_t> Decisive() const { return decisive_; }

 private:
  static std::function<Interval(size_t)> RangesIn(const Guard& guard, Flow& flow) {
    return [&stepper = flow.stepper(), &guard](size_t atom) {
      return stepper.Observed(guard.first + atom, 0, stepper.h(), true);
    };
  }
  // An event of the mode after that leads back, and whose condition is the negation of the one that was met:
  // it holds for the instant of the switch at most, if its term rises then. Back in the mode before, the
  // first event would follow at once.
  bool Returns(const Guard& g) const {
    const TermId term = guard_ != nullptr ? guard_->formula.terms[term_] : left_;
    return g.IsComparison() && g.after == before_.modes[0] &&
           r_.stages_.AreOpposite(g.formula.terms[0], term);
  }
  size_t Output() const { return guard_->first + term_; }

  // How long until all of the set has met the event, if it does so with a definite rate? Which event?
  bool Probe(double until) {
    begin_ = state_.time;
    // The event may be met later than in the first step: then again, now that it is known; and with steps
    // that do not reach the next instant before all have met it.
    if (Probe(until, false, 1) || (guard_ != nullptr && Probe(until, true, 1))) return true;
    return falls_ && (Probe(until, true, 1.0 / 8) || Probe(until, true, 1.0 / 64));
  }

  // `share`: how much of the time until then a step may last.
  bool Probe(double until, bool known, double share) {
    FlowOptions options = r_.OptionsFor(state_.step);
    options.most_step = std::min(options.most_step, share * (until - begin_));
    options.first_step = std::min(options.first_step, options.most_step);
    falls_ = false;
    Flow flow(before_.dynamics, r_.monomials_, options, r_.stages_.horizon());
    flow.Start(state_.set, begin_);
    Map observe(before_.observed, before_.dynamics.states, before_.dynamics.inputs, r_.monomials_);
    least_rate_ = HUGE_VAL;
    bool all = false;
    for (size_t probe = 0; probe < kMostProbes && flow.time() < until; ++probe) {
      if (r_.stop_.StopRequested() || !flow.Step(until)) return false;
      for (const Guard& g : before_.guards) {
        if (r_.During(g, flow) == verdict::Truth::kFalse) continue;
        if (guard_ == nullptr) {
          const auto term = g.formula.Deciding(RangesIn(g, flow));
          if (!term) return false;
          guard_ = &g;
          term_ = *term;
        }
        if (&g != guard_ || !g.formula.ComesDownTo(term_, RangesIn(g, flow))) return false;
      }
      if (guard_ == nullptr) continue;
      if (!known && probe > 0) return false;
      known = true;
      const Interval rate = flow.stepper().ObservedRate(Output());
      if (!(rate.hi < 0)) return false;
      falls_ = true;
      least_rate_ = std::min(least_rate_, -rate.hi);
      window_ = flow.time() - begin_;
      if (all) return flow.time() < until;  // one step more than necessary
      if (!observe.Apply(flow.set())) return false;
      all = observe.Range(Output()).hi < 0;
    }
    return false;
  }

  // Follows a set for a while, during [begin_, end_] of the time that counts. kChanged: done.
  Next Move(const Stage& stage, FlowSet from, double duration, bool keep, FlowSet& to) {
    FlowOptions options = r_.flow_;
    options.first_step = 1e-3 * duration;
    // That the factor differs between trajectories widens the linear part, however short the steps are.
    options.linear_tolerance = HUGE_VAL;
    Flow flow(stage.dynamics, r_.monomials_, options, duration);
    flow.Start(std::move(from), 0);
    if (keep) {
      r_.falls_.clear();
      for (const StageClaim& claim : stage.claims) r_.falls_.emplace_back(claim.starts_below.size(), false);
    }
    while (flow.time() < duration) {
      if (r_.stop_.StopRequested()) {
        r_.Stopped(begin_);
        return Next::kFailed;
      }
      if (!flow.Step(duration) || r_.TooWide(flow, 0.1)) return Next::kNo;
      if (!keep) continue;
      for (const Guard& g : stage.guards) {
        if (r_.During(g, flow) == verdict::Truth::kFalse) continue;
        if (guard_ == nullptr && Returns(g) && flow.stepper().ObservedRate(g.first).lo > 0) continue;
        const bool expected = guard_ != nullptr && g.event == guard_->event;
        if (!expected || !g.formula.ComesDownTo(term_, RangesIn(g, flow))) return Next::kNo;
      }
      r_.Keep(stage, begin_, end_, flow.stepper().during());
      if (!r_.During(flow, stage, begin_, end_)) return Next::kFailed;
    }
    to = Reduced(flow.set());
    return Next::kChanged;
  }

  FlowSet Extended(const FlowSet& from, const Polynomial& factor) const {
    FlowSet set = from;
    size_t degree = set.degree;
    while (r_.monomials_->Count(degree) < factor.size()) ++degree;
    if (degree > set.degree) set.Raise(*r_.monomials_, degree);
    const size_t n = set.dimension;
    set.dimension = n + 1;
    set.polynomials.resize((n + 1) * set.count, 0.0);
    std::copy(factor.begin(), factor.end(), set.Polynomial(n).begin());
    set.generators.conservativeResize(static_cast<Eigen::Index>(n + 1), Eigen::NoChange);
    set.generators.row(static_cast<Eigen::Index>(n)).setZero();
    set.slack.push_back(0);
    return set;
  }

  // Without the factor, if it has one.
  FlowSet Reduced(const FlowSet& from) const {
    FlowSet set = from;
    if (set.dimension == before_.dynamics.states) return set;
    --set.dimension;
    set.polynomials.resize(set.dimension * set.count);
    set.generators.conservativeResize(static_cast<Eigen::Index>(set.dimension), Eigen::NoChange);
    set.slack.pop_back();
    return set;
  }

  // The term of the event and its rate as polynomials of the start, roughly. False if they are not defined.
  bool Term(const FlowSet& set, Polynomial& value, Polynomial& rate) {
    const Program& p = before_.dynamics.program;
    const size_t n = before_.dynamics.states;
    std::vector<Branch> branches(p.code.size(), Branch::kFirst);
    std::vector<Interval> held(p.code.size());
    BoxSeries middle(p, 1);
    ModelSeries series(p, r_.monomials_, 2);
    series.Begin(set.degree, 1);
    for (size_t i = 0; i < n; ++i) {
      series.SetVariable(i, 0, set.Polynomial(i), 0);
      middle.SetVariable(i, 0, Interval::Point(set.Polynomial(i)[0]));
    }
    for (size_t w = 0; w < before_.dynamics.inputs.size(); ++w) {
      const double nominal = before_.dynamics.inputs[w].Middle();
      series.SetVariable(n + w, 0, std::span(&nominal, 1), 0);
      series.SetVariable(n + w, 1, {}, 0);
      middle.SetVariable(n + w, 0, Interval::Point(nominal));
    }
    if (!middle.Decide(branches, held) || !series.Compute(0, branches, held)) return false;
    for (size_t i = 0; i < n; ++i) series.SetFromDerivative(i, i, 0);
    if (!series.Compute(1, branches, held)) return false;
    const size_t node = p.outputs[n + Output()];
    const auto of = [&](size_t order) {
      const auto model = series.At(node, order).polynomial;
      return Polynomial(model.begin(), model.end());
    };
    value = of(0);
    rate = of(1);
    return true;
  }

  // Newton's method for polynomials: the time until the term of the event is zero. Any polynomial would be
  // sound.
  bool FindTime(const Stage& scaled) {
    const Monomials& monomials = *r_.monomials_;
    Polynomial value, rate;
    if (!Term(state_.set, value, rate)) return false;
    double most = 0;
    for (size_t s = 0; s < monomials.symbols(); ++s) {
      const double slope = std::fabs(value[monomials.Symbol(s)]);
      if (slope > most) {
        most = slope;
        decisive_ = s;
      }
    }
    Polynomial time(state_.set.count, 0.0);
    time[0] = window_ / 2;
    double best = HUGE_VAL;
    for (int round = 0; round < 10; ++round) {
      FlowSet there;
      if (Move(scaled, Extended(state_.set, time), 1, false, there) != Next::kChanged ||
          !Term(there, value, rate))
        break;
      const double miss = Magnitude(RangeOf(monomials, value));
      const bool better = miss < 0.5 * best;
      if (miss < best) {
        time_ = time;
        best = miss;
      }
      if (!better && round > 1) break;
      time.resize(there.count, 0.0);
      const Polynomial change = Divide(monomials, value, rate, there.degree);
      double largest = 0;
      for (size_t i = 0; i < time.size(); ++i) {
        time[i] -= change[i];
        largest = std::fmax(largest, std::fabs(change[i]));
      }
      if (!std::isfinite(largest) || largest < 1e-14 * window_) break;
    }
    if (time_.empty()) return false;
    const Interval range = RangeOf(monomials, time_);
    return range.lo > 0 && range.hi < window_;
  }

  // A box of a scaled stage, where the factor is one.
  static interval::Box AtOne(interval::Box box) {
    box.push_back(Interval::Point(1));
    return box;
  }

  // From the mode before to the mode after, where the set is. kChanged: `there` encloses the starts of the
  // flow after.
  Next Switch(const Stage& before, const Stage& after, FlowSet& there) {
    const size_t n = there.dimension;
    Map observe(before_.observed, n, before_.dynamics.inputs, r_.monomials_);
    if (!observe.Apply(there)) return Next::kNo;
    const double late = Above(Magnitude(observe.Range(Output())) / Below(least_rate_));
    // A box that no trajectory leaves within twice that time, whatever mode it is in.
    interval::Box box(n), rates(n), jumps(n);
    for (size_t i = 0; i < n; ++i) {
      const double error = there.Error(i);
      box[i] = RangeOf(*r_.monomials_, there.Polynomial(i)) + Interval{-error, error};
    }
    const interval::Box start = box;
    const Interval time{-2 * late, 2 * late};
    bool inside = false;
    for (int attempt = 0; attempt < 20 && !inside; ++attempt) {
      const interval::Box all = AtOne(box);
      if (!RatesOn(before, all, rates) || !RatesOn(after, all, jumps)) return Next::kNo;
      inside = true;
      for (size_t i = 0; i < n; ++i) {
        const Interval difference = rates[i] - jumps[i];
        rates[i] = interval::Hull(rates[i], jumps[i]);
        jumps[i] = difference;
        const Interval reached = start[i] + time * rates[i];
        if (!std::isfinite(reached.lo) || !std::isfinite(reached.hi)) return Next::kNo;
        if (box[i].lo <= reached.lo && reached.hi <= box[i].hi) continue;
        inside = false;
        const double more = 0.1 * reached.Width() + 1e-300;
        box[i] = reached + Interval{-more, more};
      }
    }
    if (!inside) return Next::kNo;
    for (const Guard& g : after.guards) {
      if (Returns(g) && !RisesOn(after, AtOne(box), g)) return Next::kNo;
    }
    // What holds meanwhile.
    FlowSet around = there;
    for (size_t i = 0; i < n; ++i) around.slack[i] = Above(around.slack[i] + 2 * late * Magnitude(rates[i]));
    for (const Stage* stage : {&before, &after}) {
      const Next held = Holds(*stage, around, stage == &before);
      if (held != Next::kChanged) return held;
      r_.Keep(*stage, begin_, end_, box);
    }
    // The sum of both times is the window, but for roundings.
    const double rounded = 0x1p-48 * (begin_ + 2 * window_);
    for (size_t i = 0; i < n; ++i)
      there.slack[i] = Above(there.slack[i] + late * Magnitude(jumps[i]) + rounded * Magnitude(rates[i]));
    return Next::kChanged;
  }

  Next Holds(const Stage& stage, const FlowSet& around, bool is_before) {
    Map observe(stage.observed, stage.dynamics.states, stage.dynamics.inputs, r_.monomials_);
    const Polynomial one{1};
    const FlowSet set = Extended(around, one);
    if (!observe.Apply(set)) return Next::kNo;
    for (const Guard& g : stage.guards) {
      const auto range = [&](size_t atom) { return observe.Range(g.first + atom); };
      const bool expected = is_before && g.event == guard_->event;
      if (!is_before && Returns(g)) continue;
      if (expected ? !g.formula.ComesDownTo(term_, range) : g.formula.Check(range) != verdict::Truth::kFalse)
        return Next::kNo;
    }
    for (const StageQuery& q : stage.queries) {
      if (r_.queries_ == nullptr) break;
      Interval& answer = r_.answers_[q.query];
      const Query& query = (*r_.queries_)[q.query];
      if (query.from <= end_ && query.to >= begin_) answer = interval::Hull(answer, observe.Range(q.output));
    }
    if (!r_.claims_) return Next::kChanged;
    for (const StageClaim& claim : stage.claims) {
      if (claim.instant || claim.from >= end_ || claim.to <= begin_) continue;
      const verdict::Truth holds = claim.formula.Check([&](size_t atom) {
        const Interval range = observe.Range(claim.first + atom);
        return claim.implied[atom] ? AtMostZero(range) : range;
      });
      if (holds == verdict::Truth::kTrue) continue;
      r_.NotEstablished(end_, claim.claim);
      return Next::kFailed;
    }
    return Next::kChanged;
  }

  Runner& r_;
  State& state_;
  const Stage& before_;
  const Guard* guard_ = nullptr;
  size_t term_ = 0;    ///< of the guard: the one that decides
  TermId left_;        ///< that one, once it has been met
  double begin_ = 0;   ///< of what is looked at, seconds
  double window_ = 0;  ///< all of the set meets the event within it
  double end_ = 0;
  double least_rate_ = 0;
  bool falls_ = false;  ///< the term, wherever the event may happen
  Polynomial time_;
  std::optional<size_t> decisive_;
};

// `symbol`: which one the time of the event depends on most, if it is known.
Runner::Next Runner::Cross(State& state, const Stage& stage, double until, std::optional<size_t>& symbol) {
  if (state.possible.size() != 1) return Next::kNo;
  Crossing crossing(*this, state, stage);
  const Next next = crossing.Run(until);
  symbol = crossing.Decisive();
  return next;
}

}  // namespace rondo::reach
