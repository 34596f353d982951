#include "reach/validated/search.h"

#include <algorithm>
#include <cmath>

#include "expr/substitute.h"
#include "reach/problem/bounds.h"
#include "reach/validated/runner.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

// By which errors are measured.
double SizeOf(const std::vector<double>& state) {
  double size = 1;
  for (const double x : state) size = std::fmax(size, std::fabs(x));
  return size;
}

}  // namespace

// Points at random satisfy no equation, such as `x == x0`. Of several states in one, the first is determined.
void Search::FindEquations() {
  expr::Arena& arena = *problem_.arena;
  std::vector<TermId> terms = Necessary(stages_.assumed());
  while (!terms.empty()) {
    const TermId term = terms.back();
    terms.pop_back();
    // term <= 0 and -term <= 0, once.
    if (std::erase(terms, arena.Neg(term)) == 0) continue;
    for (size_t i = 0; i < problem_.states.size(); ++i) {
      const bool copy = i < problem_.copy_of.size() && problem_.copy_of[i];
      if (copy || problem_.initial[i].IsPoint() ||
          std::ranges::find(equations_, i, &Equation::state) != equations_.end())
        continue;
      const auto line = LineIn(arena, term, problem_.states[i]);
      if (!line) continue;
      const TermId factor = arena.Number(arena.Real(), Rational(-1) / line->slope);
      equations_.push_back({i, arena.Mul(factor, line->rest)});
      break;
    }
  }
}

void Search::Solve(std::vector<double>& start) const {
  expr::Arena& arena = *problem_.arena;
  for (const Equation& e : equations_) {
    expr::Substitution values;
    for (size_t i = 0; i < start.size(); ++i)
      values.emplace(problem_.states[i], arena.Number(arena.Real(), Rational::FromDouble(start[i])));
    const TermId value = expr::Substitute(arena, e.value, values);
    if (arena.IsNumber(value)) start[e.state] = NearestConstant(arena.number(value)).factor;
  }
}

std::optional<Refuted> Search::Try(std::vector<double> start) {
  for (size_t i = 0; i < problem_.copy_of.size(); ++i) {
    if (problem_.copy_of[i]) start[i] = start[*problem_.copy_of[i]];
  }
  if (!MayStart(start)) return std::nullopt;
  Execution execution;
  execution.start = std::move(start);
  const double horizon = stages_.horizon();
  execution.input_period = horizon / 16;
  if (!problem_.inputs.empty()) {
    const auto mode = random_() % 3;
    for (int slot = 0; slot < 16; ++slot) {
      std::vector<double> values;
      for (size_t i = 0; i < problem_.inputs.size(); ++i) {
        const Interval b = problem_.inputs[i].bounds;
        const bool up =
            mode == 0 && !execution.inputs.empty() ? execution.inputs.back()[i] == b.hi : random_() % 2 == 0;
        values.push_back(up ? b.hi : b.lo);
      }
      execution.inputs.push_back(std::move(values));
    }
  }
  // The first miss may be so small that nothing can be made of it: another may follow, of this claim or of
  // another.
  double margin = 0;
  for (const double next : {1e-6, 1e-3, 0.0}) {
    Violation worst = trajectories_.Worst(execution, horizon / 400, margin, 1e-10, stop_);
    if (stop_.StopRequested()) return std::nullopt;
    if (worst.miss <= 0) {
      if (worst.miss > -1e299 && (!closest_ || worst.miss > closest_->miss)) closest_ = worst;
      return std::nullopt;
    }
    if (worst.miss <= margin) return std::nullopt;
    const double size = SizeOf(worst.state);
    // Events shift instants: so small a miss is the integrator's.
    const bool clear = problem_.events.empty() || worst.miss > 1e-9 * size;
    if (clear) {
      Refuted refuted{execution, std::move(worst), false};
      refuted.certain = Confirm(refuted);
      if (refuted.certain || Repeats(refuted, margin)) return refuted;
    }
    margin = next * size;
  }
  return std::nullopt;
}

// Is the start one that is assumed? For sure: exactly, or by enclosures.
bool Search::MayStart(const std::vector<double>& start) {
  expr::Arena& arena = *problem_.arena;
  expr::Substitution values;
  for (size_t i = 0; i < start.size(); ++i) {
    const bool pinned = i < problem_.pinned.size() && problem_.pinned[i].has_value();
    values.emplace(problem_.states[i],
                   arena.Number(arena.Real(), pinned ? *problem_.pinned[i] : Rational::FromDouble(start[i])));
  }
  const TermId exact = expr::Substitute(arena, problem_.assume, values);
  if (exact == arena.True()) return true;
  if (exact == arena.False()) return false;
  return CheckBox(stages_.assumed_terms(), stages_.assumed(), StartBox(start)) == verdict::Truth::kTrue;
}

interval::Box Search::StartBox(const std::vector<double>& start) const {
  interval::Box box;
  for (size_t i = 0; i < start.size(); ++i) {
    const bool pinned = i < problem_.pinned.size() && problem_.pinned[i].has_value();
    box.push_back(pinned ? Enclose(*problem_.pinned[i]) : Interval::Point(start[i]));
  }
  return box;
}

// A violation that could not be enclosed counts if it does not depend on how finely it was computed.
bool Search::Repeats(const Refuted& refuted, double margin) {
  const double horizon = stages_.horizon();
  const Violation fine = trajectories_.Worst(refuted.execution, horizon / 20000, margin, 1e-13, stop_);
  if (stop_.StopRequested() || fine.miss <= 0) return false;
  if (!problem_.events.empty()) {
    // Events shift instants: both runs have to break the claim clearly, and nearly at the same time.
    const double size = SizeOf(fine.state);
    return fine.claim == refuted.violation.claim && fine.miss > 1e-7 * size &&
           refuted.violation.miss > 1e-7 * size &&
           std::fabs(fine.time - refuted.violation.time) <= horizon / 100;
  }
  // Both stop at the first instant that they look at and see a violation: go on to the same one.
  double apart = 0;
  std::vector<double> there;
  trajectories_.Run(
      refuted.execution, horizon / 400,
      [&](double t, std::span<const double> x) {
        if (t < refuted.violation.time - 1e-12) return true;
        there.assign(x.begin(), x.end());
        return false;
      },
      1e-13);
  if (there.size() != refuted.violation.state.size()) return false;
  for (size_t i = 0; i < there.size(); ++i)
    apart = std::fmax(apart, std::fabs(there[i] - refuted.violation.state[i]));
  const double size = SizeOf(there);
  const double miss = trajectories_.Miss(refuted.violation.claim, there);
  return miss > 1e-7 * size && miss > 100 * apart;
}

std::optional<Refuted> Search::Run(size_t samples) {
  const interval::Box& box = problem_.initial;
  const size_t n = box.size();
  size_t free = 0;
  for (const Interval& side : box) free += side.IsPoint() ? 0 : 1;
  for (size_t s = 0; s < samples && !stop_.StopRequested(); ++s) {
    std::vector<double> start(n);
    const bool corner = s < samples / 2 && (free >= 16 || s < size_t{1} << free);
    size_t bit = 0;
    for (size_t i = 0; i < n; ++i) {
      if (box[i].IsPoint()) {
        start[i] = box[i].lo;
      } else if (corner) {
        const bool up = free < 16 ? (s >> bit) % 2 == 1 : random_() % 2 == 1;
        start[i] = up ? box[i].hi : box[i].lo;
        ++bit;
      } else {
        const double u = static_cast<double>(random_() >> 11) * 0x1p-53;
        start[i] = std::min(box[i].hi, box[i].lo + u * (box[i].hi - box[i].lo));
      }
    }
    Solve(start);
    // Bounds are rounded outwards: a corner may be just outside.
    if (corner && !MayStart(start)) {
      for (size_t i = 0; i < n; ++i) {
        const double inset = 1e-9 * box[i].Width();
        start[i] = std::clamp(start[i], box[i].lo + inset, box[i].hi - inset);
      }
      Solve(start);
    }
    if (auto refuted = Try(std::move(start))) return refuted;
  }
  return std::nullopt;
}

// Does the exact solution from this start break the claim at this time? Then the tube of the point says so.
bool Search::Confirm(const Refuted& refuted) {
  if (!problem_.events.empty()) return ConfirmWithEvents(refuted);
  const auto made = stages_.For({stages_.modes().start()});
  const Stage& stage = *made.value();
  const interval::Box point = StartBox(refuted.execution.start);
  Dynamics dynamics = stage.dynamics;
  auto monomials = std::make_shared<Monomials>(0);
  FlowOptions options = options_.flow;
  Flow flow(dynamics, monomials, options, stages_.horizon());
  flow.Start(FromBox(point, *monomials, std::vector<int>(point.size(), -1)), 0);
  const auto hold = [&](double t) {
    if (refuted.execution.inputs.empty()) {
      for (Interval& i : dynamics.inputs) i = Interval::Point(i.Middle());
      return;
    }
    const auto slot = std::min(refuted.execution.inputs.size() - 1,
                               static_cast<size_t>(std::floor(t / refuted.execution.input_period + 1e-9)));
    for (size_t i = 0; i < dynamics.inputs.size(); ++i)
      dynamics.inputs[i] = Interval::Point(refuted.execution.inputs[slot][i]);
  };
  const double end = refuted.violation.time;
  size_t sample = 0;
  while (true) {
    hold(flow.time());
    if (sample < stages_.samples() && flow.time() >= stages_.period() * static_cast<double>(sample) &&
        (flow.time() < end || end == 0)) {
      Map control(stage.updates, dynamics.states, dynamics.inputs, monomials);
      FlowSet next;
      if (!control.Apply(flow.set())) return false;
      control.Finish(flow.set(), next, 400);
      flow.set() = std::move(next);
      ++sample;
    }
    if (flow.time() >= end) break;
    double until = end;
    if (sample < stages_.samples()) until = std::min(until, stages_.period() * static_cast<double>(sample));
    if (!dynamics.inputs.empty()) {
      const double slot = std::floor(flow.time() / refuted.execution.input_period + 1e-9) + 1;
      until = std::min(until, slot * refuted.execution.input_period);
    }
    while (flow.time() < until) {
      if (stop_.StopRequested() || !flow.Step(until)) return false;
    }
  }
  Map observe(stage.observed, dynamics.states, dynamics.inputs, monomials);
  if (!observe.Apply(flow.set())) return false;
  const StageClaim& claim = stage.claims[refuted.violation.claim];
  return claim.formula.Check([&](size_t atom) { return observe.Range(claim.first + atom); }) ==
         verdict::Truth::kFalse;
}

// The same where events happen, for what no input drives.
bool Search::ConfirmWithEvents(const Refuted& refuted) {
  if (!problem_.inputs.empty() || refuted.violation.time <= 0) return false;
  const interval::Box point = StartBox(refuted.execution.start);
  Runner runner(stages_, options_, options_.flow, point, problem_.initial, stop_);
  return runner.Breaks(refuted.violation.claim, refuted.violation.time);
}

}  // namespace rondo::reach
