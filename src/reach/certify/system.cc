#include "reach/certify/system.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "expr/substitute.h"
#include "reach/system/bounds.h"

namespace rondo::reach::certify {

namespace {

// What holds at the start as a comparison with zero is known exactly, if the start is exact.
void FindStartsBelow(System& system) {
  const Problem& problem = *system.problem;
  expr::Arena& arena = *problem.arena;
  expr::Substitution originals;
  for (size_t i = 0; i < problem.copy_of.size(); ++i) {
    if (problem.copy_of[i]) originals.emplace(problem.states[i], problem.states[*problem.copy_of[i]]);
  }
  const std::vector<TermId> necessary = Necessary(system.assumed);
  const std::set<TermId> assumed(necessary.begin(), necessary.end());
  for (CompiledClaim& claim : system.claims) {
    for (size_t k = 0; k < claim.formula.terms.size(); ++k) {
      const TermId start = expr::Substitute(arena, claim.formula.terms[k], originals);
      const bool below =
          assumed.contains(start) || (arena.IsNumber(start) && !(Rational(0) < arena.number(start)));
      const auto& depends = system.observed.depends[system.observed.outputs[claim.first + k]];
      const bool continuous = std::ranges::all_of(depends, [&](uint32_t v) {
        return v < problem.states.size() && !(problem.controller && problem.controller->updates[v]);
      });
      claim.starts_below.push_back(below && continuous && claim.claim->from == Rational(0));
    }
  }
}

}  // namespace

base::Result<System> System::Of(const Problem& problem) {
  System system;
  system.problem = &problem;
  expr::Arena& arena = *problem.arena;
  if (!problem.events.empty()) return base::Error{"events are not checked"};
  std::vector<TermId> variables = problem.states;
  for (const Input& input : problem.inputs) {
    variables.push_back(input.term);
    system.dynamics.inputs.push_back(input.bounds);
  }
  const auto compile = [&](const std::vector<TermId>& variables_of, const std::vector<TermId>& terms,
                           Program& out) -> std::string {
    auto made = Compile(arena, variables_of, terms);
    if (!made.ok()) return made.error().message;
    out = std::move(made).value();
    return "";
  };
  system.dynamics.states = problem.states.size();
  std::string wrong = compile(variables, problem.rates, system.dynamics.rates);
  if (problem.controller && wrong.empty()) wrong = compile(variables, Updated(problem), system.control);
  std::vector<TermId> terms;
  for (const Claim& claim : problem.claims) {
    auto formula = Normalise(arena, claim.formula);
    if (!formula.ok()) return formula.error();
    system.claims.push_back({&claim, std::move(formula).value(), terms.size(), {}});
    const auto& own = system.claims.back().formula.terms;
    terms.insert(terms.end(), own.begin(), own.end());
  }
  if (wrong.empty()) wrong = compile(variables, terms, system.observed);
  auto assumed = Normalise(arena, problem.assume);
  if (!assumed.ok()) return assumed.error();
  system.assumed = std::move(assumed).value();
  if (wrong.empty()) wrong = compile(problem.states, system.assumed.terms, system.assumed_terms);
  if (!wrong.empty()) return base::Error{wrong};
  FindStartsBelow(system);
  std::set<Rational> instants{Rational(0), problem.horizon};
  if (problem.controller) {
    for (Rational t(0); t < problem.horizon; t = t + problem.controller->period) instants.insert(t);
  }
  for (const Claim& claim : problem.claims) {
    for (const Rational& t : {claim.from, claim.to}) {
      if (Rational(0) < t && t < problem.horizon) instants.insert(t);
    }
  }
  system.instants.assign(instants.begin(), instants.end());
  return system;
}

bool System::IsSample(const Rational& instant) const {
  if (!problem->controller || !(instant < problem->horizon)) return false;
  const Rational count = instant / problem->controller->period;
  return count.Floor() == count;
}

}  // namespace rondo::reach::certify
