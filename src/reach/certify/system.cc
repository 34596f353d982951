#include "reach/certify/system.h"

#include <algorithm>
#include <set>

#include "expr/substitute.h"
#include "reach/problem/bounds.h"
#include "verdict/truth.h"

namespace rondo::reach::certify {

base::Result<std::unique_ptr<System>> System::Of(const Problem& problem) {
  if (!(Rational(0) < problem.horizon)) return base::Error{"it takes no time"};
  auto system = std::make_unique<System>();
  system->problem_ = &problem;
  auto modes = Modes::Of(problem);
  if (!modes.ok()) return modes.error();
  system->modes_ = std::move(modes).value();
  for (size_t k = 0; k < system->modes_.states().size(); ++k)
    system->stand_ins_.push_back(problem.arena->FreshConstant("unused", problem.arena->Real()));
  auto assumed = Normalise(*problem.arena, problem.assume);
  if (!assumed.ok()) return assumed.error();
  system->assumed_ = std::move(assumed).value();
  auto terms = Compile(*problem.arena, problem.states, system->assumed_.terms);
  if (!terms.ok()) return terms.error();
  system->assumed_terms_ = std::move(terms).value();
  std::set<Rational> instants{Rational(0), problem.horizon};
  if (problem.controller) {
    for (Rational t(0); t < problem.horizon; t = t + problem.controller->period) instants.insert(t);
  }
  for (const Claim& claim : problem.claims) {
    for (const Rational& t : {claim.from, claim.to}) {
      if (Rational(0) < t && t < problem.horizon) instants.insert(t);
    }
  }
  system->instants_.assign(instants.begin(), instants.end());
  return system;
}

bool System::IsEmpty(const interval::Box& box) const {
  return CheckBox(assumed_terms_, assumed_, box) == verdict::Truth::kFalse;
}

bool System::IsSample(const Rational& instant) const {
  if (!problem_->controller || !(instant < problem_->horizon)) return false;
  const Rational count = instant / problem_->controller->period;
  return count.Floor() == count;
}

bool System::AreOpposite(TermId a, TermId b) {
  const std::lock_guard lock(mutex_);
  expr::Arena& arena = *problem_->arena;
  return arena.Add(a, b) == arena.Number(arena.Real(), Rational(0));
}

base::Result<std::shared_ptr<const ModeSystem>> System::For(const std::vector<Mode>& modes) {
  const std::lock_guard lock(mutex_);
  auto& known = made_[modes];
  if (known != nullptr) return known;
  auto made = Make(modes);
  if (made.ok()) known = made.value();
  return made;
}

// The claims and events of one mode; their terms go to the end of `terms`.
base::Result<bool> System::Observe(ModeSystem& system, size_t mode, std::vector<TermId>& terms) {
  const Problem& problem = *problem_;
  expr::Arena& arena = *problem.arena;
  const Mode& in = system.modes[mode];
  const auto observe = [&](const Formula& formula) {
    const size_t first = terms.size();
    terms.insert(terms.end(), formula.terms.begin(), formula.terms.end());
    return first;
  };
  for (const Claim& claim : problem.claims) {
    auto formula = Normalise(arena, modes_.In(in, claim.formula));
    if (!formula.ok()) return formula.error();
    const size_t first = observe(formula.value());
    system.claims.push_back({&claim, mode, std::move(formula).value(), first, {}, {}});
  }
  for (size_t e = 0; e < problem.events.size(); ++e) {
    auto formula = Normalise(arena, modes_.In(in, problem.events[e].condition));
    if (!formula.ok()) return formula.error();
    auto after = modes_.After(in, e);
    if (!after.ok()) return after.error();
    if (after.value() == in) continue;  // nothing happens
    const size_t first = observe(formula.value());
    system.guards.push_back({mode, e, std::move(formula).value(), first, std::move(after).value()});
  }
  return true;
}

base::Result<std::shared_ptr<const ModeSystem>> System::Make(const std::vector<Mode>& modes) {
  const Problem& problem = *problem_;
  expr::Arena& arena = *problem.arena;
  auto system = std::make_shared<ModeSystem>();
  system->modes = modes;
  std::vector<TermId> variables = problem.states;
  for (const Input& input : problem.inputs) {
    variables.push_back(input.term);
    system->dynamics.inputs.push_back(input.bounds);
  }
  // Programs know the discrete states as numbers or as inputs: in the place of the state stands a name that
  // none uses.
  system->discrete.resize(problem.states.size());
  expr::Substitution values;
  for (size_t k = 0; k < modes_.states().size(); ++k) {
    const size_t state = modes_.states()[k];
    Interval all = Enclose(arena.number(modes[0][k]));
    for (const Mode& m : modes) all = interval::Hull(all, Enclose(arena.number(m[k])));
    system->discrete[state] = all;
    if (std::ranges::all_of(modes, [&](const Mode& m) { return m[k] == modes[0][k]; })) {
      values.emplace(problem.states[state], modes[0][k]);
    } else {
      variables[state] = stand_ins_[k];
      variables.push_back(problem.states[state]);
      system->dynamics.inputs.push_back(all);
    }
  }
  std::vector<TermId> terms;
  for (size_t mode = 0; mode < modes.size(); ++mode) {
    auto observed = Observe(*system, mode, terms);
    if (!observed.ok()) return observed.error();
  }
  std::string wrong;
  const auto compile = [&](std::vector<TermId> functions, Program& out) {
    for (TermId& f : functions) f = expr::Substitute(arena, f, values);
    auto made = Compile(arena, variables, functions);
    if (!made.ok()) {
      wrong = made.error().message;
    } else {
      out = std::move(made).value();
    }
  };
  system->dynamics.states = problem.states.size();
  compile(problem.rates, system->dynamics.rates);
  compile(terms, system->observed);
  if (problem.controller) {
    // A controller sets no discrete state.
    std::vector<TermId> updated = Updated(problem);
    compile(updated, system->control);
  }
  if (!wrong.empty()) return base::Error{wrong};
  FindKnown(*system);
  return std::shared_ptr<const ModeSystem>(std::move(system));
}

// What is known of the terms of claims exactly.
void System::FindKnown(ModeSystem& system) const {
  const Problem& problem = *problem_;
  expr::Arena& arena = *problem.arena;
  expr::Substitution originals;
  for (size_t i = 0; i < problem.copy_of.size(); ++i) {
    if (problem.copy_of[i]) originals.emplace(problem.states[i], problem.states[*problem.copy_of[i]]);
  }
  const std::vector<TermId> necessary = Necessary(assumed_);
  const std::set<TermId> assumed(necessary.begin(), necessary.end());
  const TermId zero = arena.Number(arena.Real(), Rational(0));
  for (ModeClaim& claim : system.claims) {
    for (size_t k = 0; k < claim.formula.terms.size(); ++k) {
      const TermId term = claim.formula.terms[k];
      const TermId start = expr::Substitute(arena, term, originals);
      const bool below =
          assumed.contains(start) || (arena.IsNumber(start) && !(Rational(0) < arena.number(start)));
      // Inputs jump, and so does what a controller sets.
      const auto& depends = system.observed.depends[system.observed.outputs[claim.first + k]];
      const bool continuous = std::ranges::all_of(depends, [&](uint32_t v) {
        return v < problem.states.size() && !(problem.controller && problem.controller->updates[v]);
      });
      claim.starts_below.push_back(below && continuous && claim.claim->from == Rational(0));
      // If the term rises above zero, an event with the condition -term <= 0 happens.
      claim.implied.push_back(std::ranges::any_of(system.guards, [&](const ModeGuard& g) {
        return g.mode == claim.mode && g.IsComparison() && arena.Add(g.formula.terms[0], term) == zero;
      }));
    }
  }
}

}  // namespace rondo::reach::certify
