#include "reach/validated/flow/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "expr/substitute.h"
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

base::Result<std::shared_ptr<const Stage>> Stages::Make(const std::vector<Mode>& modes, bool scaled) {
  const Problem& problem = *problem_;
  expr::Arena& arena = *problem.arena;
  auto stage = std::make_shared<Stage>();
  stage->modes = modes;
  std::vector<TermId> variables = problem.states;
  std::vector<TermId> inputs;
  for (const Input& i : problem.inputs) {
    inputs.push_back(i.term);
    stage->dynamics.inputs.push_back(i.bounds);
  }
  // Discrete states with one value are that value; the others may change at any time.
  stage->discrete.resize(problem.states.size());
  expr::Substitution values;
  for (size_t k = 0; k < modes_.states().size(); ++k) {
    const size_t state = modes_.states()[k];
    Interval all = Interval::Empty();
    bool one = true;
    for (const Mode& m : modes) {
      all = interval::Hull(all, Enclose(arena.number(m[k])));
      one = one && m[k] == modes[0][k];
    }
    stage->discrete[state] = all;
    if (one) {
      values.emplace(problem.states[state], modes[0][k]);
    } else {
      variables[state] = stand_ins_[k];
      inputs.push_back(problem.states[state]);
      stage->dynamics.inputs.push_back(all);
    }
  }
  std::vector<TermId> outputs;
  for (const TermId rate : problem.rates) {
    const TermId own = expr::Substitute(arena, rate, values);
    outputs.push_back(scaled ? arena.Mul(factor_, own) : own);
  }
  if (scaled) {
    variables.push_back(factor_);
    outputs.push_back(arena.Number(arena.Real(), Rational(0)));
  }
  const size_t states = variables.size();
  variables.insert(variables.end(), inputs.begin(), inputs.end());
  std::vector<TermId> terms;
  for (size_t m = 0; m < modes.size(); ++m) {
    auto claims = AddClaims(*stage, m, terms);
    if (!claims.ok()) return claims.error();
    auto guards = AddGuards(*stage, m, terms);
    if (!guards.ok()) return guards.error();
    for (size_t q = 0; q < asked_.size(); ++q) {
      stage->queries.push_back({q, terms.size()});
      terms.push_back(modes_.In(modes[m], asked_[q]));
    }
  }
  outputs.insert(outputs.end(), terms.begin(), terms.end());
  auto program = Compile(arena, variables, outputs, states);
  if (!program.ok()) return program.error();
  stage->dynamics.program = std::move(program).value();
  stage->dynamics.states = states;
  auto observed = Compile(arena, variables, terms);
  if (!observed.ok()) return observed.error();
  stage->observed = std::move(observed).value();
  if (problem.controller) {
    std::vector<TermId> updated = Updated(problem);
    for (size_t i = 0; i < updated.size(); ++i)
      updated[i] = stage->discrete[i] ? variables[i] : expr::Substitute(arena, updated[i], values);
    if (scaled) updated.push_back(factor_);
    auto map = Compile(arena, variables, updated);
    if (!map.ok()) return map.error();
    stage->updates = std::move(map).value();
  }
  const size_t certain = states + problem.inputs.size();
  const auto depends = [&](const Program& p, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      if (std::ranges::any_of(p.depends[p.outputs[i]], [&](uint32_t v) { return v >= certain; })) return true;
    }
    return false;
  };
  stage->ambiguous =
      depends(stage->dynamics.program, states) || (problem.controller && depends(stage->updates, states));
  // Terms that are at most zero at the start, whatever rounding says.
  const std::vector<TermId> necessary = Necessary(assumed_);
  const std::set<TermId> known(necessary.begin(), necessary.end());
  expr::Substitution originals;
  for (size_t i = 0; i < problem.copy_of.size(); ++i) {
    if (problem.copy_of[i]) originals.emplace(problem.states[i], problem.states[*problem.copy_of[i]]);
  }
  const TermId zero = arena.Number(arena.Real(), Rational(0));
  for (StageClaim& claim : stage->claims) {
    for (const TermId term : claim.formula.terms) {
      claim.implied.push_back(std::ranges::any_of(stage->guards, [&](const Guard& g) {
        return g.mode == claim.mode && g.IsComparison() && arena.Add(g.formula.terms[0], term) == zero;
      }));
      const TermId start = expr::Substitute(arena, term, originals);
      const bool number = arena.IsNumber(start) && !(arena.number(start) > Rational(0));
      // What a controller sets has another value as soon as it begins, and inputs at any time.
      const size_t at = claim.first + claim.starts_below.size();
      const bool continuous =
          std::ranges::none_of(stage->observed.depends[stage->observed.outputs[at]], [&](uint32_t v) {
            return v >= problem.states.size() ||
                   (problem.controller && problem.controller->updates[v].has_value());
          });
      claim.starts_below.push_back(claim.from == 0 && continuous && (number || known.contains(start)));
    }
  }
  return std::shared_ptr<const Stage>(std::move(stage));
}

}  // namespace rondo::reach
