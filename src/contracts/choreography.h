#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "choreo/infer/regions.h"
#include "choreo/prove/report.h"
#include "solve/cache/proof_cache.h"
#include "verdict/basis.h"
#include "workspace/module_files.h"

/// Proves choreographies with everything that goes with it: regions, obligations, certificates.
namespace rondo::contracts {

/// Holds a choreography and what was found about it.
struct ChoreographyProof {
  const choreo::Graph* graph = nullptr;
  choreo::Inference regions;
  choreo::Obligations obligations;
  choreo::Proofs proofs;
  std::set<std::string> discharged;  ///< motions (`Type.Motion`) whose contracts are proved by `rondo reach`
  bool interrupted = false;
};

/// Says how a choreography is proved.
struct ChoreographyOptions {
  double timeout = 10;  ///< seconds for each obligation, and for the regions of each fork
  unsigned jobs = 0;    ///< threads; 0: one for each core
  bool certify = true;  ///< write certificates and have them checked
  const solve::cache::ProofCache* cache = nullptr;  ///< of proofs; nullptr: none
  std::filesystem::path smt_out;                    ///< where to write the obligations as SMT-LIB 2
  std::filesystem::path certificates;               ///< where to keep certificates
  std::function<void(const std::string&)>
      progress;  ///< what is being done; from any thread, one call at a time
  base::StopToken stop;
};

/// Looks for the regions that are missing in a choreography: `options.timeout` seconds for each fork.
choreo::Inference FindRegions(choreo::Graph& graph, expr::Arena& arena, const ChoreographyOptions& options);

/// Reports the threads for which no region was found, and why.
void ReportRegions(const choreo::Inference& regions, diag::Diagnostics& diagnostics);

/// Decides every obligation of a choreography, with regions that are found where there are none, and reports
/// what is missing, does not hold or is open.
///
/// @param conditions  what the typing of processes leaves open
/// @param discharged  motions whose contracts are proved
ChoreographyProof ProveChoreography(choreo::Graph& graph, expr::Arena& arena,
                                    const std::vector<choreo::SideCondition>& conditions,
                                    std::set<std::string> discharged, const ChoreographyOptions& options,
                                    diag::Diagnostics& diagnostics);

/// Counts how many obligations that have to hold are proved, refuted and open, and adds up the seconds that
/// they took.
struct Counts {
  size_t holds = 0, fails = 0, open = 0;
  size_t not_inductive = 0;  ///< of those that fail: no short run breaks them
  double seconds = 0;

  void Add(const choreo::Proof& proof);
  size_t All() const { return holds + fails + open; }
};
/// Returns the counts of all obligations of a choreography.
Counts CountsOf(const ChoreographyProof& proof);

/// Returns what is known of the choreography as a whole.
verdict::Verdict VerdictOf(const ChoreographyProof& proof);

/// Returns what a proof of it rests on.
verdict::Basis BasisOf(const ChoreographyProof& proof);

}  // namespace rondo::contracts
