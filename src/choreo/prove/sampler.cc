#include "choreo/prove/sampler.h"

#include <algorithm>
#include <cmath>

#include "robot/values/value.h"

namespace rondo::choreo {

using expr::Numeric;
using expr::Op;
using expr::TermId;

Sampler::Sampler(const expr::Arena& arena, TermId formula) : arena_(arena), formula_(formula) {
  const auto variables = robot::VariablesOf(arena, {formula});
  variables_.assign(variables.begin(), variables.end());
  solve::Query query;
  query.arena = &arena;
  query.assertions = {{formula, ""}};
  box_ = solve::icp::IcpSolver().Enclose(query);
}

std::optional<Numeric::Point> Sampler::Draw(std::mt19937_64& random, int tries) const {
  if (!box_) return std::nullopt;
  for (int i = 0; i < tries; ++i) {
    if (auto point = Try(random)) return point;
  }
  return std::nullopt;
}

void Sampler::Equations(TermId formula, std::mt19937_64& random, std::vector<TermId>& equations) const {
  const auto args = arena_.args(formula);
  switch (arena_.op(formula)) {
    case Op::kAnd:
      for (size_t i = 0; i < args.size(); ++i) Equations(arena_.arg(formula, i), random, equations);
      return;
    case Op::kOr:
      Equations(arena_.arg(formula, random() % args.size()), random, equations);
      return;
    case Op::kEq:
      if (arena_.sort_of(args[0]) != arena_.Bool()) equations.push_back(formula);
      return;
    default:
      return;
  }
}

std::optional<Numeric::Point> Sampler::Try(std::mt19937_64& random) const {
  std::vector<TermId> equations;
  Equations(formula_, random, equations);
  std::vector<std::vector<TermId>> unknowns;
  for (const TermId e : equations) {
    const auto variables = robot::VariablesOf(arena_, {e});
    unknowns.emplace_back(variables.begin(), variables.end());
  }
  std::vector<TermId> open = variables_;
  std::shuffle(open.begin(), open.end(), random);
  Numeric::Point point;
  const auto known = [&](TermId v) { return point.contains(v); };
  while (!open.empty()) {
    // An equation with one unknown left gives it.
    bool solved = false;
    for (size_t i = 0; i < equations.size() && !solved; ++i) {
      std::erase_if(unknowns[i], known);
      if (unknowns[i].size() != 1) continue;
      const TermId v = unknowns[i][0];
      const auto difference = [&](double value) {
        Numeric::Point at = point;
        at[v] = value;
        Numeric numeric(arena_, at);
        return numeric(arena_.arg(equations[i], 0)) - numeric(arena_.arg(equations[i], 1));
      };
      const double zero = difference(0), slope = difference(1) - zero;
      if (!(std::abs(slope) > 1e-12)) return std::nullopt;
      point[v] = -zero / slope;
      std::erase(open, v);
      solved = true;
    }
    if (solved) continue;
    const TermId v = open.back();
    open.pop_back();
    double low = -10, high = 10;
    if (const auto it = box_->find(v); it != box_->end()) {
      low = std::max(it->second.first, -1e6);
      high = std::min(it->second.second, 1e6);
    }
    const auto how = random() % 8;
    const double share = how == 0 ? 0 : how == 1 ? 1 : std::uniform_real_distribution<>(0, 1)(random);
    point[v] = low + share * (high - low);
  }
  Numeric numeric(arena_, point);
  constexpr double kSlack = 1e-9;
  if (!(numeric.Violation(formula_) <= kSlack)) return std::nullopt;
  return point;
}

}  // namespace rondo::choreo
