#include "choreo/prove/switches.h"

#include <algorithm>
#include <unordered_set>

#include "choreo/obligations/solve_for.h"
#include "robot/values/value.h"

namespace rondo::choreo {

using expr::Op;
using expr::Rational;
using expr::TermId;

Switches::Switches(expr::Arena& arena, TermId formula, TermId clock) : arena_(arena), clock_(clock) {
  std::vector<TermId> conditions;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena, formula, seen, [&](TermId t) {
    if (arena.op(t) == Op::kIte) conditions.push_back(arena.arg(t, 0));
  });
  for (const TermId condition : conditions) {
    if (IsPlain(condition)) plain_.insert(condition);
  }
  std::ranges::sort(moments_);
  moments_.erase(std::unique(moments_.begin(), moments_.end()), moments_.end());
}

// Is every part that depends on the clock a comparison that changes at one moment? Collects these moments.
bool Switches::IsPlain(TermId condition) {
  const std::vector<TermId> args(arena_.args(condition).begin(), arena_.args(condition).end());
  switch (arena_.op(condition)) {
    case Op::kAnd:
    case Op::kOr:
    case Op::kNot:
      return std::ranges::all_of(args, [this](TermId a) { return IsPlain(a); });
    case Op::kLe:
    case Op::kLt: {
      if (!robot::VariablesOf(arena_, {condition}).contains(clock_)) return true;
      const auto moment = MomentOf(condition);
      if (moment && Rational(0) < *moment) moments_.push_back(*moment);
      return moment.has_value();
    }
    default:
      return !robot::VariablesOf(arena_, {condition}).contains(clock_);
  }
}

std::optional<Rational> Switches::MomentOf(TermId comparison) {
  // Two sides that are never equal fold to `false`.
  const TermId equal = arena_.Eq(arena_.arg(comparison, 0), arena_.arg(comparison, 1));
  const auto moment = SolveFor(arena_, equal, clock_);
  if (!moment || !arena_.IsNumber(*moment)) return std::nullopt;
  return arena_.number(*moment);
}

TermId Switches::Settled(TermId term, const Rational& from, const std::optional<Rational>& to) {
  if (plain_.empty()) return term;
  const Rational inside = to ? (from + *to) / Rational(2) : from + Rational(1);
  const expr::Substitution at{{clock_, arena_.Number(arena_.Real(), inside)}};
  return expr::Transform(arena_, term, [&](TermId t) {
    if (arena_.op(t) != Op::kIte || !plain_.contains(arena_.arg(t, 0))) return t;
    const TermId condition = expr::Substitute(arena_, arena_.arg(t, 0), at);
    return condition == arena_.True() ? arena_.arg(t, 1) : condition == arena_.False() ? arena_.arg(t, 2) : t;
  });
}

bool Switches::IsContinuousBetween(TermId term, const std::vector<TermId>& changing) {
  std::vector<Rational> ends{Rational(0)};
  ends.insert(ends.end(), moments_.begin(), moments_.end());
  for (size_t i = 0; i < ends.size(); ++i) {
    const auto to = i + 1 < ends.size() ? std::optional(ends[i + 1]) : std::nullopt;
    if (!IsContinuous(arena_, Settled(term, ends[i], to), changing)) return false;
  }
  return true;
}

Curve Switches::Split(const Curve& curve) {
  Curve result;
  for (const CurvePiece& piece : curve) {
    std::vector<Rational> ends{piece.from};
    for (const Rational& s : moments_) {
      if (piece.from < s && (!piece.to || s < *piece.to)) ends.push_back(s);
    }
    for (size_t i = 0; i < ends.size(); ++i) {
      CurvePiece part{ends[i], i + 1 < ends.size() ? std::optional(ends[i + 1]) : piece.to, {}};
      for (const auto& [v, value] : piece.value) part.value[v] = Settled(value, part.from, part.to);
      result.push_back(std::move(part));
    }
  }
  return result;
}

}  // namespace rondo::choreo
