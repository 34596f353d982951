#include "driver/discharge.h"

#include <fmt/format.h>

#include <algorithm>

#include "reach/system/centred.h"
#include "reach/system/text.h"

namespace rondo::driver {

namespace {

// The version changes with what a proof means.
std::string Question(const ContractResult& r) {
  return "rondo reach 3\n" + reach::ToText(reach::Centred(r.made.problem).problem);
}

}  // namespace

void StoreProved(const ContractResult& r, const solve::cache::ProofCache& cache) {
  if (VerdictOf(r) == "proved") cache.Store(Question(r), {"reach", {}});
}

bool IsProved(const ContractResult& r, const solve::cache::ProofCache& cache) {
  return r.impossible.empty() && cache.Find(Question(r)).has_value();
}

std::map<const choreo::Graph*, std::set<std::string>> ProvedMotions(Motion& motion,
                                                                    const solve::cache::ProofCache& cache) {
  std::map<std::pair<const choreo::Graph*, std::string>, bool> all;
  for (const ContractResult& r : ContractsOf(motion, false)) {  // arguments are constants: nothing to reduce
    const auto [it, fresh] = all.emplace(std::pair(r.graph, r.motion), true);
    it->second = it->second && IsProved(r, cache);
  }
  std::map<const choreo::Graph*, std::set<std::string>> proved;
  for (const auto& [key, good] : all) {
    if (good) proved[key.first].insert(key.second);
  }
  return proved;
}

std::vector<std::string> Discharge(const LoadedKoord& koord, Session& session,
                                   const solve::cache::ProofCache& cache, const std::string& file,
                                   std::vector<std::string>& assumed) {
  std::vector<std::string> lines;
  if (koord.model.platforms.empty()) return lines;
  Platforms platforms;
  for (const ContractResult& r : PortContractsOf(koord, platforms, session)) {
    const auto it = std::find(assumed.begin(), assumed.end(), r.made.problem.name);
    if (it == assumed.end()) continue;
    if (!IsProved(r, cache)) {
      *it += fmt::format(" (not proved yet: `rondo reach {}`)", file);
      continue;
    }
    std::vector<std::string> limits = r.domain;
    limits.insert(limits.end(), r.made.assumed.begin(), r.made.assumed.end());
    lines.push_back(fmt::format("{} (of {}: {})", *it, r.model, fmt::join(limits, "; ")));
    assumed.erase(it);
  }
  return lines;
}

}  // namespace rondo::driver
