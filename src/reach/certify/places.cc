#include "reach/certify/places.h"

#include <algorithm>
#include <cmath>

#include "reach/certify/gradient.h"
#include "reach/problem/bounds.h"

namespace rondo::reach::certify {

base::Result<Places> Places::Of(const Problem& problem, const Invariant& invariant) {
  Places places;
  places.problem_ = &problem;
  places.variables_ = problem.states;
  for (const Input& input : problem.inputs) places.variables_.push_back(input.term);
  auto modes = Modes::Of(problem);
  if (!modes.ok()) return modes.error();
  places.modes_ = std::move(modes).value();
  if (const std::string wrong = places.Compile(invariant); !wrong.empty()) return base::Error{wrong};
  if (!places.Enclose()) return base::Error{"the invariant is not bounded"};
  return places;
}

std::string Places::Compile(const Invariant& invariant) {
  expr::Arena& arena = *problem_->arena;
  for (const ModeInvariant& one : invariant) {
    Place& place = all_.emplace_back();
    if (one.mode.size() != modes_.states().size()) return "a mode of the invariant is none of the problem";
    for (const Rational& value : one.mode) place.mode.push_back(arena.Number(arena.Real(), value));
    for (const Conjunct& conjunct : one.conjuncts) {
      auto term = TermOf(*problem_, modes_, place.mode, conjunct);
      if (!term.ok()) return term.error().message;
      place.terms.push_back(term.value());
    }
  }
  for (size_t a = 0; a < all_.size(); ++a) {
    if (Find(all_[a].mode) != a) return "the invariant mentions a mode twice";
  }
  for (Place& place : all_) {
    if (const std::string wrong = CompilePlace(place); !wrong.empty()) return wrong;
  }
  if (Find(modes_.start()) == SIZE_MAX) return "the invariant does not mention the first mode";
  auto normal = Normalise(arena, arena.And(modes_.In(modes_.start(), problem_->assume), InFirstBox()));
  if (!normal.ok()) return normal.error().message;
  assumed_ = std::move(normal).value();
  auto terms = reach::Compile(arena, variables_, assumed_.terms);
  if (!terms.ok()) return terms.error().message;
  assumed_terms_ = std::move(terms).value();
  return "";
}

std::string Places::CompilePlace(Place& place) {
  expr::Arena& arena = *problem_->arena;
  std::vector<TermId> outputs;
  for (const TermId rate : problem_->rates) outputs.push_back(modes_.In(place.mode, rate));
  outputs.insert(outputs.end(), place.terms.begin(), place.terms.end());
  const auto add = [&](TermId formula, Formula& normal) -> base::Result<size_t> {
    auto made = Normalise(arena, modes_.In(place.mode, formula));
    if (!made.ok()) return made.error();
    normal = std::move(made).value();
    const size_t first = outputs.size();
    outputs.insert(outputs.end(), normal.terms.begin(), normal.terms.end());
    return first;
  };
  for (size_t e = 0; e < problem_->events.size(); ++e) {
    const auto after = modes_.After(place.mode, e);
    if (!after.ok()) return after.error().message;
    if (after.value() == place.mode) continue;  // nothing happens
    Way way{.to = Find(after.value()), .condition = {}, .first = 0, .known = false};
    const auto first = add(problem_->events[e].condition, way.condition);
    if (!first.ok()) return first.error().message;
    way.first = first.value();
    place.ways.push_back(std::move(way));
  }
  for (const Claim& claim : problem_->claims) {
    Formula normal;
    const auto first = add(claim.formula, normal);
    if (!first.ok()) return first.error().message;
    place.claims.emplace_back(first.value(), std::move(normal));
  }
  auto program = reach::Compile(arena, variables_, outputs);
  if (!program.ok()) return program.error().message;
  place.program = std::move(program).value();
  for (size_t i = 0; i < problem_->states.size() + place.terms.size(); ++i) {
    if (!IsContinuous(place.program, place.program.outputs[i])) return "a rate or a term may jump";
  }
  for (Way& way : place.ways) way.known = AreContinuous(place, way.first, way.condition);
  return "";
}

// As terms: rounding says nothing of a bound that is met exactly.
TermId Places::InFirstBox() const {
  expr::Arena& arena = *problem_->arena;
  std::vector<TermId> all;
  for (size_t i = 0; i < problem_->states.size(); ++i) {
    const Interval side = problem_->initial[i];
    const auto number = [&](double value) { return arena.Number(arena.Real(), Rational::FromDouble(value)); };
    if (std::isfinite(side.lo)) all.push_back(arena.Le(number(side.lo), problem_->states[i]));
    if (std::isfinite(side.hi)) all.push_back(arena.Le(problem_->states[i], number(side.hi)));
  }
  return arena.And(all);
}

bool Places::AreContinuous(const Place& place, size_t first, const Formula& formula) {
  for (size_t k = 0; k < formula.terms.size(); ++k) {
    if (!IsContinuous(place.program, place.program.outputs[first + k])) return false;
  }
  return true;
}

size_t Places::Find(const Mode& mode) const {
  const auto it = std::ranges::find(all_, mode, &Place::mode);
  return it == all_.end() ? SIZE_MAX : static_cast<size_t>(it - all_.begin());
}

// Boxes around the conjuncts, and a little more: rates are looked at nearby, too.
bool Places::Enclose() {
  expr::Arena& arena = *problem_->arena;
  for (Place& place : all_) {
    std::vector<TermId> all;
    for (const TermId term : place.terms)
      all.push_back(arena.Le(term, arena.Number(arena.Real(), Rational::FromDouble(2 * kAround))));
    place.box.resize(problem_->states.size());
    for (size_t k = 0; k < modes_.states().size(); ++k)
      place.box[modes_.states()[k]] = reach::Enclose(arena.number(place.mode[k]));
    for (const Input& input : problem_->inputs) place.box.push_back(input.bounds);
    (void)Contract(arena, arena.And(all), variables_, place.box);
    if (std::ranges::any_of(place.box, [](const Interval& side) { return side.IsEmpty(); })) continue;
    for (const Interval& side : place.box) {
      if (!std::isfinite(side.lo) || !std::isfinite(side.hi)) return false;
    }
  }
  return true;
}

}  // namespace rondo::reach::certify
