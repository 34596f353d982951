#include "contracts/discharge.h"

#include <fmt/format.h>

#include <algorithm>

#include "reach/problem/centred.h"
#include "reach/problem/text.h"

namespace rondo::contracts {

namespace {

// The version changes with what a proof means.
std::string Question(const ContractResult& r) {
  return "rondo reach 3\n" + reach::ToText(reach::Centred(r.made.problem).problem);
}

}  // namespace

void StoreProved(const ContractResult& r, const solve::cache::ProofCache& cache) {
  if (VerdictOf(r) == verdict::Verdict::kProved) cache.Store(Question(r), {"reach", {}});
}

bool IsProved(const ContractResult& r, const solve::cache::ProofCache& cache) {
  return r.impossible.empty() && cache.Find(Question(r)).has_value();
}

std::map<const choreo::Graph*, std::set<std::string>> ProvedMotions(workspace::LoadedModule& module,
                                                                    const solve::cache::ProofCache& cache) {
  std::map<std::pair<const choreo::Graph*, std::string>, bool> all;
  for (const ContractResult& r : ContractsOf(module, false)) {  // arguments are constants: nothing to reduce
    const auto [it, fresh] = all.emplace(std::pair(r.graph, r.motion), true);
    it->second = it->second && IsProved(r, cache);
  }
  std::map<const choreo::Graph*, std::set<std::string>> proved;
  for (const auto& [key, good] : all) {
    if (good) proved[key.first].insert(key.second);
  }
  return proved;
}

void Discharge(const workspace::LoadedKoord& koord, workspace::Session& session,
               const solve::cache::ProofCache& cache, const std::string& file, verdict::Basis& basis) {
  if (koord.model.platforms.empty()) return;
  Platforms platforms;
  for (const ContractResult& r : PortContractsOf(koord, platforms, session)) {
    const auto it = std::ranges::find(basis.assumed, r.made.problem.name);
    if (it == basis.assumed.end()) continue;
    if (!IsProved(r, cache)) {
      *it += fmt::format(" (not proved yet: `rondo reach {}`)", file);
      continue;
    }
    verdict::Discharged proved{*it, verdict::Engine::kReachability, {"of " + r.model}};
    proved.limits.insert(proved.limits.end(), r.domain.begin(), r.domain.end());
    proved.limits.insert(proved.limits.end(), r.made.assumed.begin(), r.made.assumed.end());
    basis.proved.push_back(std::move(proved));
    basis.assumed.erase(it);
  }
}

}  // namespace rondo::contracts
