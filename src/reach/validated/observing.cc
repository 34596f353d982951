#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reach/problem/bounds.h"
#include "reach/validated/runner.h"
#include "reach/validated/series/bound.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

constexpr int kMostHalvings = 6;  // of the time of a step, for a claim
constexpr int kSlices = 16;       // of the time of a step, for a query

}  // namespace

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

bool Runner::NotEstablished(double time, size_t claim) {
  attempt_.claim = claim;
  return Fail(time, fmt::format("`{}` is not established", stages_.problem().claims[claim].name));
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
  if (options_.wide || monomials_->symbols() == 0) return false;
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
