#include "choreo/prove/keeping_start.h"

#include <algorithm>
#include <utility>

#include "choreo/obligations/facts.h"
#include "choreo/obligations/solve_for.h"
#include "choreo/prove/answer.h"
#include "expr/defined.h"

namespace rondo::choreo {

using expr::Op;
using expr::Rational;
using expr::TermId;

KeepingStart::KeepingStart(expr::Arena& arena, const Keeping& keeping, TermId clock, TermId start,
                           const AskSolver& ask)
    : arena_(arena), k_(keeping), clock_(clock), start_(start), during_(keeping.during), ask_(ask) {
  Settle();
  FindBegin();
  switches_.emplace(arena_, during_, clock_);
}

// Such as whether two points of a path are the same.
void KeepingStart::Settle() {
  constexpr size_t kMostSettled = 40;
  size_t settled = 0;
  during_ = expr::Transform(arena_, during_, [&](TermId t) {
    const Op op = arena_.op(t);
    const bool compares = op == Op::kEq || op == Op::kLe || op == Op::kLt;
    if (!compares || !robot::VariablesOf(arena_, {t}).empty() || settled++ >= kMostSettled) return t;
    if (Refutes(t)) return arena_.False();
    return Refutes(expr::Complement(arena_, t)) ? arena_.True() : t;
  });
  settled_ = std::exchange(certificates_, {});
}

void KeepingStart::FindBegin() {
  const std::vector<TermId> parts = Parts(start_);
  for (size_t i = 0; i < k_.moving.size(); ++i) {
    begin_[k_.moving[i]] = k_.before[i];
    for (const TermId part : parts) {
      const auto value = SolveFor(arena_, part, k_.before[i]);
      if (!value || !robot::VariablesOf(arena_, {*value}).empty()) continue;
      begin_[k_.moving[i]] = *value;
      break;
    }
  }
}

TermId KeepingStart::At(TermId formula, const Rational& seconds) {
  return expr::Substitute(arena_, formula, {{clock_, Number(seconds)}});
}

TermId KeepingStart::AtStart(TermId formula) {
  expr::Substitution map{{clock_, Number(Rational(0))}};
  for (size_t i = 0; i < k_.others.size(); ++i) map[k_.others[i]] = k_.others_before[i];
  return expr::Substitute(arena_, formula, map);
}

bool KeepingStart::Has(TermId formula, TermId variable) const {
  return robot::VariablesOf(arena_, {formula}).contains(variable);
}

std::vector<TermId> KeepingStart::Parts(TermId formula) const {
  const Conjunction parts = Conjuncts(arena_, formula);
  return {parts.begin(), parts.end()};
}

TermId KeepingStart::Elapsed(const std::optional<Rational>& most) {
  const TermId from = arena_.Le(Number(Rational(0)), clock_);
  return most ? arena_.And(from, arena_.Le(clock_, Number(*most))) : from;
}

bool KeepingStart::Refutes(TermId formula) {
  solve::Answer answer = ask_(formula, true);
  auto* unsat = std::get_if<solve::Unsat>(&answer);
  if (unsat == nullptr) return false;
  if (!unsat->certificate.empty()) certificates_.push_back(std::move(unsat->certificate));
  return true;
}

bool KeepingStart::IsImpossible(TermId formula) const {
  return std::holds_alternative<solve::Unsat>(ask_(formula, false));
}

std::optional<expr::Numeric::Point> KeepingStart::Solution(TermId formula) const {
  const solve::Answer answer = ask_(formula, false);
  if (!std::holds_alternative<solve::Sat>(answer)) return std::nullopt;
  return PointOf(answer);
}

std::vector<std::string> KeepingStart::TakeCertificates() {
  std::vector<std::string> all = settled_;
  std::ranges::move(certificates_, std::back_inserter(all));
  certificates_.clear();
  return all;
}

}  // namespace rondo::choreo
