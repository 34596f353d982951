#include "contracts/tube_reuse.h"

#include <algorithm>

#include "reach/problem/bounds.h"
#include "reach/problem/centred.h"
#include "reach/problem/text.h"
#include "verdict/truth.h"

namespace rondo::contracts {

namespace {

std::string TextWith(reach::Problem problem, std::vector<reach::Claim> claims) {
  problem.claims = std::move(claims);
  return reach::ToText(problem);
}

// Does the claim hold wherever the tube is while it must?
bool HoldsOn(const std::vector<reach::Leaf>& leaves, const reach::Problem& problem,
             const reach::Claim& claim) {
  auto formula = reach::Normalise(*problem.arena, claim.formula);
  if (!formula.ok()) return false;
  std::vector<reach::TermId> variables = problem.states;
  for (const reach::Input& i : problem.inputs) variables.push_back(i.term);
  const auto terms = reach::Compile(*problem.arena, variables, formula.value().terms);
  if (!terms.ok()) return false;
  const auto holds = [&](interval::Box box) {
    for (const reach::Input& i : problem.inputs) box.push_back(i.bounds);
    return reach::CheckBox(terms.value(), formula.value(), box) == verdict::Truth::kTrue;
  };
  const double from = claim.from.ToDouble();
  const double to = claim.to.ToDouble();
  for (const reach::Leaf& leaf : leaves) {
    if (leaf.tube.empty()) return false;
    for (const reach::TubeSegment& s : leaf.tube) {
      if (s.from <= to && s.to >= from && !holds(s.during)) return false;
    }
    if (to >= problem.horizon.ToDouble() && !holds(leaf.final)) return false;
  }
  return !leaves.empty();
}

}  // namespace

TubeReuse::Cover TubeReuse::Covers(const ContractResult& contract) const {
  if (!contract.impossible.empty() || tubes_.empty()) return {};
  const reach::Problem problem = reach::Centred(contract.made.problem).problem;
  if (const auto it = tubes_.find(TextWith(problem, {})); it != tubes_.end()) {
    const bool all = std::ranges::all_of(problem.claims, [&](const reach::Claim& claim) {
      return it->second.claims.contains(TextWith(problem, {claim})) ||
             HoldsOn(it->second.leaves, problem, claim);
    });
    if (all) return {it->second.contract, it->second.certificate, std::nullopt};
  }
  if (!contract.at_zero) return {};
  const auto it = anywhere_.find(reach::ToText(*contract.at_zero));
  return it == anywhere_.end() ? Cover() : it->second;
}

void TubeReuse::Remember(const ContractResult& contract, reach::certify::Certificate certificate) {
  if (!contract.outcome) return;
  const auto* proved = std::get_if<reach::Proved>(&*contract.outcome);
  // An invariant and a paving are about the coordinates that they were found in.
  if (proved == nullptr || proved->invariant || proved->paving) return;
  const reach::CentredProblem centred = reach::Centred(contract.made.problem);
  Tube tube{contract.made.problem.name, proved->leaves, std::move(certificate), {}};
  const auto move = [&](interval::Box& box) {
    for (size_t i = 0; i < box.size(); ++i) box[i] = box[i] - reach::Enclose(centred.origin[i]);
  };
  for (reach::Leaf& leaf : tube.leaves) {
    for (reach::TubeSegment& s : leaf.tube) move(s.during);
    move(leaf.final);
  }
  for (const reach::Claim& claim : centred.problem.claims)
    tube.claims.insert(TextWith(centred.problem, {claim}));
  tubes_.emplace(TextWith(centred.problem, {}), std::move(tube));
  if (contract.at_zero)
    anywhere_.emplace(reach::ToText(*contract.at_zero),
                      Cover{contract.made.problem.name, std::nullopt, contract.certified});
}

}  // namespace rondo::contracts
