#include "reach/problem/modes.h"

#include <fmt/format.h>

#include "expr/substitute.h"

namespace rondo::reach {

base::Result<Modes> Modes::Of(const Problem& problem) {
  Modes modes;
  modes.problem_ = &problem;
  expr::Arena& arena = *problem.arena;
  const TermId zero = arena.Number(arena.Real(), Rational(0));
  for (size_t i = 0; i < problem.states.size(); ++i) {
    bool set = false;
    for (const Event& e : problem.events) set = set || e.updates[i].has_value();
    if (!set) continue;
    const std::string& name = arena.symbol(arena.symbol_of(problem.states[i])).name;
    if (problem.rates[i] != zero)
      return base::Error{fmt::format("an event sets `{}`, which changes by itself", name)};
    if (problem.controller && problem.controller->updates[i])
      return base::Error{fmt::format("an event and a controller set `{}`", name)};
    if (i >= problem.pinned.size() || !problem.pinned[i])
      return base::Error{fmt::format("an event sets `{}`, which has no certain value at the start", name)};
    modes.states_.push_back(i);
    modes.start_.push_back(arena.Number(arena.Real(), *problem.pinned[i]));
  }
  return modes;
}

TermId Modes::In(const Mode& mode, TermId term) const {
  if (mode.empty()) return term;
  expr::Substitution values;
  for (size_t k = 0; k < mode.size(); ++k) values.emplace(problem_->states[states_[k]], mode[k]);
  return expr::Substitute(*problem_->arena, term, values);
}

base::Result<Mode> Modes::After(const Mode& mode, size_t e) const {
  Mode next = mode;
  for (size_t k = 0; k < states_.size(); ++k) {
    const auto& value = problem_->events[e].updates[states_[k]];
    if (!value) continue;
    next[k] = In(mode, *value);
    if (!problem_->arena->IsNumber(next[k])) {
      return base::Error{fmt::format(
          "what an event sets `{}` to is no number that depends on discrete states only",
          problem_->arena->symbol(problem_->arena->symbol_of(problem_->states[states_[k]])).name)};
    }
  }
  return next;
}

std::string Modes::ToText(const Mode& mode) const {
  std::string text;
  for (size_t k = 0; k < mode.size(); ++k)
    text +=
        fmt::format("{}{} = {}", k == 0 ? "" : ", ",
                    problem_->arena->symbol(problem_->arena->symbol_of(problem_->states[states_[k]])).name,
                    problem_->arena->number(mode[k]).ToString());
  return text;
}

}  // namespace rondo::reach
