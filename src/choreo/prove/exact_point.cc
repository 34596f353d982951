#include "choreo/prove/exact_point.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <unordered_set>

#include "choreo/obligations/facts.h"
#include "choreo/obligations/solve_for.h"
#include "expr/substitute.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Numeric;
using expr::Rational;
using expr::Substitution;
using expr::TermId;

constexpr double kNear = 1e-4;  // across a touch, a point is known to the root of the precision only
constexpr int kMostTries = 200;

// The fraction with the least denominator within `slack` of x, by continued fractions.
Rational Simplest(double x, double slack) {
  Rational p0(0), p1(1), q0(1), q1(0);
  double rest = x;
  constexpr int kMostTerms = 20;
  for (int i = 0; i < kMostTerms; ++i) {
    const double whole = std::floor(rest);
    const Rational a(static_cast<int64_t>(whole));
    Rational p2 = a * p1 + p0, q2 = a * q1 + q0;
    p0 = std::move(p1);
    p1 = std::move(p2);
    q0 = std::move(q1);
    q1 = std::move(q2);
    Rational value = p1 / q1;
    if (std::fabs(value.ToDouble() - x) <= slack || rest - whole < 1e-12) return value;
    rest = 1 / (rest - whole);
  }
  return p1 / q1;
}

class Guess {
 public:
  Guess(Arena& arena, const Numeric::Point& near) : arena_(arena), near_(near) {}

  std::optional<Numeric::Point> Run(TermId formula) {
    FindNumbers(formula);
    if (!Try(formula)) return std::nullopt;
    Numeric::Point point;
    for (const auto& [v, value] : values_) point[v] = arena_.number(value).ToDouble();
    return point;
  }

 private:
  void FindNumbers(TermId formula) {
    std::unordered_set<TermId> seen;
    expr::VisitPostorder(arena_, formula, seen, [&](TermId t) {
      if (arena_.IsNumber(t) && arena_.sort_of(t) == arena_.Real()) numbers_.push_back(arena_.number(t));
    });
  }

  bool Try(TermId formula) {
    if (formula == arena_.True()) return true;
    if (formula == arena_.False() || ++tries_ > kMostTries) return false;
    const auto variables = robot::VariablesOf(arena_, {formula});
    if (variables.empty()) return false;  // some irrational number
    // What an equation determines has no other value.
    for (const TermId part : Conjuncts(arena_, formula)) {
      if (arena_.op(part) != expr::Op::kEq) continue;
      for (const TermId v : robot::VariablesOf(arena_, {part})) {
        const auto value = SolveFor(arena_, part, v);
        if (!value || !arena_.IsNumber(*value)) continue;
        return With(formula, v, *value);
      }
    }
    const TermId v = Plainest(variables);
    if (!v.valid()) return false;
    for (const Rational& r : CandidatesNear(near_.at(v))) {
      if (With(formula, v, arena_.Number(arena_.Real(), r))) return true;
    }
    return false;
  }

  // The variable whose value is most likely to be guessed: near a number of the formula, or near a simple
  // fraction. None if it is not known where any of them lies.
  TermId Plainest(const std::set<TermId>& variables) const {
    TermId best;
    size_t least = SIZE_MAX;
    for (const TermId v : variables) {
      const auto at = near_.find(v);
      if (at == near_.end() || !std::isfinite(at->second) || std::fabs(at->second) > 1e6) continue;
      const bool stands = std::ranges::any_of(numbers_, [&](const Rational& n) {
        return !n.IsZero() && std::fabs(std::fabs(n.ToDouble()) - std::fabs(at->second)) <= kNear;
      });
      const size_t digits = stands ? 0 : Simplest(at->second, kNear).Digits();
      if (digits >= least) continue;
      least = digits;
      best = v;
    }
    return best;
  }

  bool With(TermId formula, TermId v, TermId value) {
    values_[v] = value;
    if (Try(expr::Substitute(arena_, formula, {{v, value}}))) return true;
    values_.erase(v);
    return false;
  }

  std::vector<Rational> CandidatesNear(double x) const {
    std::vector<Rational> result{Simplest(x, 1e-8), Simplest(x, kNear)};
    for (const Rational& n : numbers_) {
      for (const Rational& r : {n, Rational(0) - n}) {
        if (std::fabs(r.ToDouble() - x) <= kNear) result.push_back(r);
      }
    }
    std::ranges::sort(result);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  Arena& arena_;
  const Numeric::Point& near_;
  std::vector<Rational> numbers_;
  Substitution values_;
  int tries_ = 0;
};

}  // namespace

std::optional<Numeric::Point> ExactPoint(Arena& arena, TermId formula, const Numeric::Point& near) {
  return Guess(arena, near).Run(formula);
}

}  // namespace rondo::choreo
