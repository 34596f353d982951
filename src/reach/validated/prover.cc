#include "reach/validated/prover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <random>
#include <set>

#include "base/parallel.h"
#include "expr/substitute.h"
#include "reach/system/bounds.h"
#include "reach/validated/map.h"

namespace rondo::reach {

namespace {

struct CompiledClaim {
  Formula formula;
  size_t first = 0;  ///< its terms among the observed outputs
  double from = 0, to = 0;
  bool instant = false;
  std::vector<bool> starts_below;  ///< by term: at most zero at the start, exactly, and does it never jump?
};

// Everything about a problem that all parts of the initial set share.
struct Compiled {
  const Problem* problem = nullptr;
  Dynamics dynamics;
  Program observed;  ///< the terms of all claims
  Program updates;
  std::vector<CompiledClaim> claims;
  Formula assumed;
  Program assumed_terms;
  std::vector<double> events;  ///< when claims begin or end, and the horizon
  double horizon = 0, period = 0;
  size_t samples = 0;  ///< how often the controller acts
};

base::Result<Compiled> CompileAll(const Problem& problem) {
  Compiled c;
  c.problem = &problem;
  expr::Arena& arena = *problem.arena;
  std::vector<TermId> variables = problem.states;
  for (const Input& i : problem.inputs) {
    variables.push_back(i.term);
    c.dynamics.inputs.push_back(i.bounds);
  }
  std::vector<TermId> terms;
  std::set<double> events;
  c.horizon = problem.horizon.ToDouble();
  events.insert(c.horizon);
  for (const Claim& claim : problem.claims) {
    auto formula = Normalise(arena, claim.formula);
    if (!formula.ok()) return base::Error{fmt::format("`{}`: {}", claim.name, formula.error().message)};
    CompiledClaim compiled;
    compiled.formula = std::move(formula).value();
    compiled.first = terms.size();
    compiled.from = claim.from.ToDouble();
    compiled.to = claim.to.ToDouble();
    compiled.instant = claim.from == claim.to;
    terms.insert(terms.end(), compiled.formula.terms.begin(), compiled.formula.terms.end());
    for (const double t : {compiled.from, compiled.to}) {
      if (t > 0 && t < c.horizon) events.insert(t);
    }
    c.claims.push_back(std::move(compiled));
  }
  std::vector<TermId> outputs = problem.rates;
  outputs.insert(outputs.end(), terms.begin(), terms.end());
  auto program = Compile(arena, variables, outputs, problem.rates.size());
  if (!program.ok()) return program.error();
  c.dynamics.program = std::move(program).value();
  c.dynamics.states = problem.states.size();
  auto observed = Compile(arena, variables, terms);
  if (!observed.ok()) return observed.error();
  c.observed = std::move(observed).value();
  if (problem.controller) {
    auto map = Compile(arena, variables, Updated(problem));
    if (!map.ok()) return map.error();
    c.updates = std::move(map).value();
    c.period = problem.controller->period.ToDouble();
    c.samples = Samples(problem);
  }
  auto assumed = Normalise(arena, problem.assume);
  if (!assumed.ok()) return assumed.error();
  c.assumed = std::move(assumed).value();
  auto assumed_terms = Compile(arena, problem.states, c.assumed.terms);
  if (!assumed_terms.ok()) return assumed_terms.error();
  c.assumed_terms = std::move(assumed_terms).value();
  // Terms that are at most zero at the start, whatever rounding says.
  const std::vector<TermId> necessary = Necessary(c.assumed);
  const std::set<TermId> known(necessary.begin(), necessary.end());
  expr::Substitution originals;
  for (size_t i = 0; i < problem.copy_of.size(); ++i) {
    if (problem.copy_of[i]) originals.emplace(problem.states[i], problem.states[*problem.copy_of[i]]);
  }
  for (CompiledClaim& claim : c.claims) {
    for (const TermId term : claim.formula.terms) {
      const TermId start = expr::Substitute(arena, term, originals);
      const bool number = arena.IsNumber(start) && !(arena.number(start) > Rational(0));
      // What a controller sets has another value as soon as it begins, and inputs at any time.
      const size_t at = claim.first + claim.starts_below.size();
      const bool continuous =
          std::ranges::none_of(c.observed.depends[c.observed.outputs[at]], [&](uint32_t v) {
            return v >= problem.states.size() ||
                   (problem.controller && problem.controller->updates[v].has_value());
          });
      claim.starts_below.push_back(claim.from == 0 && continuous && (number || known.contains(start)));
    }
  }
  c.events.assign(events.begin(), events.end());
  return c;
}

// What came of one part of the initial set.
struct Attempt {
  bool proved = false;
  bool vacuous = false;  ///< nothing in it satisfies what is assumed
  Leaf leaf;
  std::string reason;
  double time = 0;
  size_t claim = 0;
  size_t split = 0;           ///< the state whose side should be halved
  std::vector<double> worst;  ///< a start that seemed worst
};

// A side that is a point but for rounding needs no symbol.
bool IsThin(Interval side) {
  return side.Width() <= 1e-13 * std::fmax(std::fabs(side.lo), std::fabs(side.hi));
}

class Runner {
 public:
  Runner(const Compiled& compiled, const ProverOptions& options, const FlowOptions& flow,
         const interval::Box& box, const interval::Box& whole, const base::StopToken& stop)
      : c_(compiled), options_(options), flow_(flow), box_(box), whole_(whole), stop_(stop) {
    int symbols = 0;
    for (size_t i = 0; i < box.size(); ++i)
      symbol_of_.push_back(IsCopy(i) || IsThin(box[i]) ? -1 : symbols++);
    for (size_t i = 0; i < box.size(); ++i) {
      if (IsCopy(i)) symbol_of_[i] = symbol_of_[*c_.problem->copy_of[i]];
    }
    monomials_ = std::make_shared<Monomials>(static_cast<size_t>(symbols));
  }

  Attempt Run() {
    attempt_.leaf.initial = box_;
    if (CheckBox(c_.assumed_terms, c_.assumed, box_) == Truth::kFalse) {
      attempt_.proved = attempt_.vacuous = true;
      return std::move(attempt_);
    }
    FlowOptions flow_options = flow_;
    if (c_.period > 0) flow_options.most_step = std::min(flow_options.most_step, c_.period);
    flow_options.first_step = std::min(flow_options.first_step, c_.horizon);
    Flow flow(c_.dynamics, monomials_, flow_options, c_.horizon);
    flow.Start(FromBox(box_, *monomials_, symbol_of_), 0);
    Map observe(c_.observed, c_.dynamics.states, c_.dynamics.inputs, monomials_);
    std::optional<Map> control;
    if (c_.period > 0) control.emplace(c_.updates, c_.dynamics.states, c_.dynamics.inputs, monomials_);
    attempt_.proved = Follow(flow, observe, control);
    if (!attempt_.proved) ChooseSplit(flow);
    attempt_.leaf.final = flow.Now();
    return std::move(attempt_);
  }

 private:
  bool IsCopy(size_t i) const { return i < c_.problem->copy_of.size() && c_.problem->copy_of[i].has_value(); }

  bool Fail(const Flow& flow, std::string reason) {
    attempt_.reason = std::move(reason);
    attempt_.time = flow.time();
    return false;
  }

  bool Follow(Flow& flow, Map& observe, std::optional<Map>& control) {
    const auto capacity = options_.flow.generators_per_state * static_cast<Eigen::Index>(c_.dynamics.states);
    size_t event = 0;
    size_t sample = 0;
    while (flow.time() < c_.horizon) {
      if (sample < c_.samples && flow.time() >= c_.period * static_cast<double>(sample)) {
        FlowSet next;
        if (!control->Apply(flow.set())) return Fail(flow, "the controller is not defined on the whole set");
        control->Finish(flow.set(), next, capacity);
        flow.set() = std::move(next);
        ++sample;
      }
      if (flow.time() == 0 && !Instants(flow, observe, 0, true)) return false;
      while (event < c_.events.size() && c_.events[event] <= flow.time()) ++event;
      double until = event < c_.events.size() ? c_.events[event] : c_.horizon;
      if (sample < c_.samples) until = std::min(until, c_.period * static_cast<double>(sample));
      while (flow.time() < until) {
        if (stop_.StopRequested()) return Fail(flow, "stopped");
        if (!flow.Step(until)) return Fail(flow, "the set cannot be followed further");
        const Stepper& stepper = flow.stepper();
        attempt_.leaf.steps.emplace_back(stepper.h(), flow.set().degree);
        if (options_.keep_tube) attempt_.leaf.tube.push_back({flow.begin(), flow.time(), stepper.during()});
        if (!During(flow)) return false;
        if (TooWide(flow)) return Fail(flow, "the enclosure has become too wide");
      }
      if (!Instants(flow, observe, flow.time(), false)) return false;
    }
    return true;
  }

  // Are the errors out of proportion? Then what follows is not worth its time: smaller parts will be.
  bool TooWide(const Flow& flow) const {
    if (monomials_->symbols() == 0) return false;
    double worst = 0;
    for (size_t i = 0; i < flow.set().dimension; ++i) {
      const double radius = RangeOf(*monomials_, flow.set().Polynomial(i)).Width() * 0.5;
      const double start = box_[i].Width() * 0.5;
      const double error = flow.set().Error(i);
      if (symbol_of_[i] >= 0) worst = std::fmax(worst, error / std::fmax(radius, start));
    }
    return worst > 2 && flow.steps() > 10;
  }

  static Interval AtMostZero(Interval range) { return {std::min(range.lo, 0.0), std::min(range.hi, 0.0)}; }
  static Interval StartRange(const CompiledClaim& claim, size_t atom, bool start, Interval range) {
    return start && claim.starts_below[atom] ? AtMostZero(range) : range;
  }

  // Terms that start at most at zero and have not risen since, though rounding cannot tell them from zero.
  void Fall(Stepper& stepper) {
    falls_.resize(c_.claims.size());
    for (size_t i = 0; i < c_.claims.size(); ++i) {
      std::vector<bool>& falls = falls_[i];
      if (falls.empty()) falls = c_.claims[i].starts_below;
      for (size_t atom = 0; atom < falls.size(); ++atom) {
        if (falls[atom]) falls[atom] = stepper.StaysBelow(c_.claims[i].first + atom);
      }
    }
  }

  // Claims that hold at one instant only, and at the start all that begin there.
  bool Instants(Flow& flow, Map& observe, double time, bool start) {
    bool applied = false;
    for (size_t i = 0; i < c_.claims.size(); ++i) {
      const CompiledClaim& claim = c_.claims[i];
      if (claim.from != time || (!claim.instant && !start)) continue;
      if (!applied && !observe.Apply(flow.set()))
        return Fail(flow, "a claim is not defined on the whole set");
      applied = true;
      const Truth truth = claim.formula.Check(
          [&](size_t atom) { return StartRange(claim, atom, start, observe.Range(claim.first + atom)); });
      if (truth == Truth::kTrue) continue;
      attempt_.claim = i;
      return Fail(flow, fmt::format("`{}` is not established", c_.problem->claims[i].name));
    }
    return true;
  }

  bool During(Flow& flow) {
    Stepper& stepper = flow.stepper();
    const bool falling = std::ranges::any_of(c_.claims, [&](const CompiledClaim& claim) {
      const auto i = static_cast<size_t>(&claim - c_.claims.data());
      const std::vector<bool>& falls = i < falls_.size() ? falls_[i] : claim.starts_below;
      return std::ranges::find(falls, true) != falls.end();
    });
    if (falling) Fall(stepper);
    const auto below = [&](size_t claim, size_t atom, Interval range) {
      return falling && falls_[claim][atom] ? AtMostZero(range) : range;
    };
    // Most claims are clear from the box of the step.
    interval::Box box = stepper.during();
    box.insert(box.end(), c_.dynamics.inputs.begin(), c_.dynamics.inputs.end());
    const std::vector<Interval> values = ValuesOn(c_.observed, box);
    for (size_t i = 0; i < c_.claims.size(); ++i) {
      const CompiledClaim& claim = c_.claims[i];
      if (claim.instant || claim.from >= flow.time() || claim.to <= flow.begin()) continue;
      const auto check = [&](double from, double to, bool tight) {
        return claim.formula.Check([&](size_t atom) {
          return below(i, atom, stepper.Observed(claim.first + atom, from, to, tight));
        });
      };
      const double h = stepper.h();
      const auto on_box = [&](size_t atom) {
        return below(i, atom, values[c_.observed.outputs[claim.first + atom]]);
      };
      if (claim.formula.Check(on_box) == Truth::kTrue) continue;
      if (check(0, h, false) == Truth::kTrue) continue;
      if (check(0, h, true) == Truth::kTrue) continue;
      bool all = true;
      constexpr int kSlices = 8;
      for (int s = 0; s < kSlices && all; ++s)
        all = check(h * s / kSlices, s + 1 == kSlices ? h : h * (s + 1) / kSlices, true) == Truth::kTrue;
      if (all) continue;
      attempt_.claim = i;
      return Fail(flow, fmt::format("`{}` is not established", c_.problem->claims[i].name));
    }
    return true;
  }

  // Where the polynomials are most curved; if nowhere, where they are widest.
  void ChooseSplit(const Flow& flow) {
    const FlowSet& set = flow.set();
    const size_t n = set.dimension;
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

  const Compiled& c_;
  const ProverOptions& options_;
  const FlowOptions& flow_;
  const interval::Box& box_;
  const interval::Box& whole_;
  const base::StopToken& stop_;
  std::vector<int> symbol_of_;
  std::vector<std::vector<bool>> falls_;  ///< by claim and term
  std::shared_ptr<Monomials> monomials_;
  Attempt attempt_;
};

// Looks for a trajectory that breaks a claim: corners, middles of faces, points at random.
class Search {
 public:
  Search(const Problem& problem, const Compiled& compiled, const ProverOptions& options,
         Trajectories& trajectories, const base::StopToken& stop)
      : problem_(problem),
        compiled_(compiled),
        options_(options),
        trajectories_(trajectories),
        stop_(stop),
        random_(options.seed) {}

  std::optional<Refuted> Try(std::vector<double> start) {
    for (size_t i = 0; i < problem_.copy_of.size(); ++i) {
      if (problem_.copy_of[i]) start[i] = start[*problem_.copy_of[i]];
    }
    if (!MayStart(start)) return std::nullopt;
    Course course;
    course.start = std::move(start);
    const double horizon = compiled_.horizon;
    course.input_period = horizon / 16;
    if (!problem_.inputs.empty()) {
      const auto mode = random_() % 3;
      for (int slot = 0; slot < 16; ++slot) {
        std::vector<double> values;
        for (size_t i = 0; i < problem_.inputs.size(); ++i) {
          const Interval b = problem_.inputs[i].bounds;
          const bool up =
              mode == 0 && !course.inputs.empty() ? course.inputs.back()[i] == b.hi : random_() % 2 == 0;
          values.push_back(up ? b.hi : b.lo);
        }
        course.inputs.push_back(std::move(values));
      }
    }
    Violation worst = trajectories_.Worst(course, horizon / 400, 0, 1e-10, stop_);
    if (stop_.StopRequested()) return std::nullopt;
    if (worst.miss <= 0) {
      if (worst.miss > -1e299 && (!closest || worst.miss > closest->miss)) closest = worst;
      return std::nullopt;
    }
    Refuted refuted{std::move(course), std::move(worst), false};
    refuted.certain = Confirm(refuted);
    if (!refuted.certain && !Repeats(refuted)) return std::nullopt;
    return refuted;
  }

  // Is the start one that is assumed? For sure: exactly, or by enclosures.
  bool MayStart(const std::vector<double>& start) {
    expr::Arena& arena = *problem_.arena;
    expr::Substitution values;
    for (size_t i = 0; i < start.size(); ++i) {
      const bool pinned = i < problem_.pinned.size() && problem_.pinned[i].has_value();
      values.emplace(problem_.states[i], arena.Number(arena.Real(), pinned ? *problem_.pinned[i]
                                                                           : Rational::FromDouble(start[i])));
    }
    const TermId exact = expr::Substitute(arena, problem_.assume, values);
    if (exact == arena.True()) return true;
    if (exact == arena.False()) return false;
    return CheckBox(compiled_.assumed_terms, compiled_.assumed, StartBox(start)) == Truth::kTrue;
  }

  interval::Box StartBox(const std::vector<double>& start) const {
    interval::Box box;
    for (size_t i = 0; i < start.size(); ++i) {
      const bool pinned = i < problem_.pinned.size() && problem_.pinned[i].has_value();
      box.push_back(pinned ? Enclose(*problem_.pinned[i]) : Interval::Point(start[i]));
    }
    return box;
  }

  // A violation that could not be enclosed counts if it does not depend on how finely it was computed.
  bool Repeats(const Refuted& refuted) {
    const double horizon = compiled_.horizon;
    const Violation fine = trajectories_.Worst(refuted.course, horizon / 20000, 0, 1e-13, stop_);
    if (stop_.StopRequested() || fine.miss <= 0) return false;
    // Both stop at the first instant that they look at and see a violation: go on to the same one.
    double apart = 0;
    double miss = -1e300;
    std::vector<double> there;
    trajectories_.Run(
        refuted.course, horizon / 400,
        [&](double t, std::span<const double> x) {
          if (t < refuted.violation.time - 1e-12) return true;
          there.assign(x.begin(), x.end());
          return false;
        },
        1e-13);
    if (there.size() != refuted.violation.state.size()) return false;
    double size = 1;
    for (size_t i = 0; i < there.size(); ++i) {
      apart = std::fmax(apart, std::fabs(there[i] - refuted.violation.state[i]));
      size = std::fmax(size, std::fabs(there[i]));
    }
    miss = trajectories_.Miss(refuted.violation.claim, there);
    return miss > 1e-7 * size && miss > 100 * apart;
  }

  std::optional<Refuted> Run(const base::StopToken& stop) {
    const interval::Box& box = problem_.initial;
    const size_t n = box.size();
    size_t free = 0;
    for (const Interval& side : box) free += side.IsPoint() ? 0 : 1;
    for (size_t s = 0; s < options_.samples && !stop.StopRequested(); ++s) {
      std::vector<double> start(n);
      const bool corner = s < options_.samples / 2 && (free >= 16 || s < size_t{1} << free);
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
      // Bounds are rounded outwards: a corner may be just outside.
      if (corner && !MayStart(start)) {
        for (size_t i = 0; i < n; ++i) {
          const double inset = 1e-9 * box[i].Width();
          start[i] = std::clamp(start[i], box[i].lo + inset, box[i].hi - inset);
        }
      }
      if (auto refuted = Try(std::move(start))) return refuted;
    }
    return std::nullopt;
  }

  std::optional<Violation> closest;

 private:
  // Does the exact solution from this start break the claim at this time? Then the tube of the point says so.
  bool Confirm(const Refuted& refuted) {
    const interval::Box point = StartBox(refuted.course.start);
    Dynamics dynamics = compiled_.dynamics;
    auto monomials = std::make_shared<Monomials>(0);
    FlowOptions options = options_.flow;
    Flow flow(dynamics, monomials, options, compiled_.horizon);
    flow.Start(FromBox(point, *monomials, std::vector<int>(point.size(), -1)), 0);
    const auto hold = [&](double t) {
      if (refuted.course.inputs.empty()) {
        for (Interval& i : dynamics.inputs) i = Interval::Point(i.Middle());
        return;
      }
      const auto slot = std::min(refuted.course.inputs.size() - 1,
                                 static_cast<size_t>(std::floor(t / refuted.course.input_period + 1e-9)));
      for (size_t i = 0; i < dynamics.inputs.size(); ++i)
        dynamics.inputs[i] = Interval::Point(refuted.course.inputs[slot][i]);
    };
    const double end = refuted.violation.time;
    size_t sample = 0;
    while (true) {
      hold(flow.time());
      if (sample < compiled_.samples && flow.time() >= compiled_.period * static_cast<double>(sample) &&
          (flow.time() < end || end == 0)) {
        Map control(compiled_.updates, dynamics.states, dynamics.inputs, monomials);
        FlowSet next;
        if (!control.Apply(flow.set())) return false;
        control.Finish(flow.set(), next, 400);
        flow.set() = std::move(next);
        ++sample;
      }
      if (flow.time() >= end) break;
      double until = end;
      if (sample < compiled_.samples) until = std::min(until, compiled_.period * static_cast<double>(sample));
      if (!dynamics.inputs.empty()) {
        const double slot = std::floor(flow.time() / refuted.course.input_period + 1e-9) + 1;
        until = std::min(until, slot * refuted.course.input_period);
      }
      while (flow.time() < until) {
        if (stop_.StopRequested() || !flow.Step(until)) return false;
      }
    }
    Map observe(compiled_.observed, dynamics.states, dynamics.inputs, monomials);
    if (!observe.Apply(flow.set())) return false;
    const CompiledClaim& claim = compiled_.claims[refuted.violation.claim];
    return claim.formula.Check([&](size_t atom) { return observe.Range(claim.first + atom); }) ==
           Truth::kFalse;
  }

  const Problem& problem_;
  const Compiled& compiled_;
  const ProverOptions& options_;
  Trajectories& trajectories_;
  const base::StopToken& stop_;
  std::mt19937_64 random_;
};

}  // namespace

base::Result<Outcome> Decide(const Problem& problem, const ProverOptions& options,
                             const base::StopToken& stop) {
  auto made = CompileAll(problem);
  if (!made.ok()) return made.error();
  const Compiled compiled = std::move(made).value();
  auto found = Trajectories::Of(problem);
  if (!found.ok()) return found.error();
  Trajectories trajectories = std::move(found).value();
  Search search(problem, compiled, options, trajectories, stop);

  std::vector<interval::Box> open{problem.initial};
  Proved proved;
  std::string reason;
  bool searched = false;
  FlowOptions flow = options.flow;
  size_t done = 0;
  while (!open.empty()) {
    std::vector<Attempt> attempts(open.size());
    base::ParallelFor(open.size(), options.jobs, [&](size_t i) {
      if (stop.StopRequested()) {
        attempts[i].reason = "stopped";
        return;
      }
      attempts[i] = Runner(compiled, options, flow, open[i], problem.initial, stop).Run();
    });
    std::vector<interval::Box> next;
    for (size_t i = 0; i < attempts.size(); ++i) {
      Attempt& a = attempts[i];
      if (a.proved) {
        ++done;
        proved.steps += a.leaf.steps.size();
        if (!a.vacuous) proved.leaves.push_back(std::move(a.leaf));
        continue;
      }
      reason = a.time > 0 ? fmt::format("{}, at {:.4g} s", a.reason, a.time) : a.reason;
      if (a.reason == "stopped")
        return Outcome{Undecided{"stopped", search.closest, std::move(proved.leaves)}};
      if (!a.worst.empty()) {
        if (auto refuted = search.Try(a.worst)) return Outcome{std::move(*refuted)};
      }
      if (!searched) {
        searched = true;
        if (auto refuted = search.Run(stop)) return Outcome{std::move(*refuted)};
      }
      const Interval side = open[i][a.split];
      const double middle = side.Middle();
      if (side.IsPoint() || middle <= side.lo || middle >= side.hi ||
          side.Width() < 1e-4 * problem.initial[a.split].Width())
        return Outcome{Undecided{reason, search.closest, std::move(proved.leaves)}};
      for (const Interval half : {Interval{side.lo, middle}, Interval{middle, side.hi}}) {
        next.push_back(open[i]);
        next.back()[a.split] = half;
        for (size_t k = 0; k < problem.copy_of.size(); ++k) {
          if (problem.copy_of[k] == a.split) next.back()[k] = half;
        }
      }
    }
    if (done + next.size() > options.most_leaves)
      return Outcome{Undecided{reason + ", with the most parts that are allowed", search.closest,
                               std::move(proved.leaves)}};
    open = std::move(next);
    // The whole deserves care; of parts, many cheap ones are better.
    flow.most_monomials = std::min<size_t>(flow.most_monomials, 260);
    flow.linear_tolerance = std::max(flow.linear_tolerance, 0.5);
    if (options.progress) options.progress(done, open.size());
  }
  return Outcome{std::move(proved)};
}

}  // namespace rondo::reach
