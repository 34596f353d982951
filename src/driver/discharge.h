#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "driver/reachability.h"
#include "solve/cache/proof_cache.h"

namespace rondo::driver {

/// Proved contracts on disk: what `rondo reach` has proved, `rondo prove` need not assume. An entry is the
/// complete problem, so a change of a model, a controller or a contract is another problem.
void StoreProved(const ContractResult& result, const solve::cache::ProofCache& cache);
bool IsProved(const ContractResult& result, const solve::cache::ProofCache& cache);

/// For each choreography the motions (`Type.Motion`) all of whose contracts are proved.
std::map<const choreo::Graph*, std::set<std::string>> ProvedMotions(Motion& motion,
                                                                    const solve::cache::ProofCache& cache);

/// Takes the assumptions about ports that are proved off `assumed`; lines that say of which robot, and for
/// what. Those that could be proved are marked.
std::vector<std::string> Discharge(const LoadedKoord& koord, Session& session,
                                   const solve::cache::ProofCache& cache, const std::string& file,
                                   std::vector<std::string>& assumed);

}  // namespace rondo::driver
