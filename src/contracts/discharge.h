#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "contracts/load.h"
#include "solve/cache/proof_cache.h"

/// Lets proofs of programs and choreographies rest on contracts that were proved before.
namespace rondo::contracts {

/// Keeps proved contracts on disk, and finds them again: what `rondo reach` has proved, `rondo prove` need
/// not assume. An entry is the complete problem, so a change of a model, a controller or a contract is
/// another problem.
void StoreProved(const ContractResult& result, const solve::cache::ProofCache& cache);
bool IsProved(const ContractResult& result, const solve::cache::ProofCache& cache);

/// Returns, for each choreography, the motions (`Type.Motion`) all of whose contracts are proved.
std::map<const choreo::Graph*, std::set<std::string>> ProvedMotions(workspace::LoadedModule& module,
                                                                    const solve::cache::ProofCache& cache);

/// Moves the assumptions about ports that are proved from `assumed` to `proved`, with the robot that they are
/// proved of and what the proofs are limited to. Those that could be proved are marked.
void Discharge(const workspace::LoadedKoord& koord, workspace::Session& session,
               const solve::cache::ProofCache& cache, const std::string& file, verdict::Basis& basis);

}  // namespace rondo::contracts
