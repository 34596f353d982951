#include "solve/icp/verify.h"

#include <algorithm>
#include <cmath>

#include "verdict/truth.h"

namespace rondo::solve::icp {
namespace {

// A number that satisfies the bounds of a variable, `value` if that does.
Rational Within(const Range& range, const Rational& value) {
  const bool below = range.lo && (value < *range.lo || (range.lo_strict && value == *range.lo));
  const bool above = range.hi && (value > *range.hi || (range.hi_strict && value == *range.hi));
  if (!below && !above) return value;
  if (range.lo && range.hi && (range.lo_strict || range.hi_strict))
    return (*range.lo + *range.hi) / Rational(2);
  if (below) return range.lo_strict ? *range.lo + Rational(1) : *range.lo;
  return range.hi_strict ? *range.hi - Rational(1) : *range.hi;
}

}  // namespace

Verifier::Verifier(Lowered& lowered, const Prepared& prepared, const Tape& tape,
                   const interval::Kernels& kernels)
    : lowered_(lowered),
      arena_(lowered.arena),
      prepared_(prepared),
      tape_(tape),
      existence_(tape, kernels),
      formulas_(Conjuncts(arena_, prepared)),
      others_(prepared.disjunctions) {
  for (const auto& [term, range] : prepared.ranges) {
    for (const Literal& literal : range.Literals(term)) {
      if (literal.relation == kEqual) {
        equations_.push_back(term);
      } else {
        others_.push_back(ToFormula(arena_, literal));
      }
    }
  }
}

std::optional<Solution> Verifier::Verify(const std::vector<double>& point) {
  // Descent may have left the domain of a function.
  if (!std::ranges::all_of(point, [](double x) { return std::isfinite(x); })) return std::nullopt;
  if (auto solution = AtPoint(point)) return solution;
  // Numbers that were meant: what is nearly a multiple of 2^-20 probably is one.
  std::vector<double> rounded = point;
  for (double& x : rounded) {
    const double near = std::ldexp(std::round(std::ldexp(x, 20)), -20);
    if (std::fabs(near - x) < 1e-9) x = near;
  }
  if (rounded != point) {
    if (auto solution = AtPoint(rounded)) return solution;
  }
  return NearPoint(point);
}

Assignment Verifier::Values(const std::vector<double>& point) const {
  Assignment values;
  for (const auto& [term, variable] : lowered_.variables) values.emplace(term, Rational(0));
  for (size_t v = 0; v < point.size(); ++v) values[tape_.variables[v].term] = Rational::FromDouble(point[v]);
  for (const auto& [term, range] : prepared_.ranges) {
    if (lowered_.variables.contains(term)) values[term] = Within(range, values[term]);
  }
  return values;
}

// Adds the values of eliminated variables. Are all exact? nullopt if one has no value: its equation does not
// hold.
std::optional<bool> Verifier::Complete(PointChecker& checker, Assignment& values) const {
  bool exact = true;
  for (const auto& [variable, definition] : prepared_.definitions) {
    const interval::Interval near = checker.Enclosure(definition);
    if (near.IsEmpty()) return std::nullopt;
    const auto value = checker.Exact(definition);
    exact = exact && value.has_value();
    values[variable] = value ? *value : Rational::FromDouble(near.Middle());
  }
  return exact;
}

std::optional<Solution> Verifier::AtPoint(const std::vector<double>& point) {
  const Assignment values = Values(point);
  PointChecker checker(arena_, values);
  Solution solution{values, true};
  const std::optional<bool> exact = Complete(checker, solution.values);
  if (!exact) return std::nullopt;
  solution.exact = *exact;
  // The query itself, if all values are rational; else what was derived from it.
  PointChecker original(arena_, solution.values);
  PointChecker& judge = *exact ? original : checker;
  for (const TermId f : *exact ? lowered_.conjuncts : formulas_) {
    if (judge.Check(f) != verdict::Truth::kTrue) return std::nullopt;
  }
  return solution;
}

// The equations hold somewhere in a small box, and all else holds everywhere in it.
std::optional<Solution> Verifier::NearPoint(const std::vector<double>& point) {
  if (existence_.equations() != equations_.size()) return std::nullopt;
  const auto box = existence_.Around(point);
  if (!box) return std::nullopt;
  Solution solution{Values(point), false};
  const Assignment values = solution.values;
  PointChecker around(arena_, values);
  for (size_t v = 0; v < point.size(); ++v)
    around.Widen(tape_.variables[v].term, {(*box)[2 * v], (*box)[2 * v + 1]});
  for (const TermId f : others_) {
    if (around.Check(f) != verdict::Truth::kTrue) return std::nullopt;
  }
  // The equations must be defined throughout the box.
  for (const TermId e : equations_) {
    if (around.Enclosure(e).IsEmpty()) return std::nullopt;
  }
  if (!Complete(around, solution.values)) return std::nullopt;
  return solution;
}

}  // namespace rondo::solve::icp
