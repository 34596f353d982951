#include "solve/icp/prepare/periods.h"

#include <numeric>
#include <string>
#include <unordered_map>

#include "expr/substitute.h"

namespace rondo::solve::icp {
namespace {

using expr::Elementary;
using expr::Op;

constexpr int64_t kLargestDenominator = 1'000;

class Occurrences {
 public:
  Occurrences(const expr::Arena& arena, TermId variable) : arena_(arena), variable_(variable) {}

  // Does the variable occur in periodic places only?
  bool Periodic(TermId t) {
    if (t == variable_) return false;
    if (const auto it = known_.find(t); it != known_.end()) return it->second;
    bool result = true;
    if (IsWave(t) && Occurs(arena_.arg(t, 0))) {
      result = Linear(arena_.arg(t, 0));
    } else {
      for (const TermId arg : arena_.args(t)) result = result && Periodic(arg);
    }
    known_.emplace(t, result);
    return result;
  }

  Rational Period() const {
    static const Rational kMoreThanTwoPi = *Rational::Parse("6.28318530718");
    return Rational(denominators_) * kMoreThanTwoPi;
  }

 private:
  bool IsWave(TermId t) const {
    return arena_.op(t) == Op::kElementary &&
           (arena_.elementary_of(t) == Elementary::kSin || arena_.elementary_of(t) == Elementary::kCos);
  }

  bool Occurs(TermId t) {
    if (t == variable_) return true;
    if (const auto it = occurs_.find(t); it != occurs_.end()) return it->second;
    bool result = false;
    for (const TermId arg : arena_.args(t)) result = result || Occurs(arg);
    occurs_.emplace(t, result);
    return result;
  }

  // q variable + r
  bool Linear(TermId t) {
    std::vector<TermId> parts{t};
    if (arena_.op(t) == Op::kAdd) parts.assign(arena_.args(t).begin(), arena_.args(t).end());
    for (const TermId part : parts) {
      const bool scaled = arena_.op(part) == Op::kMul && arena_.IsNumber(arena_.arg(part, 0)) &&
                          arena_.arg(part, 1) == variable_;
      if (part == variable_) continue;
      if (!scaled) {
        if (Occurs(part)) return false;
        continue;
      }
      const std::string text = arena_.number(arena_.arg(part, 0)).Denominator();
      if (text.size() > 4) return false;
      denominators_ = std::lcm(denominators_, static_cast<int64_t>(std::stoll(text)));
      if (denominators_ > kLargestDenominator) return false;
    }
    return true;
  }

  const expr::Arena& arena_;
  TermId variable_;
  std::unordered_map<TermId, bool> known_, occurs_;
  int64_t denominators_ = 1;
};

}  // namespace

std::optional<Rational> PeriodOf(const expr::Arena& arena, const std::vector<TermId>& terms,
                                 TermId variable) {
  Occurrences occurrences(arena, variable);
  for (const TermId t : terms) {
    if (!occurrences.Periodic(t)) return std::nullopt;
  }
  return occurrences.Period();
}

void BoundAngles(const expr::Arena& arena, const std::unordered_map<TermId, Variable>& variables,
                 Prepared& prepared, Proof* proof) {
  std::unordered_set<TermId> inside;
  for (const TermId d : prepared.disjunctions) expr::VisitPostorder(arena, d, inside, [](TermId) {});
  for (const auto& [term, range] : prepared.ranges) {
    if (!variables.contains(term)) expr::VisitPostorder(arena, term, inside, [](TermId) {});
  }
  for (const auto& [variable, kind] : variables) {
    if (kind.kind != Variable::Kind::kReal || !inside.contains(variable)) continue;
    const auto own = prepared.ranges.find(variable);
    const Range known = own == prepared.ranges.end() ? Range() : own->second;
    if ((known.lo && known.hi) || !known.excluded.empty()) continue;
    std::vector<TermId> terms = prepared.disjunctions;
    for (const auto& [term, range] : prepared.ranges) {
      if (term != variable) terms.push_back(term);
    }
    const auto period = PeriodOf(arena, terms, variable);
    if (!period) continue;
    const Rational lo = known.lo   ? *known.lo
                        : known.hi ? *known.hi - *period
                                   : Rational(0) - *period / Rational(2);
    Range& range = prepared.ranges[variable];
    range.Add(kGreater | kEqual, lo);
    range.Add(kLess | kEqual, lo + *period);
    if (proof != nullptr) proof->Period(variable, lo, lo + *period);
  }
}

}  // namespace rondo::solve::icp
