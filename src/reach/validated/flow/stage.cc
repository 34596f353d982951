#include "reach/validated/flow/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "reach/problem/bounds.h"

namespace rondo::reach {

base::Result<std::unique_ptr<Stages>> Stages::Of(const Problem& problem, std::vector<TermId> asked) {
  auto stages = std::make_unique<Stages>();
  stages->problem_ = &problem;
  stages->asked_ = std::move(asked);
  expr::Arena& arena = *problem.arena;
  auto modes = Modes::Of(problem);
  if (!modes.ok()) return modes.error();
  stages->modes_ = std::move(modes).value();
  for (size_t k = 0; k < stages->modes_.states().size(); ++k)
    stages->stand_ins_.push_back(arena.FreshConstant("discrete", arena.Real()));
  stages->factor_ = arena.FreshConstant("factor", arena.Real());
  stages->horizon_ = problem.horizon.ToDouble();
  if (problem.controller) {
    stages->period_ = problem.controller->period.ToDouble();
    stages->samples_ = Samples(problem);
  }
  auto assumed = Normalise(arena, problem.assume);
  if (!assumed.ok()) return assumed.error();
  stages->assumed_ = std::move(assumed).value();
  auto terms = Compile(arena, problem.states, stages->assumed_.terms);
  if (!terms.ok()) return terms.error();
  stages->assumed_terms_ = std::move(terms).value();
  std::set<double> instants{stages->horizon_};
  for (const Claim& claim : problem.claims) {
    for (const double t : {claim.from.ToDouble(), claim.to.ToDouble()}) {
      if (t > 0 && t < stages->horizon_) instants.insert(t);
    }
  }
  stages->instants_.assign(instants.begin(), instants.end());
  // What is wrong in the first mode is wrong in the problem.
  auto first = stages->For({stages->modes_.start()});
  if (!first.ok()) return first.error();
  return stages;
}

base::Result<std::shared_ptr<const Stage>> Stages::For(const std::vector<Mode>& modes, bool scaled) {
  const std::lock_guard lock(mutex_);
  auto& known = made_[{modes, scaled}];
  if (known != nullptr) return known;
  auto made = Make(modes, scaled);
  if (made.ok()) known = made.value();
  return made;
}

bool Stages::AreOpposite(TermId a, TermId b) {
  const std::lock_guard lock(mutex_);
  expr::Arena& arena = *problem_->arena;
  return arena.Add(a, b) == arena.Number(arena.Real(), Rational(0));
}

base::Result<bool> Stages::AddClaims(Stage& stage, size_t mode, std::vector<TermId>& terms) {
  expr::Arena& arena = *problem_->arena;
  for (size_t i = 0; i < problem_->claims.size(); ++i) {
    const Claim& claim = problem_->claims[i];
    auto formula = Normalise(arena, modes_.In(stage.modes[mode], claim.formula));
    if (!formula.ok()) return base::Error{fmt::format("`{}`: {}", claim.name, formula.error().message)};
    StageClaim compiled{i,
                        mode,
                        std::move(formula).value(),
                        terms.size(),
                        claim.from.ToDouble(),
                        claim.to.ToDouble(),
                        claim.from == claim.to,
                        {},
                        {}};
    terms.insert(terms.end(), compiled.formula.terms.begin(), compiled.formula.terms.end());
    stage.claims.push_back(std::move(compiled));
  }
  return true;
}

base::Result<bool> Stages::AddGuards(Stage& stage, size_t mode, std::vector<TermId>& terms) {
  expr::Arena& arena = *problem_->arena;
  for (size_t e = 0; e < problem_->events.size(); ++e) {
    const TermId condition = modes_.In(stage.modes[mode], problem_->events[e].condition);
    if (condition == arena.False()) continue;
    auto formula = Normalise(arena, condition);
    if (!formula.ok()) return base::Error{fmt::format("`when`: {}", formula.error().message)};
    auto after = modes_.After(stage.modes[mode], e);
    if (!after.ok()) return after.error();
    if (after.value() == stage.modes[mode]) continue;  // nothing happens
    Guard guard{mode, e, std::move(formula).value(), terms.size(), std::move(after).value()};
    terms.insert(terms.end(), guard.formula.terms.begin(), guard.formula.terms.end());
    stage.guards.push_back(std::move(guard));
  }
  return true;
}

// Discrete states with one value are that value; the others may change at any time: they are inputs.
Stages::Names Stages::NamesIn(Stage& stage, bool scaled) const {
  const expr::Arena& arena = *problem_->arena;
  Names names{problem_->states, 0, {}};
  std::vector<TermId> inputs;
  for (const Input& i : problem_->inputs) {
    inputs.push_back(i.term);
    stage.dynamics.inputs.push_back(i.bounds);
  }
  stage.discrete.resize(problem_->states.size());
  for (size_t k = 0; k < modes_.states().size(); ++k) {
    const size_t state = modes_.states()[k];
    Interval all = Interval::Empty();
    bool one = true;
    for (const Mode& m : stage.modes) {
      all = interval::Hull(all, Enclose(arena.number(m[k])));
      one = one && m[k] == stage.modes[0][k];
    }
    stage.discrete[state] = all;
    if (one) {
      names.values.emplace(problem_->states[state], stage.modes[0][k]);
    } else {
      names.variables[state] = stand_ins_[k];
      inputs.push_back(problem_->states[state]);
      stage.dynamics.inputs.push_back(all);
    }
  }
  if (scaled) names.variables.push_back(factor_);
  names.states = names.variables.size();
  names.variables.insert(names.variables.end(), inputs.begin(), inputs.end());
  return names;
}

std::vector<TermId> Stages::RatesIn(const Names& names, bool scaled) const {
  expr::Arena& arena = *problem_->arena;
  std::vector<TermId> rates;
  for (const TermId rate : problem_->rates) {
    const TermId own = expr::Substitute(arena, rate, names.values);
    rates.push_back(scaled ? arena.Mul(factor_, own) : own);
  }
  if (scaled) rates.push_back(arena.Number(arena.Real(), Rational(0)));
  return rates;
}

// The terms of claims, guards and queries in each mode.
base::Result<std::vector<TermId>> Stages::AddTerms(Stage& stage) {
  std::vector<TermId> terms;
  for (size_t m = 0; m < stage.modes.size(); ++m) {
    auto claims = AddClaims(stage, m, terms);
    if (!claims.ok()) return claims.error();
    auto guards = AddGuards(stage, m, terms);
    if (!guards.ok()) return guards.error();
    for (size_t q = 0; q < asked_.size(); ++q) {
      stage.queries.push_back({q, terms.size()});
      terms.push_back(modes_.In(stage.modes[m], asked_[q]));
    }
  }
  return terms;
}

// What a controller makes of the states.
base::Result<bool> Stages::AddUpdates(Stage& stage, const Names& names, bool scaled) const {
  if (!problem_->controller) return true;
  expr::Arena& arena = *problem_->arena;
  std::vector<TermId> updated = Updated(*problem_);
  for (size_t i = 0; i < updated.size(); ++i)
    updated[i] = stage.discrete[i] ? names.variables[i] : expr::Substitute(arena, updated[i], names.values);
  if (scaled) updated.push_back(factor_);
  auto map = Compile(arena, names.variables, updated);
  if (!map.ok()) return map.error();
  stage.updates = std::move(map).value();
  return true;
}

// Does anything that moves depend on discrete states that differ?
bool Stages::IsAmbiguous(const Stage& stage) const {
  const size_t certain = stage.dynamics.states + problem_->inputs.size();
  const auto depends = [&](const Program& p) {
    for (size_t i = 0; i < stage.dynamics.states; ++i) {
      if (std::ranges::any_of(p.depends[p.outputs[i]], [&](uint32_t v) { return v >= certain; })) return true;
    }
    return false;
  };
  return depends(stage.dynamics.program) || (problem_->controller && depends(stage.updates));
}

// Terms of claims that are at most zero at the start, whatever rounding says, or as long as no event happens.
void Stages::FindCertainTerms(Stage& stage) const {
  expr::Arena& arena = *problem_->arena;
  const std::vector<TermId> necessary = Necessary(assumed_);
  const std::set<TermId> known(necessary.begin(), necessary.end());
  expr::Substitution originals;
  for (size_t i = 0; i < problem_->copy_of.size(); ++i) {
    if (problem_->copy_of[i]) originals.emplace(problem_->states[i], problem_->states[*problem_->copy_of[i]]);
  }
  const TermId zero = arena.Number(arena.Real(), Rational(0));
  for (StageClaim& claim : stage.claims) {
    for (const TermId term : claim.formula.terms) {
      claim.implied.push_back(std::ranges::any_of(stage.guards, [&](const Guard& g) {
        return g.mode == claim.mode && g.IsComparison() && arena.Add(g.formula.terms[0], term) == zero;
      }));
      const TermId start = expr::Substitute(arena, term, originals);
      const bool number = arena.IsNumber(start) && !(arena.number(start) > Rational(0));
      // What a controller sets has another value as soon as it begins, and inputs at any time.
      const size_t at = claim.first + claim.starts_below.size();
      const bool continuous =
          std::ranges::none_of(stage.observed.depends[stage.observed.outputs[at]], [&](uint32_t v) {
            return v >= problem_->states.size() ||
                   (problem_->controller && problem_->controller->updates[v].has_value());
          });
      claim.starts_below.push_back(claim.from == 0 && continuous && (number || known.contains(start)));
    }
  }
}

base::Result<std::shared_ptr<const Stage>> Stages::Make(const std::vector<Mode>& modes, bool scaled) {
  expr::Arena& arena = *problem_->arena;
  auto stage = std::make_shared<Stage>();
  stage->modes = modes;
  const Names names = NamesIn(*stage, scaled);
  std::vector<TermId> outputs = RatesIn(names, scaled);
  const auto terms = AddTerms(*stage);
  if (!terms.ok()) return terms.error();
  outputs.insert(outputs.end(), terms.value().begin(), terms.value().end());
  auto program = Compile(arena, names.variables, outputs, names.states);
  if (!program.ok()) return program.error();
  stage->dynamics.program = std::move(program).value();
  stage->dynamics.states = names.states;
  auto observed = Compile(arena, names.variables, terms.value());
  if (!observed.ok()) return observed.error();
  stage->observed = std::move(observed).value();
  if (const auto added = AddUpdates(*stage, names, scaled); !added.ok()) return added.error();
  stage->ambiguous = IsAmbiguous(*stage);
  FindCertainTerms(*stage);
  return std::shared_ptr<const Stage>(std::move(stage));
}

}  // namespace rondo::reach
